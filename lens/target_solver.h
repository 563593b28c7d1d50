// TargetSolver: the sensor point from which the ray through a given aperture point meets a target.
#pragma once

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "lens/lens_model.h"

namespace etendue {

/// Two columns across `direction`, right-handed about it.
inline Eigen::Matrix<double, 3, 2> frameAcross(const Eigen::Vector3d& direction) {
    Eigen::Matrix<double, 3, 2> frame;
    frame.col(0) = direction.unitOrthogonal();
    frame.col(1) = direction.cross(frame.col(0));
    return frame;
}

/// By how much a ray's direction misses a target, seen from where the ray leaves the lens.
struct Miss {
    Eigen::Matrix<double, 3, 2> frame;  // across the ray
    Eigen::Vector2d radians;            // in it, from the ray's direction to the target's
    double distanceMm;
};

inline Miss missOf(const ExitRay& ray, const Eigen::Vector3d& target) {
    Miss miss;
    const Eigen::Vector3d toTarget = target - ray.origin;
    miss.distanceMm = toTarget.norm();
    miss.frame = frameAcross(ray.direction);
    const Eigen::Vector3d wanted = toTarget / miss.distanceMm;
    const Eigen::Vector2d across = miss.frame.transpose() * wanted;
    const double sine = across.norm(), cosine = wanted.dot(ray.direction);
    if (sine > 0.0)
        miss.radians = across * (std::atan2(sine, cosine) / sine);
    else  // straight ahead or straight behind
        miss.radians << (cosine > 0.0 ? 0.0 : std::numbers::pi), 0.0;
    return miss;
}

/// Newton's method on the direction in which rays leave. `Exit`, called with a sensor point and the
/// share of the aperture point to go through, gives an exit ray, rims ignored, or nothing.
template <class Exit>
class TargetSolver {
public:
    TargetSolver(const Exit& exit, double focalLengthMm)
        : exit_(exit), longestStepMm_(0.5 * focalLengthMm) {}

    /// From the sensor point `s`. Steps are halved until the miss shrinks.
    std::optional<Eigen::Vector2d> newton(const Eigen::Vector3d& target, Eigen::Vector2d s,
                                          double apertureShare = 1.0) const {
        std::optional<ExitRay> at = exit_(s, apertureShare);
        constexpr int mostSteps = 12, mostHalvings = 4;
        for (int i = 0; at && i < mostSteps; ++i) {
            const Miss miss = missOf(*at, target);
            Eigen::Vector2d step = stepFor(*at, miss);
            if (!step.allFinite()) return {};
            // One more step squares what is missing: far below rounding.
            if (miss.radians.norm() <= 1e-8) return s + step;
            if (step.norm() > longestStepMm_) step *= longestStepMm_ / step.norm();
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

    /// From the ray along the axis outward: aperture point and target are led from there to their
    /// places, the target on a circle about the first surface.
    std::optional<Eigen::Vector2d> follow(const Eigen::Vector3d& target) const {
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
                change = (*found - s) / (t - reached);
                s = *found;
                reached = t;
            } else {
                stride *= 0.5;
            }
        }
        return {};
    }

private:
    /// To first order, moving the sensor point by it takes the miss away.
    static Eigen::Vector2d stepFor(const ExitRay& ray, const Miss& miss) {
        const Eigen::Matrix2d turn =
            miss.frame.transpose() * (ray.directionBySensor + ray.originBySensor / miss.distanceMm);
        return turn.inverse() * miss.radians;
    }

    const Exit& exit_;
    double longestStepMm_;  // beyond which a lens does not turn rays evenly
};

}  // namespace etendue
