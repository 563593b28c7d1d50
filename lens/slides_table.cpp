#include "lens/slides_table.h"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "lens/fit_rays.h"
#include "lens/parallel.h"
#include "lens/polynomial.h"
#include "lens/sparse_fit.h"

namespace etendue {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;

constexpr int sparseDegree = 11;
constexpr OutputCount outputs{2, 0};

/// The published frame at the pupil sphere: its x axis in the xz plane.
Eigen::Vector2d inPublishedFrame(const PupilSphere& sphere, const PupilState<double>& pupil,
                                 const Vector3<double>& direction) {
    const Eigen::Vector3d normal(-sphere.curvature() * pupil.x, -sphere.curvature() * pupil.y,
                                 sphere.normalZ(pupil.x, pupil.y));
    const Eigen::Vector3d x = Eigen::Vector3d(normal.z(), 0.0, -normal.x()).normalized();
    const Eigen::Vector3d y = normal.cross(x), d = toEigen(direction);
    return {d.dot(x), d.dot(y)};
}

/// Published fits are polynomials of λ in µm, ours of 1/λ²: the wavelength that makes one the
/// other.
double asLinear(double wavelengthNm) { return 1e3 / std::sqrt(1e-3 * wavelengthNm); }

double squaredError(const SparsePolynomial& polynomial, const std::vector<PolynomialInput>& inputs,
                    const MatrixXd& targets) {
    const PolynomialEvaluator<double> evaluator(polynomial);
    double sum = 0.0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const PolynomialValues<double> values = evaluator.values(inputs[i]);
        for (Index o = 0; o < targets.cols(); ++o) {
            const double off =
                values[static_cast<std::size_t>(o)] - targets(static_cast<Index>(i), o);
            sum += off * off;
        }
    }
    return sum / static_cast<double>(inputs.size());
}

struct Fitted {
    double error;
    int multiplyAdds;
};

Fitted fitTo(PolynomialBasis basis, int degree, int terms, Coupling coupling,
             const std::vector<PolynomialInput>& inputs, const MatrixXd& targets) {
    const SparsePolynomial fit = fitSparse(basis, outputs, candidateTerms(basis, degree, outputs),
                                           scalingFor(basis, inputs, coupling), inputs, targets,
                                           Eigen::VectorXd::Ones(outputs.total()), {terms, 3});
    return {squaredError(fit, inputs, targets), multiplyAdds(fit)};
}

/// The most terms for which a fit costs no more.
int affordableTerms(PolynomialBasis basis, int multiplyAddsAtMost) {
    SparsePolynomial costing{basis, outputs, {}, {}};
    int terms = 0;
    do {
        ++terms;
        costing.groups = candidateTerms(basis, sparseDegree, outputs);
        for (TermGroup& group : costing.groups) group.terms.resize(static_cast<std::size_t>(terms));
    } while (multiplyAdds(costing) <= multiplyAddsAtMost);
    return std::max(terms - 1, 1);
}

}  // namespace

struct SlidesMeasurement::Rays {
    std::vector<PolynomialInput> bySlope, byAperture;
    MatrixXd published, ours;  // targets, in the frame of each
};

const std::vector<SlidesRow>& slidesRows() {
    using enum SlidesMethod;
    static const std::vector<SlidesRow> rows{
        {taylor, 2, 4, {4.97e-1, 2.17e-1, 6.18e-2, 6.03e-2}},
        {complete, 2, 21, {4.97e-1, 2.17e-1, 6.17e-2, 6.02e-2}},
        {sparse, sparseDegree, 4, {8.21e-2, 5.07e-2, 4.85e-2, 3.43e-2}},
        {taylor, 3, 16, {2.26e-3, 1.54e-2, 4.63e-4, 8.76e-5}},
        {complete, 3, 56, {2.25e-3, 1.54e-2, 4.62e-4, 8.69e-5}},
        {sparse, sparseDegree, 16, {2.40e-3, 1.34e-2, 3.25e-4, 8.22e-5}},
        {taylor, 4, 28, {1.86e-3, 1.52e-2, 2.52e-4, 7.07e-5}},
        {complete, 4, 126, {1.85e-3, 1.49e-2, 2.50e-4, 6.98e-5}},
        {sparse, sparseDegree, 28, {9.72e-4, 6.26e-3, 4.40e-5, 4.02e-5}}};
    return rows;
}

SlidesMeasurement::SlidesMeasurement(const Prescription& prescription, std::size_t count)
    : isAxial_(!isAnamorphic(prescription)) {
    constexpr std::uint64_t seed = 3;
    const OpticalSystem system(prescription);
    const double sensorDistanceMm = prescription.surfaces.back().thicknessMm;
    const TracedLens lens(prescription, system.aperture, sensorDistanceMm);
    const PupilSphere sphere(system);
    FitDomain domain{};  // its aperture is the rear element
    domain.sensorHalfSizeMm.setConstant(17.5);
    domain.sensorDistanceMm = sensorDistanceMm;
    domain.apertureRadiusMm = system.surfaces.back().semiApertureMm;
    Rays rays;
    rays.published.resize(static_cast<Index>(count), outputs.total());
    rays.ours.resize(static_cast<Index>(count), outputs.total());
    for (std::uint64_t i = 0; rays.bySlope.size() < count; ++i) {
        if (i == 1000 * count)
            throw std::invalid_argument("slides' table: hardly a ray passes " + prescription.name);
        const FitQuery query = drawQuery(domain, seed, i);
        const Eigen::Vector2d s = query.sensor.mm;
        const Eigen::Vector2d slope = (query.aperture.mm - s) / sensorDistanceMm;
        const TracedRay traced = MonochromaticLens(lens, query.wavelengthNm)
                                     .traceToScene({s.x(), s.y(), slope.x(), slope.y()});
        if (traced.passage.status != TraceStatus::passed) continue;
        const auto pupil = sphere.state(traced.ray);
        if (!pupil) continue;
        const Index row = static_cast<Index>(rays.bySlope.size());
        rays.published.row(row) << pupil->x, pupil->y,
            inPublishedFrame(sphere, *pupil, traced.ray.direction).transpose();
        rays.ours.row(row) << pupil->x, pupil->y, pupil->directionX, pupil->directionY;
        rays.bySlope.push_back({s, slope, asLinear(query.wavelengthNm)});
        rays.byAperture.push_back({s, {traced.aperture.x, traced.aperture.y}, query.wavelengthNm});
    }
    rays_ = std::make_shared<const Rays>(std::move(rays));
}

SlidesResult SlidesMeasurement::measure(const SlidesRow& row) const {
    const bool isSparse = row.method == SlidesMethod::sparse;
    const Fitted again = fitTo(
        row.method == SlidesMethod::complete ? PolynomialBasis::none : PolynomialBasis::cartesian,
        row.degree, isSparse ? row.coefficients : 1 << 20, Coupling::none, rays_->bySlope,
        rays_->published);
    const PolynomialBasis basis = isAxial_ ? PolynomialBasis::axial : PolynomialBasis::twoPlane;
    const int terms = affordableTerms(basis, again.multiplyAdds);
    const Fitted ours =
        fitTo(basis, sparseDegree, terms, Coupling::fitted, rays_->byAperture, rays_->ours);
    return {again.error, ours.error, again.multiplyAdds, terms, ours.multiplyAdds};
}

}  // namespace etendue
