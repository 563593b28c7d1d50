#include "lens/phase_space.h"

#include <Eigen/LU>
#include <cmath>

#include "lens/surface_intersection.h"

namespace etendue {

PupilSphere::PupilSphere(const OpticalSystem& system) {
    const SurfaceShape& first = system.surfaces.front().shape;
    if (first.curvedInX && first.curvedInY) shape_.curvature = first.curvature;
}

template <class T>
PupilSphere::Frame<T> PupilSphere::frameAbout(const Vector3<T>& n, const T& share) {
    const T xy = -(n.x * n.y * share);
    return {{1.0 - n.x * n.x * share, xy, -n.x}, {xy, 1.0 - n.y * n.y * share, -n.y}, n};
}

template <class T>
std::optional<PupilState<T>> PupilSphere::state(const LensRay<T>& ray) const {
    const std::optional<double> t =
        intersect(shape_, 0.0, valueOf(ray.origin), valueOf(ray.direction), Heading::toScene);
    if (!t) return {};
    const Vector3<T> point = pointOnSurface(shape_, ray, *t);
    const Vector3<T> normal = gradient(shape_, point);
    const Frame<T> frame = frameAbout(normal, 1.0 / (1.0 + normal.z));
    return PupilState<T>{point.x, point.y, dot(ray.direction, frame.x),
                         dot(ray.direction, frame.y)};
}

template <class T>
std::optional<LensRay<T>> PupilSphere::rayOf(const PupilState<T>& state) const {
    using std::sqrt;
    const T squared = state.x * state.x + state.y * state.y;
    const T along = 1.0 - state.directionX * state.directionX - state.directionY * state.directionY;
    const T radicand = conicRadicand(shape_, squared);
    if (!(valueOf(radicand) > 0.0 && valueOf(along) >= 0.0)) return {};
    // On a sphere the sag is c h² over what the frame divides by, too.
    const double c = shape_.curvature;
    const Vector3<T> normal{state.x * -c, state.y * -c, sqrt(radicand)};
    const T share = 1.0 / (1.0 + normal.z);
    const Frame<T> frame = frameAbout(normal, share);
    const Vector3<T> point{state.x, state.y, squared * share * c};
    return LensRay<T>{point, frame.x * state.directionX + frame.y * state.directionY +
                                 frame.normal * sqrt(along)};
}

std::optional<LensRay<double>> PupilSphere::ray(const PupilState<double>& state) const {
    return rayOf(state);
}

template <int N>
std::optional<LensRay<Dual<N>>> PupilSphere::ray(const PupilState<Dual<N>>& state) const {
    return rayOf(state);
}

double PupilSphere::normalZ(double x, double y) const {
    return std::sqrt(conicRadicand(shape_, x * x + y * y));
}

template std::optional<PupilState<double>> PupilSphere::state(const LensRay<double>&) const;
template std::optional<PupilState<Dual<2>>> PupilSphere::state(const LensRay<Dual<2>>&) const;
template std::optional<PupilState<Dual<4>>> PupilSphere::state(const LensRay<Dual<4>>&) const;
template std::optional<LensRay<Dual<2>>> PupilSphere::ray(const PupilState<Dual<2>>&) const;

double etendueDeterminant(const Eigen::Matrix4d& pupilBySensor, const SensorState& sensor,
                          const PupilState<double>& pupil, const PupilSphere& sphere) {
    // At the sensor the projected direction is the direction's x and y, whose determinant by the
    // slope is cos⁴θ. At the sphere the tangential components are; its area is 1/normalZ of its
    // projection's.
    const double squared = sensor.slopeX * sensor.slopeX + sensor.slopeY * sensor.slopeY;
    const double cosSquared = 1.0 / (1.0 + squared);
    return std::abs(pupilBySensor.determinant()) /
           (sphere.normalZ(pupil.x, pupil.y) * cosSquared * cosSquared);
}

}  // namespace etendue
