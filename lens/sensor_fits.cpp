#include "lens/sensor_fits.h"

#include <algorithm>

#include "lens/polynomial.h"
#include "lens/sparse_fit.h"

namespace etendue {

namespace {

std::span<const FitRay> enoughOf(std::span<const FitRay> training) {
    return training.first(std::min<std::size_t>(6000, training.size()));
}

SparsePolynomial fitVector(std::span<const PolynomialInput> inputs, const Eigen::MatrixXd& targets,
                           bool isAxial) {
    // As a first guess it needs no more: what it is off by, a step of Newton's method squares.
    constexpr int degree = 9, terms = 32;
    const PolynomialBasis basis = isAxial ? PolynomialBasis::axial : PolynomialBasis::twoPlane;
    const OutputCount outputs{1, 0};
    return fitSparse(basis, outputs, candidateTerms(basis, degree, outputs),
                     scalingFor(basis, inputs, Coupling::fitted), inputs, targets,
                     Eigen::VectorXd::Ones(2), {terms, 0});
}

}  // namespace

ConnectStart fitConnectStart(std::span<const FitRay> training, bool isAxial) {
    ConnectStart start;
    for (const FitRay& ray : training)
        start.widestField = std::max(start.widestField, fieldCoordinates(ray.direction).norm());
    start.widestField *= 1.05;  // for corners that no training ray came near
    training = enoughOf(training);
    std::vector<PolynomialInput> inputs;
    Eigen::MatrixXd targets(static_cast<Eigen::Index>(training.size()), 2);
    for (const FitRay& ray : training) {
        targets.row(static_cast<Eigen::Index>(inputs.size())) = ray.query.sensor.mm.transpose();
        inputs.push_back(
            {fieldCoordinates(ray.direction), ray.query.aperture.mm, ray.query.wavelengthNm});
    }
    start.sensor = fitVector(inputs, targets, isAxial);
    const PolynomialEvaluator<double> evaluator(start.sensor);
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const PolynomialValues<double> at = evaluator.values(inputs[i]);
        start.errorMm +=
            (Eigen::Vector2d(at[0], at[1]) - training[i].query.sensor.mm).squaredNorm();
    }
    start.errorMm = std::sqrt(start.errorMm / static_cast<double>(inputs.size()));
    return start;
}

SparsePolynomial fitSensorSlope(std::span<const FitRay> training, bool isAxial) {
    training = enoughOf(training);
    std::vector<PolynomialInput> inputs;
    Eigen::MatrixXd targets(static_cast<Eigen::Index>(training.size()), 2);
    for (const FitRay& ray : training) {
        targets.row(static_cast<Eigen::Index>(inputs.size())) = ray.slope.transpose();
        inputs.push_back({ray.query.sensor.mm, ray.query.aperture.mm, ray.query.wavelengthNm});
    }
    return fitVector(inputs, targets, isAxial);
}

}  // namespace etendue
