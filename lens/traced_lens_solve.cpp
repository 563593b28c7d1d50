// The two solves of a TracedLens (docs/notation: trace and connect): Newton's method on the exact
// trace, with the derivatives that dual numbers bring along.
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "lens/traced_lens.h"

namespace etendue {

namespace {

constexpr auto ignore = [](auto...) {};

template <int N>
Eigen::Vector3d partial(const Vector3<Dual<N>>& vector, std::size_t index) {
    return {vector.x.partials[index], vector.y.partials[index], vector.z.partials[index]};
}

/// The ray that leaves the sensor at `sensor` with slope `q`, to be differentiated by the slope and
/// nothing else.
LensRay<Dual<2>> rayBySlope(SensorPoint sensor, const Eigen::Vector2d& q, double sensorZMm) {
    using D = Dual<2>;
    return rayOf(PlaneState<D>{D(sensor.mm.x()), D(sensor.mm.y()), D::variable(q.x(), 0),
                               D::variable(q.y(), 1)},
                 sensorZMm);
}

/// The same by (s, q).
LensRay<Dual<4>> rayBySensor(SensorPoint sensor, const Eigen::Vector2d& q, double sensorZMm) {
    using D = Dual<4>;
    return rayOf(PlaneState<D>{D::variable(sensor.mm.x(), 0), D::variable(sensor.mm.y(), 1),
                               D::variable(q.x(), 2), D::variable(q.y(), 3)},
                 sensorZMm);
}

/// Where a ray crosses the stop, and how that moves with its slope at the sensor.
struct StopHit {
    Eigen::Vector2d mm;
    Eigen::Matrix2d bySlope;
};

/// A(s, q) − a with Newton's method on it.
class SlopeSolver {
public:
    SlopeSolver(const TracedLens& lens, const MonochromaticSystem& system)
        : lens_(lens),
          system_(system),
          scaleMm_(system.system.surfaces[system.system.stop].semiApertureMm) {}

    std::optional<Eigen::Vector2d> solve(SensorPoint sensor, AperturePoint aperture) const {
        if (const auto q = newton(sensor, aperture, paraxial(sensor, aperture))) return q;
        return follow(sensor, aperture);
    }

private:
    Eigen::Vector2d paraxial(SensorPoint sensor, AperturePoint aperture) const {
        const StopMap& map = lens_.paraxialStopMap();
        return (aperture.mm - map.bySensor.cwiseProduct(sensor.mm)).cwiseQuotient(map.bySlope);
    }

    std::optional<StopHit> hit(SensorPoint sensor, const Eigen::Vector2d& q) const {
        LensRay<Dual<2>> ray = rayBySlope(sensor, q, lens_.sensorZMm());
        const OpticalSystem& surfaces = system_.system;
        const Passage passage = carryToScene<TraceMode::geometry>(
            system_, surfaces.stop, surfaces.surfaces.size(), ray, ignore);
        if (passage.status != TraceStatus::passed) return {};
        StopHit result;
        const auto& [x, y, z] = ray.origin;
        result.mm << x.value, y.value;
        result.bySlope << x.partials[0], x.partials[1], y.partials[0], y.partials[1];
        return result;
    }

    /// Newton's method, its steps halved until the miss shrinks.
    std::optional<Eigen::Vector2d> newton(SensorPoint sensor, AperturePoint aperture,
                                          Eigen::Vector2d q) const {
        std::optional<StopHit> at = hit(sensor, q);
        constexpr int mostSteps = 12, mostHalvings = 4;
        for (int i = 0; at && i < mostSteps; ++i) {
            const Eigen::Vector2d miss = at->mm - aperture.mm;
            const Eigen::Vector2d step = at->bySlope.inverse() * miss;
            if (!step.allFinite()) return {};
            // One more step squares what is missing: far below rounding.
            if (miss.norm() <= 1e-8 * scaleMm_) return q - step;
            std::optional<StopHit> next;
            double share = 1.0;
            for (int halving = 0; halving < mostHalvings; ++halving, share *= 0.5) {
                next = hit(sensor, q - share * step);
                if (next && (next->mm - aperture.mm).norm() < miss.norm()) break;
                next.reset();
            }
            q -= share * step;
            at = next;
        }
        return {};
    }

    /// From the axis, where q = 0, outward along (t s, t a).
    std::optional<Eigen::Vector2d> follow(SensorPoint sensor, AperturePoint aperture) const {
        double reached = 0.0, stride = 0.25;
        Eigen::Vector2d q(0.0, 0.0);
        constexpr double shortest = 1.0 / 32.0;
        while (stride >= shortest) {
            const double t = std::min(1.0, reached + stride);
            const SensorPoint s{t * sensor.mm};
            const AperturePoint a{t * aperture.mm};
            const Eigen::Vector2d guess =
                reached > 0.0 ? Eigen::Vector2d(q * (t / reached)) : paraxial(s, a);
            if (const auto found = newton(s, a, guess)) {
                q = *found;
                if (t == 1.0) return q;
                reached = t;
            } else {
                stride *= 0.5;
            }
        }
        return {};
    }

