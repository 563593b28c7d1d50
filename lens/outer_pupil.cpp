#include "lens/outer_pupil.h"

#include <cmath>
#include <numbers>

#include "lens/disc_sampling.h"

namespace etendue {

OuterPupil::OuterPupil(std::shared_ptr<const TracedLens> lens) : lens_(std::move(lens)) {}

std::optional<PupilArrival> OuterPupil::arrive(const Eigen::Vector3d& targetMm, bool isAtInfinity,
                                               Eigen::Vector2d u, double wavelengthNm) const {
    const std::optional<MonochromaticLens> lens = lens_->at(wavelengthNm);
    if (!lens) return {};
    const TracedSurface& front = lens_->system().surfaces.front();
    const double radius = front.semiApertureMm;
    const Eigen::Vector2d p = radius * sampleUnitDisc(u);
    const double squared = heightSquared(front.shape, p.x(), p.y());
    const Eigen::Vector3d point(p.x(), p.y(), front.vertexZMm + sag(front.shape, squared));
    const double slope = 2.0 * sagDerivative(front.shape, squared);
    const Eigen::Vector3d along(front.shape.curvedInX ? -slope * p.x() : 0.0,
                                front.shape.curvedInY ? -slope * p.y() : 0.0, 1.0);
    const Eigen::Vector3d direction =
        isAtInfinity ? targetMm.normalized() : (targetMm - point).normalized();
    // The surface is larger than the disc by the length of `along`, which is not unit.
    const double facing = along.dot(direction);
    if (!(facing > 0.0)) return {};

    // From just outside, so that the first surface is met and not started on.
    const double back = 1e-3 * radius;
    const Eigen::Vector3d start = point + back * direction;
    const TracedRay ray = lens->traceToSensor(
        {{start.x(), start.y(), start.z()}, {-direction.x(), -direction.y(), -direction.z()}});
    if (ray.passage.status != TraceStatus::passed) return {};
    const double discArea = std::numbers::pi * radius * radius;
    return PupilArrival{{ray.ray.origin.x, ray.ray.origin.y},
                        point,
                        direction,
                        ray.passage.transmittance * facing * discArea};
}

}  // namespace etendue
