#include "lens/polynomial_lens.h"

#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>

#include "lens/target_solver.h"
#include "lens/two_step_newton.h"

namespace etendue {

PolynomialLens::PolynomialLens(const Prescription& prescription, const LensFit& fit,
                               const Aperture& aperture)
    : map_(prescription, fit),
      domain_(fit.domain),
      aperture_(aperture),
      clip_(fit.clip.squares),
      clipCount_(fit.clip.count()),
      clear_(fit.clip, clip_, fit.domain),
      pupil_(OpticalSystem(prescription)),
      start_(fit.start.sensor),
      connectStart_(fit.start) {
    if (fit.prescriptionHash != contentHash(prescription))
        throw std::invalid_argument("polynomial lens: the fit is of another prescription");
    constexpr double rounding = 1.0 + 1e-12;
    if (aperture.radiusMm() > fit.domain.apertureRadiusMm * rounding)
        throw std::invalid_argument("polynomial lens: the aperture is wider than the fit's domain");
    const OpticalSystem system(prescription);
    const ParaxialData data = paraxialData(system);
    reachMm_ = etendue::reachMm(system);
    focalLengthMm_ = 0.5 * std::abs(data.x.focalLengthMm + data.y.focalLengthMm);
}

std::optional<ExitRay> PolynomialLens::trace(SensorPoint sensor, AperturePoint aperture,
                                             double wavelengthNm) const {
    if (!aperture_.contains(aperture.mm)) return {};
    // Before any polynomial is asked, which outside the domain could answer anything.
    if (!domain_.contains(sensor, aperture, wavelengthNm)) return {};
    const std::optional<ExitRay> ray = map_.exitRay(sensor, aperture, wavelengthNm);
    if (!ray || !passes(sensor, *ray, aperture, wavelengthNm)) return {};
    return ray;
}

void PolynomialLens::traceEach(SensorPoint sensor, AperturePoint aperture,
                               std::span<const double> wavelengthsNm,
                               std::span<std::optional<RayOrigin>> origins) const {
    std::fill(origins.begin(), origins.end(), std::nullopt);
    if (!domain_.contains(sensor, aperture, wavelengthsNm.front())) return;
    const auto hero = map_.pupilRay(sensor, aperture, wavelengthsNm.front());
    if (!hero) return;
    origins[0] = originOf(*hero, sensor, aperture, wavelengthsNm.front());
    if (!origins[0]) return;
    const auto stateOf = [](const RayOrigin& origin) {
        Eigen::Vector4d state;
        state << origin.sensor.mm, origin.aperture.mm;
        return state;
    };
    // Origins move nearly as the indices do, and those as 1/λ² (Cauchy).
    const auto inverseSquare = [&](std::size_t i) {
        return 1.0 / (wavelengthsNm[i] * wavelengthsNm[i]);
    };
    const Leaving leaving{hero->pupil, hero->bySensorAndAperture.inverse()};
    const Eigen::Vector4d start = stateOf(*origins[0]);
    Eigen::Vector4d moved(0.0, 0.0, 0.0, 0.0);  // per inverse square, by the one before
    for (std::size_t i = 1; i < wavelengthsNm.size(); ++i) {
        const double by = inverseSquare(i) - inverseSquare(0);
        origins[i] = originNear(start + by * moved, leaving, wavelengthsNm[i]);
        if (origins[i] && by != 0.0) moved = (stateOf(*origins[i]) - start) / by;
    }
}

std::optional<RayOrigin> PolynomialLens::originOf(const PupilRay& mapped, SensorPoint sensor,
                                                  AperturePoint aperture,
                                                  double wavelengthNm) const {
    if (!aperture_.contains(aperture.mm)) return {};
    const std::optional<ExitRay> ray = map_.exitRay(mapped);
    if (!ray || !passes(sensor, *ray, aperture, wavelengthNm)) return {};
    return RayOrigin{sensor, aperture, *ray, map_.etendue(mapped)};
}

std::optional<RayOrigin> PolynomialLens::originNear(Eigen::Vector4d at, const Leaving& leaving,
                                                    double wavelengthNm) const {
    const auto missOf = [&](const PupilState<double>& there) {
        return Eigen::Vector4d(leaving.pupil.x - there.x, leaving.pupil.y - there.y,
                               leaving.pupil.directionX - there.directionX,
                               leaving.pupil.directionY - there.directionY);
    };
    const auto isNearDomain = [&] {
        return isNearSensor(at.head<2>()) &&
               at.tail<2>().norm() <= searchMargin * domain_.apertureRadiusMm;
    };
    // The derivatives of another wavelength differ by a hundredth: they take the first step.
    if (!isNearDomain()) return {};
    const auto first = map_.pupilState({at.head<2>()}, {at.tail<2>()}, wavelengthNm);
    if (!first) return {};
    at += leaving.byPupil * missOf(*first);
    const double toleranceMm = sightToleranceRadians * focalLengthMm_;
    constexpr int mostSteps = 8;
    for (int i = 0; i < mostSteps && isNearDomain(); ++i) {
        const auto mapped = map_.pupilRay({at.head<2>()}, {at.tail<2>()}, wavelengthNm);
        if (!mapped) return {};
        const Eigen::Vector4d miss = missOf(mapped->pupil);
        // One more step squares what is missing.
        at += mapped->bySensorAndAperture.inverse() * miss;
        if (miss.head<2>().norm() <= toleranceMm && miss.tail<2>().norm() <= sightToleranceRadians)
            return originOf(*mapped, {at.head<2>()}, {at.tail<2>()}, wavelengthNm);
    }
    return {};
}

bool PolynomialLens::passes(SensorPoint sensor, const ExitRay& ray, AperturePoint aperture,
                            double wavelengthNm) const {
    return statusOf(sensor, ray, aperture, wavelengthNm) == ConnectStatus::found &&
           passesRims(sensor, aperture, wavelengthNm);
}

bool PolynomialLens::isNearSensor(const Eigen::Vector2d& sensorMm) const {
    return (sensorMm.cwiseAbs().array() <= searchMargin * domain_.sensorHalfSizeMm.array()).all();
}

ConnectStatus PolynomialLens::statusOf(SensorPoint sensor, const ExitRay& ray,
                                       AperturePoint aperture, double wavelengthNm) const {
    if (!domain_.contains(sensor, aperture, wavelengthNm)) return ConnectStatus::outOfField;
    return turning(ray) > 0.0 ? ConnectStatus::found : ConnectStatus::blocked;
}

double PolynomialLens::highestSquare(SensorPoint sensor, AperturePoint aperture,
                                     double wavelengthNm) const {
    const PolynomialValues<double> squares = clip_.values({sensor.mm, aperture.mm, wavelengthNm});
    return etendue::highestSquare({squares.data(), clipCount_});
}

AperturePoint PolynomialLens::sampleAperture(Eigen::Vector2d u) const {
    return {aperture_.sample(u)};
}

std::optional<SensorPoint> PolynomialLens::connect(const Eigen::Vector3d& targetMm,
                                                   AperturePoint aperture,
                                                   double wavelengthNm) const {
    return solve(targetMm, aperture, wavelengthNm).sensor;
}

Connection PolynomialLens::solve(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                                 double wavelengthNm, ConnectMethod method) const {
    if (!canSee(targetMm, aperture, wavelengthNm)) return {ConnectStatus::outOfField, {}, 0};
    return method == ConnectMethod::newton ? solveByNewton(targetMm, aperture, wavelengthNm)
                                           : solveByTwoSteps(targetMm, aperture, wavelengthNm);
}

Eigen::Vector2d PolynomialLens::sensorAt(const TargetSight& sight, AperturePoint aperture,
                                         double wavelengthNm) const {
    return sensorGuess(connectStart_, sight,
                       start_.values({sight.field, aperture.mm, wavelengthNm}));
}

bool PolynomialLens::isFarOff(const Eigen::Vector2d& guess) const {
    return !(guess.cwiseAbs().array() <= farthestGuess * domain_.sensorHalfSizeMm.array()).all();
}

Eigen::Vector2d PolynomialLens::clampedToSensor(const Eigen::Vector2d& guess) const {
    return guess.cwiseMax(-domain_.sensorHalfSizeMm).cwiseMin(domain_.sensorHalfSizeMm);
}

Eigen::Vector2d PolynomialLens::beginAt(const Eigen::Vector2d& guess) const {
    if (!guess.allFinite()) return Eigen::Vector2d::Zero();
    return isFarOff(guess) ? clampedToSensor(guess) : guess;
}

PolynomialLens::Guess PolynomialLens::firstGuess(const TargetSight& sight, AperturePoint aperture,
                                                 double wavelengthNm) const {
    const auto none = [](ConnectStatus why) { return Guess{why, {}, false, {}}; };
    const bool isTrusted = sight.nearness <= connectStart_.trustedNearness;
    if (isTrusted && !(sight.field.norm() <= connectStart_.widestField + sight.nearness))
        return none(ConnectStatus::outOfField);
    const Eigen::Vector2d guess = sensorAt(sight, aperture, wavelengthNm);
    // Searching for a point that sees the target where none does costs ten times what finding one
    // does.
    const bool isOutside = isFarOff(guess);
    if (isOutside && isTrusted) return none(ConnectStatus::outOfField);
    const Eigen::Vector2d begin = beginAt(guess), inside = clampedToSensor(begin);
    const auto at = [&](bool passesRims) {
        return Guess{ConnectStatus::found, inside, passesRims, begin};
    };
    if (clear_.contains({inside}, aperture)) return at(true);
    // Of targets that are not near, guesses err by less than squared heights change by the margin.
    constexpr double farNearness = 0.25, margin = 0.1;
    if (!isTrusted || isOutside || sight.nearness > farNearness) return at(false);
    const double highest = highestSquare({inside}, aperture, wavelengthNm);
    if (!(highest <= 1.0 + margin)) return none(ConnectStatus::blocked);
    return at(highest <= 1.0 - margin);
}

Connection PolynomialLens::solveByNewton(const Eigen::Vector3d& target, AperturePoint aperture,
                                         double wavelengthNm) const {
    const Guess guess = firstGuess(pupil_.sight(target, aperture), aperture, wavelengthNm);
    Connection connection{guess.status, {}, 0};
    if (guess.status != ConnectStatus::found) return connection;
    const std::optional<Aimed> end =
        aim(target, aperture, wavelengthNm, guess, fineToleranceRadians, connection);
    if (connection.status == ConnectStatus::found) connection.sensor = SensorPoint{end->sensor};
    return connection;
}

std::optional<Sighting> PolynomialLens::see(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                                            double wavelengthNm) const {
    std::optional<Sighting> sighting;
    seeEach(targetMm, aperture, {&wavelengthNm, 1}, {&sighting, 1});
    return sighting;
}

void PolynomialLens::seeEach(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                             std::span<const double> wavelengthsNm,
                             std::span<std::optional<Sighting>> sightings) const {
    std::fill(sightings.begin(), sightings.end(), std::nullopt);
    const TargetSight sight = pupil_.sight(targetMm, aperture);
    std::optional<Guess> guess;  // at the first wavelength that may be seen by
    for (std::size_t i = 0; i < wavelengthsNm.size(); ++i) {
        if (!canSee(targetMm, aperture, wavelengthsNm[i])) continue;
        if (!guess) {
            // What is clear of a target at one wavelength is so at all: guesses leave a margin for
            // what they err by, against which wavelengths hardly part.
            guess = firstGuess(sight, aperture, wavelengthsNm[i]);
            if (guess->status != ConnectStatus::found) return;
        } else {
            guess->beginMm = beginAt(sensorAt(sight, aperture, wavelengthsNm[i]));
        }
        Connection connection;
        const std::optional<Aimed> end =
            aim(targetMm, aperture, wavelengthsNm[i], *guess, sightToleranceRadians, connection);
        if (connection.status == ConnectStatus::found)
            sightings[i] = Sighting{{end->sensor}, end->ray};
    }
}

bool PolynomialLens::finds(SensorPoint sensor, const Eigen::Vector3d& targetMm,
                           AperturePoint aperture, double wavelengthNm, double toleranceMm) const {
    if (!canSee(targetMm, aperture, wavelengthNm)) return false;
    const Guess guess = firstGuess(pupil_.sight(targetMm, aperture), aperture, wavelengthNm);
    if (guess.status != ConnectStatus::found) return false;
    // From so near a search ends there, to much less than the tolerance.
    return isNear(guess.beginMm, sensor.mm) ||
           LensModel::finds(sensor, targetMm, aperture, wavelengthNm, toleranceMm);
}

bool PolynomialLens::isNear(const Eigen::Vector2d& guess, const Eigen::Vector2d& sensor) const {
    constexpr double near = 0.01;  // in half sizes of the sensor
    return ((sensor - guess).cwiseAbs().array() <= near * domain_.sensorHalfSizeMm.array()).all();
}

bool PolynomialLens::canSee(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                            double wavelengthNm) const {
    return targetMm.allFinite() && aperture_.contains(aperture.mm) &&
           domain_.contains({{0.0, 0.0}}, aperture, wavelengthNm);
}

std::optional<Aimed> PolynomialLens::aim(const Eigen::Vector3d& target, AperturePoint aperture,
                                         double wavelengthNm, const Guess& guess,
                                         double toleranceRadians, Connection& connection) const {
    const auto exit = [&](const Eigen::Vector2d& s,
                          double apertureShare) -> std::optional<ExitRay> {
        if (!isNearSensor(s)) return {};
        return map_.exitRay({s}, {apertureShare * aperture.mm}, wavelengthNm);
    };
    TargetSolver solver(exit, focalLengthMm_, toleranceRadians);
    std::optional<Aimed> end = solver.newton(target, guess.beginMm);
    if (!end) end = solver.follow(target);
    connection.iterations = solver.steps();
    connection.status =
        end ? statusOf({end->sensor}, end->ray, aperture, wavelengthNm) : ConnectStatus::unsolved;
    if (connection.status != ConnectStatus::found) return end;
    if (!(guess.passesRims && isNear(guess.sensorMm, end->sensor)) &&
        !passesRims({end->sensor}, aperture, wavelengthNm))
        connection.status = ConnectStatus::blocked;
    return end;
}

Connection PolynomialLens::solveByTwoSteps(const Eigen::Vector3d& target, AperturePoint aperture,
                                           double wavelengthNm) const {
    const auto stateRay = [&](SensorPoint s, const Eigen::Vector2d& q) -> std::optional<StateRay> {
        if (map_.form() == FitForm::sensorState) return map_.stateRay(s, q, wavelengthNm);
        // At a fixed aperture point nothing is left to do for the slope.
        const auto exit = map_.exitRay(s, aperture, wavelengthNm);
        if (!exit) return {};
        return StateRay{{aperture.mm, Eigen::Matrix2d::Identity()}, *exit};
    };
    const TwoStepResult end = twoStepNewton(stateRay, target, aperture, domain_.apertureRadiusMm);
    Connection connection{ConnectStatus::unsolved, {}, end.iterations};
    if (!end.sensor) return connection;
    if (trace(*end.sensor, aperture, wavelengthNm)) {
        connection.status = ConnectStatus::found;
        connection.sensor = end.sensor;
    } else {
        connection.status = ConnectStatus::blocked;
    }
    return connection;
}

}  // namespace etendue