    const TracedLens& lens_;
    const MonochromaticSystem& system_;
    double scaleMm_;
};

/// Across `direction`, right-handed about it.
Eigen::Matrix<double, 3, 2> frameAcross(const Eigen::Vector3d& direction) {
    Eigen::Matrix<double, 3, 2> frame;
    frame.col(0) = direction.unitOrthogonal();
    frame.col(1) = direction.cross(frame.col(0));
    return frame;
}

/// Solid angle swept per area of the sensor, 1/mm²; negative where the map has turned over.
double turning(const ExitRay& ray) {
    return (frameAcross(ray.direction).transpose() * ray.directionBySensor).determinant();
}

/// How the direction in which a ray leaves misses a target, seen from where it leaves.
struct Miss {
    Eigen::Matrix<double, 3, 2> frame;  // across the ray
    Eigen::Vector2d radians;            // from the ray's direction to the target's
    double distanceMm;
};

Miss missOf(const ExitRay& ray, const Eigen::Vector3d& target) {
    Miss miss;
    const Eigen::Vector3d toTarget = target - ray.origin;
    miss.distanceMm = toTarget.norm();
    const Eigen::Vector3d wanted = toTarget / miss.distanceMm;
    miss.frame = frameAcross(ray.direction);
    const Eigen::Vector2d across = miss.frame.transpose() * wanted;
    const double sine = across.norm(), cosine = wanted.dot(ray.direction);
    if (sine > 0.0)
        miss.radians = across * (std::atan2(sine, cosine) / sine);
    else  // straight ahead or straight behind
        miss.radians << (cosine > 0.0 ? 0.0 : std::numbers::pi), 0.0;
    return miss;
}

/// Newton's method on the direction of the exit ray, over sensor points. `Exit` gives the exit ray
/// of a sensor point and a share of the aperture point, rims ignored.
template <class Exit>
class TargetSolver {
public:
    TargetSolver(const Exit& exit, double focalLengthMm)
        : exit_(exit), focalLengthMm_(focalLengthMm) {}

    std::optional<Eigen::Vector2d> newton(const Eigen::Vector3d& target, Eigen::Vector2d s,
                                          double apertureShare = 1.0) const {
        std::optional<ExitRay> at = exit_(s, apertureShare);
        constexpr int mostSteps = 12, mostHalvings = 4;
        for (int i = 0; at && i < mostSteps; ++i) {
            const Miss miss = missOf(*at, target);
            const Eigen::Matrix2d turn =
                miss.frame.transpose() *
                (at->directionBySensor + at->originBySensor / miss.distanceMm);
            Eigen::Vector2d step = turn.inverse() * miss.radians;
            if (!step.allFinite()) return {};
            if (miss.radians.norm() <= 1e-8) return s + step;
            // A step that leaves the region in which the lens turns rays smoothly is no use.
            const double longest = 0.5 * focalLengthMm_;
            if (step.norm() > longest) step *= longest / step.norm();
            std::optional<ExitRay> next;
            double share = 1.0;
            for (int halving = 0; halving < mostHalvings; ++halving, share *= 0.5) {
                next = exit_(s + share * step, apertureShare);
                if (next && missOf(*next, target).radians.norm() < miss.radians.norm()) break;
                next.reset();
            }
            s += share * step;
            at = next;
        }
        return {};
    }

