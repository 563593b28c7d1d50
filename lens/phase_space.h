// The coordinates of rays: at the sensor, at the stop and at the outermost surface, lens space.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "lens/optical_system.h"
#include "lens/vector3.h"

namespace etendue {

/// A ray at a plane across the axis: where it crosses, mm, and its slope (dx/dz, dy/dz), +z toward
/// the scene. At the sensor and at the stop.
template <class T>
struct PlaneState {
    T x, y;
    T slopeX, slopeY;
};
using SensorState = PlaneState<double>;
using ApertureState = PlaneState<double>;

/// A ray at the pupil sphere: its point there, projected along z, mm, and its direction's two
/// components in the tangent frame that the smallest rotation carries from +z to the sphere's
/// normal. Two components are enough: the third, along the normal, is positive.
template <class T>
struct PupilState {
    T x, y;
    T directionX, directionY;
};

template <class T>
LensRay<T> rayOf(const PlaneState<T>& state, double planeZMm) {
    return {{state.x, state.y, T(planeZMm)},
            normalized(Vector3<T>{state.slopeX, state.slopeY, T(1.0)})};
}

/// Where the ray's line crosses the plane. The ray must not run along it.
template <class T>
PlaneState<T> planeState(const LensRay<T>& ray, double planeZMm) {
    const T slopeX = ray.direction.x / ray.direction.z, slopeY = ray.direction.y / ray.direction.z;
    const T depth = planeZMm - ray.origin.z;
    return {ray.origin.x + slopeX * depth, ray.origin.y + slopeY * depth, slopeX, slopeY};
}

/// A ray and how it moves with two variables.
struct DifferentialRay {
    Eigen::Vector3d origin, direction;
    Eigen::Matrix<double, 3, 2> originDerivatives, directionDerivatives;
};

/// The sphere that touches the first surface at its vertex, the origin, with its curvature there;
/// the plane z = 0 for a plane and for a cylinder. Fields beyond 90° need a sphere.
class PupilSphere {
public:
    explicit PupilSphere(const OpticalSystem& system);

    /// Of a ray that leaves the lens. Empty when its line misses the sphere's scene-side sheet.
    template <class T>
    std::optional<PupilState<T>> state(const LensRay<T>& ray) const;
    /// The inverse. Empty when the point is beyond the equator or the direction longer than 1.
    std::optional<LensRay<double>> ray(const PupilState<double>& state) const;
    /// With the derivatives that those of (x, y, directionX, directionY) by two variables make.
    std::optional<DifferentialRay> ray(const PupilState<double>& state,
                                       const Eigen::Matrix<double, 4, 2>& derivatives) const;

    /// 1/mm; positive if the centre lies toward the scene.
    double curvature() const { return shape_.curvature; }
    /// z of the unit normal above (x, y): a piece of the sphere is 1/normalZ of its projection.
    double normalZ(double x, double y) const;

private:
    /// From the wanted frame to lens space.
    template <class T>
    struct Frame {
        Vector3<T> x, y, normal;
    };
    template <class T>
    static Frame<T> frameAbout(const Vector3<T>& normal);

    SurfaceShape shape_;
};

/// |det| of the map sensor ray → scene ray in (position × projected direction), from the Jacobian
/// of (x, y, directionX, directionY) at `pupil` by (x, y, slopeX, slopeY) at `sensor`. A lens
/// has 1.
double etendueDeterminant(const Eigen::Matrix4d& pupilBySensor, const SensorState& sensor,
                          const PupilState<double>& pupil, const PupilSphere& sphere);
/// The same from the Jacobian by (s, a); `exchange` is J of equation (1).
double etendueDeterminant(const Eigen::Matrix4d& pupilBySensorAndAperture, double exchange,
                          const PupilState<double>& pupil, const PupilSphere& sphere);

}  // namespace etendue
