#include "lens/sensor_fits.h"

#include <Eigen/LU>
#include <algorithm>

#include "lens/paraxial.h"
#include "lens/polynomial.h"
#include "lens/sparse_fit.h"

namespace etendue {

namespace {

using Eigen::Index;

std::span<const FitRay> enoughOf(std::span<const FitRay> training) {
    return training.first(std::min<std::size_t>(6000, training.size()));
}

/// `targets`: a vector for each entry of `tolerances`.
SparsePolynomial fitVectors(std::span<const PolynomialInput> inputs, const Eigen::MatrixXd& targets,
                            const Eigen::VectorXd& tolerances, bool isAxial) {
    // A first guess within 2e-5 rad ends the search: this many are near enough for all the targets
    // of many lenses, and for some of a fisheye wide open.
    // Between mirror planes a term is of one component, and there are more of them.
    const int degree = isAxial ? 11 : 13, terms = isAxial ? 48 : 96;
    const PolynomialBasis basis = isAxial ? PolynomialBasis::axial : PolynomialBasis::twoPlane;
    const OutputCount outputs{static_cast<int>(tolerances.size()), 0};
    return fitSparse(basis, outputs, candidateTerms(basis, degree, outputs),
                     scalingFor(basis, inputs, Coupling::fitted), inputs, targets,
                     tolerances.replicate(1, 2).transpose().reshaped(), {terms, 0});
}

/// From the pupil point to the ray's line, at a right angle to it, mm.
Eigen::Vector3d offsetOf(const FitRay& ray, const Eigen::Vector3d& pupilPoint,
                         const PupilSphere& sphere) {
    const auto leaving = sphere.ray(ray.pupil);
    if (!leaving) return Eigen::Vector3d::Zero();  // by rounding, at the sphere's equator
    const Eigen::Vector3d fromPupil = toEigen(leaving->origin) - pupilPoint;
    return fromPupil - fromPupil.dot(ray.direction) * ray.direction;
}

/// G: what takes away, to first order, that the ray of a far target passes a near one by.
Eigen::Vector2d byNearness(const FitRay& ray, const Eigen::Vector3d& offset, double wanderMm) {
    const Eigen::Matrix<double, 3, 2>& bySensor = ray.directionBySensor;
    const Eigen::Matrix2d squared = bySensor.transpose() * bySensor;
    return squared.inverse() * (bySensor.transpose() * offset) / -wanderMm;
}

/// Training ray number i, seen from a target on it.
struct NearRay {
    TargetSight sight;
    PolynomialValues<double> start;  // there
};

/// Targets of all degrees of nearness, farther ones first.
std::vector<NearRay> nearRays(const SparsePolynomial& start, std::span<const FitRay> rays,
                              const EntrancePupil& pupil, const PupilSphere& sphere) {
    const PolynomialEvaluator<double> evaluator(start);
    std::vector<NearRay> result;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const FitQuery& query = rays[i].query;
        const Eigen::Vector3d point = pupil.point(query.aperture);
        const double k = (static_cast<double>(i) + 0.5) / static_cast<double>(rays.size());
        const double distance = pupil.wanderMm() / k;
        const Eigen::Vector3d offset = offsetOf(rays[i], point, sphere);
        const double along = std::sqrt(std::max(0.0, distance * distance - offset.squaredNorm()));
        const Eigen::Vector3d target = point + offset + along * rays[i].direction;
        const TargetSight sight = pupil.sight(target, query.aperture);
        result.push_back(
            {sight, evaluator.values({sight.field, query.aperture.mm, query.wavelengthNm})});
    }
    return result;
}

/// In least squares.
double fitBend(std::span<const NearRay> seen, std::span<const FitRay> rays) {
    double products = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const auto& at = seen[i].start;
        const double k = seen[i].sight.nearness;
        const Eigen::Vector2d far(at[0], at[1]), slope(at[2], at[3]);
        products += k * k * slope.dot(rays[i].query.sensor.mm - far - k * slope);
        squares += k * k * k * k * slope.squaredNorm();
    }
    return squares > 0.0 ? products / squares : 0.0;
}