    /// From the ray along the axis: target and aperture point led from there to their places.
    std::optional<Eigen::Vector2d> follow(const Eigen::Vector3d& target) const {
        Eigen::Vector2d s(0.0, 0.0);
        const std::optional<ExitRay> start = exit_(s, 0.0);
        if (!start) return {};
        const Eigen::Vector3d toTarget = target - start->origin;
        const double distance = toTarget.norm();
        const Eigen::Quaterniond turn =
            Eigen::Quaterniond::FromTwoVectors(start->direction, toTarget);
        double reached = 0.0, stride = 0.25;
        Eigen::Vector2d before = s;
        double strideBefore = 0.0;
        constexpr double shortest = 1.0 / 32.0;
        while (stride >= shortest) {
            const double t = std::min(1.0, reached + stride);
            const Eigen::Vector3d way =
                Eigen::Quaterniond::Identity().slerp(t, turn) * start->direction;
            const Eigen::Vector3d waypoint =
                t == 1.0 ? target : Eigen::Vector3d(start->origin + distance * way);
            Eigen::Vector2d guess = s;
            if (strideBefore > 0.0) guess += (s - before) * ((t - reached) / strideBefore);
            if (const auto found = newton(waypoint, guess, t)) {
                if (t == 1.0) return found;
                before = s;
                s = *found;
                strideBefore = t - reached;
                reached = t;
            } else {
                stride *= 0.5;
            }
        }
        return {};
    }

private:
    const Exit& exit_;
    double focalLengthMm_;
};

}  // namespace

std::optional<Eigen::Vector2d> MonochromaticLens::slopeThrough(SensorPoint sensor,
                                                               AperturePoint aperture) const {
    const MonochromaticSystem view = system();
    return SlopeSolver(*lens_, view).solve(sensor, aperture);
}

template <TraceMode mode>
std::optional<ExitRay> MonochromaticLens::exitRay(SensorPoint sensor,
                                                  AperturePoint aperture) const {
    const std::optional<Eigen::Vector2d> q = slopeThrough(sensor, aperture);
    if (!q) return {};
    const MonochromaticSystem view = system();
    const std::size_t stop = view.system.stop, count = view.system.surfaces.size();

    // The stop is crossed without its rim: the aperture point is known, and to all digits.
    LensRay<Dual<4>> rear = rayBySensor(sensor, *q, lens_->sensorZMm());
    Passage passage = carryToScene<mode>(view, stop + 1, count, rear, ignore);
    if (passage.status != TraceStatus::passed) return {};
    if (!crossSurface<Heading::toScene, TraceMode::geometry>(view, stop, rear, passage)) return {};

    const auto& [x, y, z] = rear.origin;
    Eigen::Matrix2d apertureBySensor, apertureBySlope;
    apertureBySensor << x.partials[0], x.partials[1], y.partials[0], y.partials[1];
    apertureBySlope << x.partials[2], x.partials[3], y.partials[2], y.partials[3];
    const double determinant = apertureBySlope.determinant();
    const StopMap& paraxial = lens_->paraxialStopMap();
    if (!(determinant * paraxial.bySlope.x() * paraxial.bySlope.y() > 0.0)) return {};

    // From here on by s alone, the aperture point held fixed: K of docs/notation.
    const Eigen::Matrix2d slopeBySensor = -apertureBySlope.inverse() * apertureBySensor;
    const auto held = [&](const Dual<4>& component) {
        Dual<2> result(component.value);
        for (int i = 0; i < 2; ++i)
            result.partials[static_cast<std::size_t>(i)] =
                component.partials[static_cast<std::size_t>(i)] +
                component.partials[2] * slopeBySensor(0, i) +
                component.partials[3] * slopeBySensor(1, i);
        return result;
    };
    LensRay<Dual<2>> front{
        {Dual<2>(aperture.mm.x()), Dual<2>(aperture.mm.y()), Dual<2>(z.value)},
        {held(rear.direction.x), held(rear.direction.y), held(rear.direction.z)}};
    const Passage rest = carryToScene<mode>(view, 0, stop, front, ignore);
    if (rest.status != TraceStatus::passed) return {};

    ExitRay ray;
    ray.origin = toEigen(valueOf(front.origin));
    ray.direction = toEigen(valueOf(front.direction));
    for (int i = 0; i < 2; ++i) {
        ray.originBySensor.col(i) = partial(front.origin, static_cast<std::size_t>(i));
        ray.directionBySensor.col(i) = partial(front.direction, static_cast<std::size_t>(i));
    }
    if (mode == TraceMode::light && !(turning(ray) > 0.0)) return {};
    const double cosSquared = 1.0 / (1.0 + q->squaredNorm());
    ray.throughput = cosSquared * cosSquared / std::abs(determinant) * passage.transmittance *
                     rest.transmittance;
    if (!(ray.throughput > 0.0)) return {};  // so grazing that nothing is let through
    return ray;
}

std::optional<ExitRay> MonochromaticLens::trace(SensorPoint sensor, AperturePoint aperture) const {
    if (!lens_->system().aperture.contains(aperture.mm)) return {};
    return exitRay<TraceMode::light>(sensor, aperture);
}

std::optional<ExitRay> MonochromaticLens::chiefRay(SensorPoint sensor) const {
    return exitRay<TraceMode::geometry>(sensor, {{0.0, 0.0}});
}

std::optional<SensorPoint> MonochromaticLens::connect(const Eigen::Vector3d& targetMm,
                                                      AperturePoint aperture) const {
    if (!lens_->system().aperture.contains(aperture.mm) || !targetMm.allFinite()) return {};
    const auto exit = [&](const Eigen::Vector2d& s, double share) {
        return exitRay<TraceMode::geometry>({s}, {share * aperture.mm});
    };
    const TargetSolver solver(exit, lens_->focalLengthMm());
    const auto passing = [&](const std::optional<Eigen::Vector2d>& s) {
        constexpr double toleranceRadians = 1e-9;
        const std::optional<ExitRay> ray = s ? trace({*s}, aperture) : std::nullopt;
        const bool hits = ray && missOf(*ray, targetMm).radians.norm() <= toleranceRadians;
        return hits ? std::optional(SensorPoint{*s}) : std::nullopt;
    };
    if (const auto found = passing(solver.newton(targetMm, {0.0, 0.0}))) return found;
    return passing(solver.follow(targetMm));
}

}  // namespace etendue
