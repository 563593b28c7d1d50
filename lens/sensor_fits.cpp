#include "lens/sensor_fits.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <stdexcept>

#include "lens/fitted_map.h"
#include "lens/paraxial.h"
#include "lens/polynomial.h"
#include "lens/sparse_fit.h"
#include "lens/target_solver.h"

namespace etendue {

namespace {

using Eigen::Index;

std::span<const FitRay> enoughOf(std::span<const FitRay> training) {
    return training.first(std::min<std::size_t>(6000, training.size()));
}

/// `targets`: a vector for each entry of `tolerances`.
SparsePolynomial fitVectors(std::span<const PolynomialInput> inputs, const Eigen::MatrixXd& targets,
                            const Eigen::VectorXd& tolerances, bool isAxial, int terms) {
    const int degree = isAxial ? 13 : 11;
    const PolynomialBasis basis = isAxial ? PolynomialBasis::axial : PolynomialBasis::twoPlane;
    const OutputCount outputs{static_cast<int>(tolerances.size()), 0};
    return fitSparse(basis, outputs, candidateTerms(basis, degree, outputs),
                     scalingFor(basis, inputs, Coupling::fitted), inputs, targets,
                     tolerances.replicate(1, 2).transpose().reshaped(), {terms, 0});
}

/// Where the map has a ray go.
struct MappedRay {
    FitQuery query;
    ExitRay exit;
};

std::vector<MappedRay> mapped(const FittedMap& map, std::span<const FitRay> rays) {
    std::vector<MappedRay> result;
    for (const FitRay& ray : rays) {
        const FitQuery& q = ray.query;
        if (const auto exit = map.exitRay(q.sensor, q.aperture, q.wavelengthNm))
            result.push_back({q, *exit});
    }
    return result;
}

PolynomialInput inputOf(const MappedRay& ray) {
    return {fieldCoordinates(ray.exit.direction), ray.query.aperture.mm, ray.query.wavelengthNm};
}

/// From the pupil point to the ray's line, at a right angle to it, mm.
Eigen::Vector3d offsetOf(const ExitRay& ray, const Eigen::Vector3d& pupilPoint) {
    const Eigen::Vector3d fromPupil = ray.origin - pupilPoint;
    return fromPupil - fromPupil.dot(ray.direction) * ray.direction;
}

/// G: what takes away, to first order, that the ray of a far target passes a near one by.
Eigen::Vector2d byNearness(const ExitRay& ray, const Eigen::Vector3d& offset, double wanderMm) {
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
std::vector<NearRay> nearRays(const SparsePolynomial& start, std::span<const MappedRay> rays,
                              const EntrancePupil& pupil) {
    const PolynomialEvaluator<double> evaluator(start);
    std::vector<NearRay> result;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const FitQuery& query = rays[i].query;
        const Eigen::Vector3d point = pupil.point(query.aperture);
        const double k = (static_cast<double>(i) + 0.5) / static_cast<double>(rays.size());
        const double distance = pupil.wanderMm() / k;
        const Eigen::Vector3d offset = offsetOf(rays[i].exit, point);
        const double along = std::sqrt(std::max(0.0, distance * distance - offset.squaredNorm()));
        const Eigen::Vector3d target = point + offset + along * rays[i].exit.direction;
        const TargetSight sight = pupil.sight(target, query.aperture);
        result.push_back(
            {sight, evaluator.values({sight.field, query.aperture.mm, query.wavelengthNm})});
    }
    return result;
}

/// In least squares.
double fitBend(std::span<const NearRay> seen, std::span<const MappedRay> rays) {
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

/// Of S, for far targets on the rays.
struct GuessErrors {
    double rmsMm;
    double shareInSight;  // of the rays, those that are met within sightToleranceRadians
};

GuessErrors guessErrors(const SparsePolynomial& sensor, std::span<const MappedRay> rays) {
    const PolynomialEvaluator<double> evaluator(sensor);
    double squares = 0.0, inSight = 0.0;
    for (const MappedRay& ray : rays) {
        const PolynomialValues<double> at = evaluator.values(inputOf(ray));
        const Eigen::Vector2d error = Eigen::Vector2d(at[0], at[1]) - ray.query.sensor.mm;
        squares += error.squaredNorm();
        if ((ray.exit.directionBySensor * error).norm() <= sightToleranceRadians) inSight += 1.0;
    }
    const auto count = static_cast<double>(rays.size());
    return {std::sqrt(squares / count), inSight / count};
}

double nearestTrusted(const ConnectStart& start, std::span<const NearRay> seen,
                      std::span<const MappedRay> rays) {
    constexpr double margin = 0.5 * (1.0 + farthestGuess);  // for rays that are not among these
    Eigen::Array2d reach(0.0, 0.0);
    for (const MappedRay& ray : rays) reach = reach.max(ray.query.sensor.mm.cwiseAbs().array());
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

ConnectStart fitConnectStart(std::span<const FitRay> training, const FittedMap& map,
                             const OpticalSystem& system, bool isAxial) {
    ConnectStart start;
    for (const FitRay& ray : training)
        start.widestField = std::max(start.widestField, fieldCoordinates(ray.direction).norm());
    start.widestField *= 1.05;  // for corners that no training ray came near
    const EntrancePupil pupil(system);
    const std::vector<MappedRay> rays = mapped(map, enoughOf(training));
    if (rays.empty()) throw std::invalid_argument("lens fit: its polynomials give no ray");
    std::vector<PolynomialInput> inputs;
    Eigen::MatrixXd targets(static_cast<Index>(rays.size()), 4);
    for (const MappedRay& ray : rays) {
        const Eigen::Vector3d offset = offsetOf(ray.exit, pupil.point(ray.query.aperture));
        targets.row(static_cast<Index>(inputs.size())) << ray.query.sensor.mm.transpose(),
            byNearness(ray.exit, offset, pupil.wanderMm()).transpose();
        inputs.push_back(inputOf(ray));
    }
    // A second evaluation of the lens takes about as long as 300 terms more would, so 16 more pay
    // as long as they spare it a twentieth of the targets. Between mirror planes a term is of one
    // component, and there are more of them.
    constexpr double enough = 0.95;
    for (const int terms :
         isAxial ? std::array{32, 48, 64, 80, 96} : std::array{64, 80, 96, 112, 128}) {
        // Most targets are not near.
        start.sensor = fitVectors(inputs, targets, Eigen::Vector2d(1.0, 3.0), isAxial, terms);
        const GuessErrors errors = guessErrors(start.sensor, rays);
        start.errorMm = errors.rmsMm;
        if (errors.shareInSight >= enough) break;
    }
    const std::vector<NearRay> seen = nearRays(start.sensor, rays, pupil);
    start.nearnessBend = fitBend(seen, rays);
    start.trustedNearness = nearestTrusted(start, seen, rays);
    return start;
}

double shareInSight(const ConnectStart& start, const FittedMap& map, std::span<const FitRay> rays) {
    return guessErrors(start.sensor, mapped(map, rays)).shareInSight;
}

SparsePolynomial fitSensorSlope(std::span<const FitRay> training, bool isAxial) {
    training = enoughOf(training);
    std::vector<PolynomialInput> inputs;
    Eigen::MatrixXd targets(static_cast<Index>(training.size()), 2);
    for (const FitRay& ray : training) {
        targets.row(static_cast<Index>(inputs.size())) = ray.slope.transpose();
        inputs.push_back({ray.query.sensor.mm, ray.query.aperture.mm, ray.query.wavelengthNm});
    }
    return fitVectors(inputs, targets, Eigen::VectorXd::Ones(1), isAxial, isAxial ? 48 : 96);
}

}  // namespace etendue
