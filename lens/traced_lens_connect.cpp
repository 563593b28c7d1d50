// How a TracedLens finds the sensor point that sees a target. With the aperture point fixed, the
// slope at the stop is sought: the target depends on the elements in front of the stop alone, and
// once the ray is found, those behind it say which sensor point it comes from.
#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "lens/stop_ray.h"
#include "lens/target_solver.h"
#include "lens/traced_lens.h"

namespace etendue {

namespace {

const Connection nothing{ConnectStatus::outOfField, {}, 0};

/// In the scene, rims ignored; the derivatives are those by the slope at the stop.
std::optional<ExitRay> rayInScene(const MonochromaticSystem& lens, const Eigen::Vector2d& a,
                                  const Eigen::Vector2d& p) {
    using D = Dual<2>;
    LensRay<D> ray = rayAtStop<D>(
        lens.system, {D(a.x()), D(a.y()), D::variable(p.x(), 0), D::variable(p.y(), 1)});
    if (leaveFront<TraceMode::geometry>(lens, ray).status != TraceStatus::passed) return {};
    return ExitRay{toEigen(valueOf(ray.origin)), toEigen(valueOf(ray.direction)),
                   partials(ray.origin), partials(ray.direction), 1.0};
}

/// Of light, which rims stop.
struct FrontRay {
    Passage passage;
    LensRay<double> ray;
};

/// With the slope `p` at the stop, by which the derivatives of `near` are. That is moved until the
/// ray meets the target to rounding, which it does at once but where the lens all but folds.
std::optional<FrontRay> lightInScene(const MonochromaticSystem& lens, const Eigen::Vector3d& target,
                                     const Eigen::Vector2d& a, ExitRay near, Eigen::Vector2d& p) {
    constexpr int mostSteps = 2;
    constexpr double toleranceRadians = 1e-12;
    for (int i = 0;; ++i) {
        FrontRay front{{}, rayAtStop<double>(lens.system, {a.x(), a.y(), p.x(), p.y()})};
        front.passage = leaveFront<TraceMode::light>(lens, front.ray);
        if (front.passage.status != TraceStatus::passed) return {};
        near.origin = toEigen(front.ray.origin);
        near.direction = toEigen(front.ray.direction);
        const Miss miss = missOf(near, target);
        if (i == mostSteps || !(miss.squared > toleranceRadians * toleranceRadians)) return front;
        p += miss.sensorStep;
    }
}

/// The sensor's end of a ray through the stop.
struct SensorEnd {
    Eigen::Vector2d mm;
    Eigen::Matrix2d bySlope;  // of the stop
    double transmittance;
};

std::optional<SensorEnd> rayAtSensor(const MonochromaticSystem& lens, double sensorZMm,
                                     const Eigen::Vector2d& a, const Eigen::Vector2d& p) {
    using D = Dual<2>;
    LensRay<D> ray = rayAtStop<D>(
        lens.system, {D(a.x()), D(a.y()), D::variable(p.x(), 0), D::variable(p.y(), 1)});
    const Passage passage = leaveRear<TraceMode::light>(lens, ray);
    if (passage.status != TraceStatus::passed || !(ray.direction.z.value < 0.0)) return {};
    const PlaneState<D> state = planeState(ray, sensorZMm);
    SensorEnd end{{state.x.value, state.y.value}, {}, passage.transmittance};
    end.bySlope << state.x.partials[0], state.x.partials[1], state.y.partials[0],
        state.y.partials[1];
    return end;
}

/// J of equation (1) from the other end: an index n at the stop, |det ∂(n D)/∂s| is that of
/// ∂a/∂(direction at the sensor), étendue being conserved.
double exchangeJacobianAtStop(const Eigen::Vector2d& slope, const Eigen::Matrix2d& sensorBySlope,
                              double index) {
    const double cosSquared = 1.0 / (1.0 + slope.squaredNorm());
    return index * index * cosSquared * cosSquared / std::abs(sensorBySlope.determinant());
}

}  // namespace

std::optional<StopSearch::Start> TracedLens::startOf(const Eigen::Vector3d& target,
                                                     AperturePoint aperture) const {
    if (!system_.aperture.contains(aperture.mm) || !target.allFinite()) return {};
    return stopSearch_.start(target, aperture);
}

Connection TracedLens::solve(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                             double wavelengthNm, ConnectMethod method) const {
    if (!isInRange(wavelengthNm)) return nothing;
    if (method == ConnectMethod::twoStep)
        return MonochromaticLens(*this, wavelengthNm).solve(targetMm, aperture, method);
    // Before any index is looked up: most targets are out of the field.
    const auto start = startOf(targetMm, aperture);
    if (!start) return nothing;
    return MonochromaticLens(*this, wavelengthNm).solveFrom(*start, targetMm, aperture);
}

std::optional<Sighting> TracedLens::see(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                                        double wavelengthNm) const {
    if (!isInRange(wavelengthNm)) return {};
    const auto start = startOf(targetMm, aperture);
    if (!start) return {};
    Connection connection;
    return MonochromaticLens(*this, wavelengthNm).aim(*start, targetMm, aperture, connection);
}

Connection MonochromaticLens::solve(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                                    ConnectMethod method) const {
    if (method == ConnectMethod::newton) {
        const auto start = lens_->startOf(targetMm, aperture);
        return start ? solveFrom(*start, targetMm, aperture) : nothing;
    }
    if (!lens_->system().aperture.contains(aperture.mm) || !targetMm.allFinite()) return nothing;
    return solveByTwoSteps(targetMm, aperture);
}

Connection MonochromaticLens::solveFrom(const StopSearch::Start& start,
                                        const Eigen::Vector3d& target,
                                        AperturePoint aperture) const {
    Connection connection;
    if (const auto sighting = aim(start, target, aperture, connection))
        connection.sensor = sighting->sensor;
    return connection;
}

std::optional<Sighting> MonochromaticLens::aim(const StopSearch::Start& start,
                                               const Eigen::Vector3d& target,
                                               AperturePoint aperture,
                                               Connection& connection) const {
    const MonochromaticSystem view = system();
    const StopSearch& search = lens_->stopSearch_;
    const Eigen::Vector2d& paraxial = lens_->paraxialStopMap().bySlope;
    const double unfolded = paraxial.x() * paraxial.y();  // its sign is that of rays' turning by p
    double reach = start.reach;
    bool metFold = false;
    const auto exit = [&](const Eigen::Vector2d& p,
                          double apertureShare) -> std::optional<ExitRay> {
        if (!((p - start.slope).norm() <= reach)) return {};
        const std::optional<ExitRay> ray = rayInScene(view, apertureShare * aperture.mm, p);
        if (!ray || turning(*ray) * unfolded > 0.0) return ray;
        metFold = true;
        return {};
    };
    constexpr double steadyTurn = 1.0;  // of the slope: beyond it no lens turns rays evenly
    TargetSolver solver(exit, 2.0 * steadyTurn);
    std::optional<Aimed> end = solver.newton(target, start.slope);
    // A search that has come to where the lens folds has to be led around it.
    if (!end && metFold) {
        reach = std::numeric_limits<double>::infinity();
        end = solver.follow(target);
    }
    connection.iterations = solver.steps();
    connection.status = ConnectStatus::unsolved;
    if (!end) return {};

    connection.status = ConnectStatus::blocked;
    Eigen::Vector2d p = end->sensor;
    if (!search.mayPass(aperture, p)) return {};
    const auto front = lightInScene(view, target, aperture.mm, end->ray, p);
    if (!front) return {};
    const auto sensor = rayAtSensor(view, lens_->sensorZMm(), aperture.mm, p);
    if (!sensor) return {};
    if (!(sensor->bySlope.determinant() * unfolded > 0.0)) return {};
    const Eigen::Matrix2d slopeBySensor = sensor->bySlope.inverse();
    const double exchange =
        exchangeJacobianAtStop(p, sensor->bySlope, view.indices[view.system.stop]);
    Sighting sighting{
        {sensor->mm},
        {toEigen(front->ray.origin), toEigen(front->ray.direction),
         end->ray.originBySensor * slopeBySensor, end->ray.directionBySensor * slopeBySensor,
         exchange * front->passage.transmittance * sensor->transmittance}};
    if (!(turning(sighting.ray) > 0.0 && sighting.ray.throughput > 0.0)) return {};
    connection.status = ConnectStatus::found;
    return sighting;
}

}  // namespace etendue
