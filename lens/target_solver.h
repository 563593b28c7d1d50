// TargetSolver: the sensor point from which the ray through a given aperture point meets a target.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "lens/density.h"

namespace etendue {

/// How a ray misses a target, seen from where it leaves the lens.
struct Miss {
    double radians;
    Eigen::Vector2d sensorStep;  // mm; takes the miss away to first order
};

inline Miss missOf(const ExitRay& ray, const Eigen::Vector3d& target) {
    const Eigen::Vector3d toTarget = target - ray.origin, &d = ray.direction;
    const double perDistance = 1.0 / toTarget.norm();
    const double cosine = toTarget.dot(d) * perDistance;
    Eigen::Vector3d turn = toTarget * perDistance - cosine * d;  // from d toward the target
    const double sine = turn.norm();
    Miss miss{};
    if (cosine > 0.95) {  // the first terms of the arc sine, good to 1e-5 here
        miss.radians = sine * (1.0 + sine * sine * (1.0 / 6.0 + sine * sine * (3.0 / 40.0)));
        turn *= 1.0 + sine * sine / 6.0;
    } else if (sine > 0.0) {
        miss.radians = std::atan2(sine, cosine);
        turn *= miss.radians / sine;
    } else {  // straight behind
        miss.radians = std::numbers::pi;
        turn = miss.radians * d.unitOrthogonal();
    }
    // Equation (9) by Cramer's rule.
    const Eigen::Matrix<double, 3, 2> bySensor =
        ray.directionBySensor + perDistance * ray.originBySensor;
    const Eigen::Vector3d across = turn.cross(d);
    miss.sensorStep << across.dot(-bySensor.col(1)), across.dot(bySensor.col(0));
    miss.sensorStep /= determinantAcross(d, bySensor);
    return miss;
}

/// The end of a search: the sensor point, and the exit ray of one within the tolerance of it.
struct Aimed {
    Eigen::Vector2d sensor;
    ExitRay ray;
};

/// Newton's method on the direction in which rays leave. `Exit`, called with a sensor point and the
/// share of the aperture point to go through, gives an exit ray, rims ignored, or nothing.
template <class Exit>
class TargetSolver {
public:
    TargetSolver(const Exit& exit, double focalLengthMm)
        : exit_(exit), longestStepMm_(0.5 * focalLengthMm) {}

    static constexpr double toleranceRadians = 1e-6;

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
        constexpr int mostSteps = 12, mostHalvings = 4;
        for (int i = 0; !(miss.radians <= toleranceRadians); ++i) {
            if (i == mostSteps || !miss.sensorStep.allFinite()) return {};
            ++steps_;
            const double length = miss.sensorStep.norm();
            double share = length > longestStepMm_ ? longestStepMm_ / length : 1.0;
            std::optional<ExitRay> next;
            Miss nextMiss{};
            int halvings = 0;
            for (; halvings < mostHalvings; ++halvings, share *= 0.5) {
                next = exit_(s + share * miss.sensorStep, apertureShare);
                if (!next) continue;
                nextMiss = missOf(*next, target);
                if (nextMiss.radians < miss.radians) break;
            }
            if (halvings == mostHalvings) return {};
            s += share * miss.sensorStep;
            ray = next;
            miss = nextMiss;
        }
        // One more step squares what is missing.
        return Aimed{s + miss.sensorStep, *ray};
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
    const Exit& exit_;
    double longestStepMm_;  // beyond which a lens does not turn rays evenly
    int steps_ = 0;
};

}  // namespace etendue
