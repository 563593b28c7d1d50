// TargetSolver: the sensor point from which the ray through a given aperture point meets a target.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "lens/density.h"

namespace etendue {

/// How a ray misses a target, seen from where it leaves the lens.
struct Miss {
    double squared;              // of the angle in radians; of its sine, where that is below 0.1
    Eigen::Vector2d sensorStep;  // mm; takes the miss away to first order
};

inline Miss missOf(const ExitRay& ray, const Eigen::Vector3d& target) {
    const Eigen::Vector3d toTarget = target - ray.origin, &d = ray.direction;
    const double squaredDistance = toTarget.squaredNorm();
    double along = toTarget.dot(d);
    Eigen::Vector3d across = toTarget - along * d;  // what the ray passes the target by
    Miss miss{across.squaredNorm() / squaredDistance, {}};
    if (!(along > 0.0 && miss.squared < 0.1)) {
        // Here across / along, a tangent, says too much of the angle, or nothing.
        const double distance = std::sqrt(squaredDistance), sine = std::sqrt(miss.squared);
        const double angle = std::atan2(sine, along / distance);
        miss.squared = angle * angle;
        if (sine > 0.0)
            across *= angle / sine;
        else  // straight behind
            across = distance * angle * d.unitOrthogonal();
        along = distance;
    }
    // Equation (9), times the distance, by Cramer's rule.
    const Eigen::Matrix<double, 3, 2> moved = footprint(ray, along);
    const Eigen::Vector3d aside = across.cross(d);
    const double perDeterminant = 1.0 / determinantAcross(d, moved);
    miss.sensorStep << aside.dot(-moved.col(1)) * perDeterminant,
        aside.dot(moved.col(0)) * perDeterminant;
    return miss;
}

/// The end of a search: the sensor point, and its exit ray, carried there to first order from a
/// point within the tolerance; derivatives and throughput are still that point's.
struct Aimed {
    Eigen::Vector2d sensor;
    ExitRay ray;
};

/// To first order.
inline Aimed carried(const Eigen::Vector2d& sensor, const ExitRay& ray,
                     const Eigen::Vector2d& step) {
    Aimed aimed{sensor + step, ray};
    aimed.ray.origin += ray.originBySensor * step;
    aimed.ray.direction = (ray.direction + ray.directionBySensor * step).normalized();
    return aimed;
}

/// Where a search may end: its last step, unchecked, leaves the square of this, times up to 2 on
/// the lenses there are: 5e-12.
constexpr double fineToleranceRadians = 1.5e-6;
/// Where one may end that asks what is seen, not just from where: the derivatives and the
/// throughput are then those of a ray as near as this, a tenth of what fits err by.
constexpr double sightToleranceRadians = 2e-5;

/// Newton's method on the direction in which rays leave. `Exit`, called with a sensor point and the
/// share of the aperture point to go through, gives an exit ray, rims ignored, or nothing.
template <class Exit>
class TargetSolver {
public:
    TargetSolver(const Exit& exit, double focalLengthMm,
                 double toleranceRadians = fineToleranceRadians)
        : exit_(exit),
          longestStepMm_(0.5 * focalLengthMm),
          squaredTolerance_(toleranceRadians * toleranceRadians) {}

    /// From the sensor point `s`, or where no ray leaves there, from one nearer the axis: rays that
    /// graze the first surface end the field abruptly. Steps are halved until the miss shrinks.
    std::optional<Aimed> newton(const Eigen::Vector3d& target, Eigen::Vector2d s,
                                double apertureShare = 1.0) {
        constexpr int mostRetreats = 5;
        std::optional<ExitRay> ray = exit_(s, apertureShare);
        for (int i = 0; !ray && i < mostRetreats; ++i) {
            s *= 0.98;
            ray = exit_(s, apertureShare);
        }
        if (!ray) return {};
        Miss miss = missOf(*ray, target);
        constexpr int mostSteps = 12;
        for (int i = 0; !(miss.squared <= squaredTolerance_); ++i) {
            if (i == mostSteps || !miss.sensorStep.allFinite()) return {};
            ++steps_;
            if (!improve(target, apertureShare, s, *ray, miss)) return {};
        }
        // One more step squares what is missing.
        return carried(s, *ray, miss.sensorStep);
    }

    /// From the ray along the axis outward: aperture point and target are led from there to their
    /// places, the target on a circle about the first surface.
    std::optional<Aimed> follow(const Eigen::Vector3d& target) {
        const std::optional<ExitRay> axis = exit_(Eigen::Vector2d::Zero(), 0.0);
        if (!axis) return {};
        const Eigen::Vector3d toTarget = target - axis->origin;
        const Eigen::Quaterniond turn =
            Eigen::Quaterniond::FromTwoVectors(axis->direction, toTarget);
        const auto waypoint = [&](double t) -> Eigen::Vector3d {
            if (t == 1.0) return target;
            const Eigen::Quaterniond part = Eigen::Quaterniond::Identity().slerp(t, turn);
            return axis->origin + toTarget.norm() * (part * axis->direction);
        };
        double reached = 0.0, stride = 0.25;
        Eigen::Vector2d s(0.0, 0.0), change(0.0, 0.0);  // change: of s per t
        constexpr double shortest = 1.0 / 32.0;
        while (stride >= shortest) {
            const double t = std::min(1.0, reached + stride);
            if (const auto found = newton(waypoint(t), s + (t - reached) * change, t)) {
                if (t == 1.0) return found;
                change = (found->sensor - s) / (t - reached);
                s = found->sensor;
                reached = t;
            } else {
                stride *= 0.5;
            }
        }
        return {};
    }

    /// Of Newton's method, so far.
    int steps() const { return steps_; }

private:
    /// Takes the step, or as much of it as makes the miss smaller: halves, again and again.
    bool improve(const Eigen::Vector3d& target, double apertureShare, Eigen::Vector2d& s,
                 ExitRay& ray, Miss& miss) {
        constexpr int mostHalvings = 4;
        const double length = miss.sensorStep.norm();
        double share = length > longestStepMm_ ? longestStepMm_ / length : 1.0;
        for (int i = 0; i < mostHalvings; ++i, share *= 0.5) {
            const Eigen::Vector2d there = s + share * miss.sensorStep;
            const std::optional<ExitRay> next = exit_(there, apertureShare);
            if (!next) continue;
            const Miss nextMiss = missOf(*next, target);
            if (!(nextMiss.squared < miss.squared)) continue;
            s = there;
            ray = *next;
            miss = nextMiss;
            return true;
        }
        return false;
    }

    const Exit& exit_;
    double longestStepMm_;  // beyond which a lens does not turn rays evenly
    double squaredTolerance_;
    int steps_ = 0;
};

}  // namespace etendue
