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
PupilSphere::Frame<T> PupilSphere::frameAbout(const Vector3<T>& n) {
    const T share = 1.0 / (1.0 + n.z);
    const T xy = -(n.x * n.y * share);
    return {{1.0 - n.x * n.x * share, xy, -n.x}, {xy, 1.0 - n.y * n.y * share, -n.y}, n};
}

template <class T>
std::optional<PupilState<T>> PupilSphere::state(const LensRay<T>& ray) const {
    const std::optional<double> t =
        intersect(shape_, 0.0, valueOf(ray.origin), valueOf(ray.direction), Heading::toScene);
    if (!t) return {};
    const Vector3<T> point = pointOnSurface(shape_, ray, *t);
    const Frame<T> frame = frameAbout(gradient(shape_, point));
    return PupilState<T>{point.x, point.y, dot(ray.direction, frame.x),
                         dot(ray.direction, frame.y)};
}

std::optional<LensRay<double>> PupilSphere::ray(const PupilState<double>& state) const {
    const auto ray = this->ray(state, Eigen::Matrix<double, 4, 2>::Zero());
    if (!ray) return {};
    return LensRay<double>{fromEigen(ray->origin), fromEigen(ray->direction)};
}

std::optional<DifferentialRay> PupilSphere::ray(
    const PupilState<double>& state, const Eigen::Matrix<double, 4, 2>& derivatives) const {
    // The normal is (m, n); the frame turns a tangential direction t with w along the normal into
    // (t + g m, w n − m·t), g being w − m·t / (1 + n).
    const double c = shape_.curvature, squared = state.x * state.x + state.y * state.y;
    const double nSquared = conicRadicand(shape_, squared);
    const Eigen::Vector2d t(state.directionX, state.directionY);
    const double wSquared = 1.0 - t.squaredNorm();
    if (!(nSquared > 0.0 && wSquared >= 0.0)) return {};
    const Eigen::Vector2d m(-c * state.x, -c * state.y);
    const double n = std::sqrt(nSquared), w = std::sqrt(wSquared), share = 1.0 / (1.0 + n);
    const double mt = m.dot(t), g = w - mt * share;
    DifferentialRay ray;
    ray.origin << state.x, state.y, squared * share * c;
    ray.direction << t + g * m, w * n - mt;
    const double perN = 1.0 / n, perW = 1.0 / w;
    for (Eigen::Index i = 0; i < 2; ++i) {
        const Eigen::Vector2d dPoint = derivatives.block<2, 1>(0, i);
        const Eigen::Vector2d dt = derivatives.block<2, 1>(2, i), dm = -c * dPoint;
        const double dn = -m.dot(dm) * perN, dw = -t.dot(dt) * perW;
        const double dmt = dm.dot(t) + m.dot(dt);
        const double dg = dw - dmt * share + mt * share * share * dn;
        ray.originDerivatives.col(i) << dPoint, -m.dot(dPoint) * perN;
        ray.directionDerivatives.col(i) << dt + g * dm + dg * m, dw * n + w * dn - dmt;
    }
    return ray;
}

double PupilSphere::normalZ(double x, double y) const {
    return std::sqrt(conicRadicand(shape_, x * x + y * y));
}

template std::optional<PupilState<double>> PupilSphere::state(const LensRay<double>&) const;
template std::optional<PupilState<Dual<2>>> PupilSphere::state(const LensRay<Dual<2>>&) const;
template std::optional<PupilState<Dual<4>>> PupilSphere::state(const LensRay<Dual<4>>&) const;

double etendueDeterminant(const Eigen::Matrix4d& pupilBySensor, const SensorState& sensor,
                          const PupilState<double>& pupil, const PupilSphere& sphere) {
    // At the sensor the projected direction is the direction's x and y, whose determinant by the
    // slope is cos⁴θ.
    const double squared = sensor.slopeX * sensor.slopeX + sensor.slopeY * sensor.slopeY;
    const double cosSquared = 1.0 / (1.0 + squared);
    return etendueDeterminant(pupilBySensor, cosSquared * cosSquared, pupil, sphere);
}

double etendueDeterminant(const Eigen::Matrix4d& pupilBySensorAndAperture, double exchange,
                          const PupilState<double>& pupil, const PupilSphere& sphere) {
    // At the sphere the tangential components are the projected direction; its area is 1/normalZ of
    // its projection's.
    return std::abs(pupilBySensorAndAperture.determinant()) /
           (sphere.normalZ(pupil.x, pupil.y) * exchange);
}

}  // namespace etendue
