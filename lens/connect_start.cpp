#include "lens/connect_start.h"

#include <algorithm>

#include "lens/polynomial.h"
#include "lens/sparse_fit.h"

namespace etendue {

ConnectStart fitConnectStart(std::span<const FitRay> training, bool isAxial) {
    // A first guess needs no more; what it is off by, a step of Newton's method squares.
    constexpr std::size_t mostRays = 6000;
    constexpr int degree = 9, terms = 32;
    training = training.first(std::min(mostRays, training.size()));
    ConnectStart start;
    std::vector<PolynomialInput> inputs;
    Eigen::MatrixXd targets(static_cast<Eigen::Index>(training.size()), 2);
    for (const FitRay& ray : training) {
        const Eigen::Vector2d field = fieldCoordinates(ray.direction);
        start.widestField = std::max(start.widestField, field.norm());
        targets.row(static_cast<Eigen::Index>(inputs.size())) = ray.query.sensor.mm.transpose();
        inputs.push_back({field, ray.query.aperture.mm, ray.query.wavelengthNm});
    }
    start.widestField *= 1.05;  // for corners that no training ray came near
    const PolynomialBasis basis = isAxial ? PolynomialBasis::axial : PolynomialBasis::twoPlane;
    const OutputCount outputs{1, 0};
    start.sensor = fitSparse(basis, outputs, candidateTerms(basis, degree, outputs),
                             scalingFor(basis, inputs, Coupling::fitted), inputs, targets,
                             Eigen::VectorXd::Ones(2), {terms, 0});
    const PolynomialEvaluator<double> evaluator(start.sensor);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const PolynomialValues<double> at = evaluator.values(inputs[i]);
        start.errorMm +=
            (Eigen::Vector2d(at[0], at[1]) - training[i].query.sensor.mm).squaredNorm();
    }
    start.errorMm = std::sqrt(start.errorMm / static_cast<double>(inputs.size()));
    return start;
}

}  // namespace etendue
