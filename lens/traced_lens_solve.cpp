// The two solves of a TracedLens, trace and connect, with the derivatives that dual numbers bring
// along.
#include <Eigen/LU>
#include <cmath>

#include "lens/slope_solver.h"
#include "lens/target_solver.h"
#include "lens/traced_lens.h"
#include "lens/two_step_newton.h"

namespace etendue {

namespace {

constexpr auto ignore = [](auto...) {};

std::optional<StopHit> stopHit(const MonochromaticSystem& lens, SensorPoint sensor,
                               const Eigen::Vector2d& q, double sensorZMm) {
    using D = Dual<2>;
    const PlaneState<D> state{D(sensor.mm.x()), D(sensor.mm.y()), D::variable(q.x(), 0),
                              D::variable(q.y(), 1)};
    LensRay<D> ray = rayOf(state, sensorZMm);
    const std::size_t stop = lens.system.stop, end = lens.system.surfaces.size();
    const Passage passage = carryToScene<TraceMode::geometry>(lens, stop, end, ray, ignore);
    if (passage.status != TraceStatus::passed) return {};
    return StopHit{toEigen(valueOf(ray.origin)).head<2>(), partials(ray.origin).topRows<2>()};
}

std::optional<StateRay> stateRay(const MonochromaticSystem& lens, SensorPoint sensor,
                                 const Eigen::Vector2d& q, double sensorZMm) {
    using D = Dual<2>;
    const std::optional<StopHit> hit = stopHit(lens, sensor, q, sensorZMm);
    if (!hit) return {};
    const PlaneState<D> state{D::variable(sensor.mm.x(), 0), D::variable(sensor.mm.y(), 1),
                              D(q.x()), D(q.y())};
    LensRay<D> ray = rayOf(state, sensorZMm);
    const Passage passage =
        carryToScene<TraceMode::geometry>(lens, 0, lens.system.surfaces.size(), ray, ignore);
    if (passage.status != TraceStatus::passed) return {};
    return StateRay{*hit, ExitRay{toEigen(valueOf(ray.origin)), toEigen(valueOf(ray.direction)),
                                  partials(ray.origin), partials(ray.direction), 1.0}};
}

/// A ray as far as the stop, differentiated by (s, q).
struct RearRay {
    LensRay<Dual<4>> ray;  // behind the stop's plane
    Eigen::Matrix2d apertureBySensor, apertureBySlope;
    double transmittance;
};

template <TraceMode mode>
std::optional<RearRay> toStop(const MonochromaticSystem& lens, SensorPoint sensor,
                              const Eigen::Vector2d& q, double sensorZMm) {
    using D = Dual<4>;
    const PlaneState<D> state{D::variable(sensor.mm.x(), 0), D::variable(sensor.mm.y(), 1),
                              D::variable(q.x(), 2), D::variable(q.y(), 3)};
    RearRay rear{rayOf(state, sensorZMm), {}, {}, 1.0};
    const std::size_t stop = lens.system.stop, end = lens.system.surfaces.size();
    Passage passage = carryToScene<mode>(lens, stop + 1, end, rear.ray, ignore);
    if (passage.status != TraceStatus::passed) return {};
    rear.transmittance = passage.transmittance;
    // Without its rim: rounding must not end a ray that is aimed at a point inside.
    if (!crossSurface<Heading::toScene, TraceMode::geometry>(lens, stop, rear.ray, passage))
        return {};
    const auto& [x, y, z] = rear.ray.origin;
    rear.apertureBySensor << x.partials[0], x.partials[1], y.partials[0], y.partials[1];
    rear.apertureBySlope << x.partials[2], x.partials[3], y.partials[2], y.partials[3];
    return rear;
}

/// The same ray, differentiated by s alone with the aperture point held fixed.
LensRay<Dual<2>> throughFixedAperture(const RearRay& rear, AperturePoint aperture) {
    const Eigen::Matrix2d k = slopeBySensor(rear.apertureBySlope, rear.apertureBySensor);
    const auto held = [&k](const Dual<4>& component) {
        Dual<2> result(component.value);
        const auto& by = component.partials;
        result.partials[0] = by[0] + by[2] * k(0, 0) + by[3] * k(1, 0);
        result.partials[1] = by[1] + by[2] * k(0, 1) + by[3] * k(1, 1);
        return result;
    };
    const auto& [x, y, z] = rear.ray.direction;
    return {{Dual<2>(aperture.mm.x()), Dual<2>(aperture.mm.y()), Dual<2>(rear.ray.origin.z.value)},
            {held(x), held(y), held(z)}};
}

}  // namespace

std::optional<Eigen::Vector2d> MonochromaticLens::slopeThrough(SensorPoint sensor,
                                                               AperturePoint aperture) const {
    const MonochromaticSystem view = system();
    const std::size_t stop = view.system.stop;
    const StopMap& paraxial = lens_->paraxialStopMap();
    return solveSlope(
        [&](const Eigen::Vector2d& q) { return stopHit(view, sensor, q, lens_->sensorZMm()); },
        paraxialSlope(paraxial, sensor, aperture), aperture,
        view.system.surfaces[stop].semiApertureMm);
}

template <TraceMode mode>
std::optional<ExitRay> MonochromaticLens::exitRay(SensorPoint sensor,
                                                  AperturePoint aperture) const {
    const std::optional<Eigen::Vector2d> q = slopeThrough(sensor, aperture);
    if (!q) return {};
    const MonochromaticSystem view = system();
    const std::optional<RearRay> rear = toStop<mode>(view, sensor, *q, lens_->sensorZMm());
    if (!rear) return {};
    const Eigen::Vector2d& paraxial = lens_->paraxialStopMap().bySlope;
    if (!(rear->apertureBySlope.determinant() * paraxial.x() * paraxial.y() > 0.0)) return {};

    LensRay<Dual<2>> front = throughFixedAperture(*rear, aperture);
    const Passage passage = carryToScene<mode>(view, 0, view.system.stop, front, ignore);
    if (passage.status != TraceStatus::passed) return {};
    const double transmittance = rear->transmittance * passage.transmittance;
    const ExitRay ray{toEigen(valueOf(front.origin)), toEigen(valueOf(front.direction)),
                      partials(front.origin), partials(front.direction),
                      exchangeJacobian(*q, rear->apertureBySlope) * transmittance};
    if (mode == TraceMode::geometry) return ray;
    // Folded, or so grazing that nothing is let through.
    if (!(turning(ray) > 0.0 && ray.throughput > 0.0)) return {};
    return ray;
}

std::optional<ExitRay> MonochromaticLens::trace(SensorPoint sensor, AperturePoint aperture) const {
    if (!lens_->system().aperture.contains(aperture.mm)) return {};
    return exitRay<TraceMode::light>(sensor, aperture);
}

std::optional<ExitRay> MonochromaticLens::chiefRay(SensorPoint sensor) const {
    return exitRay<TraceMode::geometry>(sensor, {{0.0, 0.0}});
}

Connection MonochromaticLens::solveByTwoSteps(const Eigen::Vector3d& target,
                                              AperturePoint aperture) const {
    const MonochromaticSystem view = system();
    const auto ray = [&](SensorPoint s, const Eigen::Vector2d& q) {
        return stateRay(view, s, q, lens_->sensorZMm());
    };
    const double stopRadiusMm = view.system.surfaces[view.system.stop].semiApertureMm;
    const TwoStepResult end = twoStepNewton(ray, target, aperture, stopRadiusMm);
    if (!end.sensor) return {ConnectStatus::unsolved, {}, end.iterations};
    if (!trace(*end.sensor, aperture)) return {ConnectStatus::blocked, {}, end.iterations};
    return {ConnectStatus::found, end.sensor, end.iterations};
}

}  // namespace etendue