double nearestTrusted(const ConnectStart& start, std::span<const NearRay> seen,
                      std::span<const FitRay> rays) {
    constexpr double margin = 0.5 * (1.0 + farthestGuess);  // for rays that are not among these
    Eigen::Array2d reach(0.0, 0.0);
    for (const FitRay& ray : rays) reach = reach.max(ray.query.sensor.mm.cwiseAbs().array());
    double trusted = 0.0;
    for (const NearRay& one : seen) {
        const Eigen::Vector2d guess = sensorGuess(start, one.sight, one.start);
        if (!(guess.cwiseAbs().array() <= margin * reach).all() ||
            !(one.sight.field.norm() <= start.widestField + one.sight.nearness))
            break;
        trusted = one.sight.nearness;
    }
    return trusted;
}

}  // namespace

EntrancePupil::EntrancePupil(const OpticalSystem& system) {
    const ParaxialData data = paraxialData(system);
    perStop_ << data.x.entrancePupilPerStop, data.y.entrancePupilPerStop;
    zMm_ = 0.5 * (data.x.entrancePupilZMm + data.y.entrancePupilZMm);
    const double frontRadiusMm = system.surfaces.front().semiApertureMm;
    // Targets may lie before a pupil in front of the lens, in any direction from it; a telecentric
    // lens has its pupil at infinity.
    if (!(zMm_ < frontRadiusMm && zMm_ > -100.0 * frontRadiusMm)) {
        perStop_.setZero();
        zMm_ = 0.0;
    }
    wanderMm_ = frontRadiusMm + std::abs(zMm_);
}

Eigen::Vector3d EntrancePupil::point(AperturePoint aperture) const {
    return {aperture.mm.x() * perStop_.x(), aperture.mm.y() * perStop_.y(), zMm_};
}

TargetSight EntrancePupil::sight(const Eigen::Vector3d& targetMm, AperturePoint aperture) const {
    const Eigen::Vector3d toTarget = targetMm - point(aperture);
    const double perDistance = 1.0 / toTarget.norm();
    return {fieldCoordinates(perDistance * toTarget), wanderMm_ * perDistance};
}

ConnectStart fitConnectStart(std::span<const FitRay> training, const OpticalSystem& system,
                             bool isAxial) {
    ConnectStart start;
    for (const FitRay& ray : training)
        start.widestField = std::max(start.widestField, fieldCoordinates(ray.direction).norm());
    start.widestField *= 1.05;  // for corners that no training ray came near
    training = enoughOf(training);
    const EntrancePupil pupil(system);
    const PupilSphere sphere(system);
    std::vector<PolynomialInput> inputs;
    Eigen::MatrixXd targets(static_cast<Index>(training.size()), 4);
    for (const FitRay& ray : training) {
        const Eigen::Vector3d offset = offsetOf(ray, pupil.point(ray.query.aperture), sphere);
        targets.row(static_cast<Index>(inputs.size())) << ray.query.sensor.mm.transpose(),
            byNearness(ray, offset, pupil.wanderMm()).transpose();
        inputs.push_back(
            {fieldCoordinates(ray.direction), ray.query.aperture.mm, ray.query.wavelengthNm});
    }
    // Most targets are not near.
    start.sensor = fitVectors(inputs, targets, Eigen::Vector2d(1.0, 3.0), isAxial);
    const std::vector<NearRay> seen = nearRays(start.sensor, training, pupil, sphere);
    start.nearnessBend = fitBend(seen, training);
    start.trustedNearness = nearestTrusted(start, seen, training);
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
    Eigen::MatrixXd targets(static_cast<Index>(training.size()), 2);
    for (const FitRay& ray : training) {
        targets.row(static_cast<Index>(inputs.size())) = ray.slope.transpose();
        inputs.push_back({ray.query.sensor.mm, ray.query.aperture.mm, ray.query.wavelengthNm});
    }
    return fitVectors(inputs, targets, Eigen::VectorXd::Ones(1), isAxial);
}

}  // namespace etendue
