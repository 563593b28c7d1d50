#include "lens/stop_region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "lens/stop_ray.h"

namespace etendue {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool passes(const MonochromaticSystem& lens, const Eigen::Vector2d& a, const Eigen::Vector2d& p) {
    const PlaneState<double> state{a.x(), a.y(), p.x(), p.y()};
    LensRay<double> front = rayAtStop(lens.system, state), rear = front;
    return leaveRear<TraceMode::light>(lens, rear).status == TraceStatus::passed &&
           leaveFront<TraceMode::light>(lens, front).status == TraceStatus::passed;
}

/// p per a of the rays from the sensor's centre, in the paraxial limit.
Eigen::Vector2d paraxialCentre(const OpticalSystem& system, double sensorZMm) {
    using D = Dual<4>;
    const std::vector<double> indices = refractiveIndices(system, dLineNm);
    const MonochromaticSystem lens{system, indices, dLineNm};
    LensRay<D> ray = rayAtStop<D>(lens.system, {D::variable(0.0, 0), D::variable(0.0, 1),
                                                D::variable(0.0, 2), D::variable(0.0, 3)});
    if (leaveRear<TraceMode::geometry>(lens, ray).status != TraceStatus::passed) return {0.0, 0.0};
    const PlaneState<D> end = planeState(ray, sensorZMm);
    const Eigen::Vector2d centre(-end.x.partials[0] / end.x.partials[2],
                                 -end.y.partials[1] / end.y.partials[3]);
    return centre.allFinite() ? centre : Eigen::Vector2d(0.0, 0.0);
}

}  // namespace

/// How far along a direction from the centre rays still pass, approached from outside: what passes
/// need not be connected. Negative where none does.
double StopRegion::outermost(const MonochromaticSystem& lens, const Eigen::Vector2d& aperture,
                             const Eigen::Vector2d& along) const {
    constexpr double steepest = 6.0, stride = 0.87;
    constexpr int mostStrides = 60, halvings = 4;
    const auto passesAt = [&](double r) {
        return passes(lens, aperture, centre(aperture) + r * along);
    };
    double inside = steepest;
    int strides = 0;
    while (strides < mostStrides && !passesAt(inside)) {
        inside *= stride;
        ++strides;
    }
    if (strides == mostStrides) return passesAt(0.0) ? 0.0 : -1.0;
    double outside = inside / stride;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (inside + outside);
        (passesAt(middle) ? inside : outside) = middle;
    }
    return outside;
}

void StopRegion::widen(Box& box, const MonochromaticSystem& lens, const Eigen::Vector2d& aperture) {
    constexpr int directions = 12;
    for (int i = 0; i <= directions; ++i) {
        const double turn = std::numbers::pi * i / directions;
        const Eigen::Vector2d along(std::cos(turn), std::sin(turn));
        const double reach = outermost(lens, aperture, along);
        if (reach < 0.0) continue;
        edge_.push_back({aperture, centre(aperture) + reach * along});
        box.lowest = std::min(box.lowest, reach * along.x());
        box.highest = std::max(box.highest, reach * along.x());
        box.widest = std::max(box.widest, reach * along.y());
    }
}

StopRegion::StopRegion(const OpticalSystem& system, double sensorZMm)
    : isAxial_(std::ranges::all_of(system.surfaces,
                                   [](const TracedSurface& surface) {
                                       return surface.shape.curvature == 0.0 ||
                                              (surface.shape.curvedInX && surface.shape.curvedInY);
                                   })),
      ringsPerMm_((ringCount - 1) / system.aperture.radiusMm()),
      centrePerMm_(paraxialCentre(system, sensorZMm)) {
    // The centre counts as inside: what passes may be a ring about it, or lie all on one side.
    std::array<Box, ringCount> rings;
    rings.fill({0.0, 0.0, 0.0});
    for (const double nm : {shortestWavelengthNm, longestWavelengthNm}) {
        const std::vector<double> indices = refractiveIndices(system, nm);
        const MonochromaticSystem lens{system, indices, nm};
        if (isAxial_)
            for (std::size_t i = 0; i < ringCount; ++i)
                widen(rings[i], lens, {static_cast<double>(i) / ringsPerMm_, 0.0});
        else
            widenForAll(rings.front(), lens);
    }
    if (!isAxial_) rings.fill(rings.front());
    for (std::size_t i = 0; i + 1 < ringCount; ++i) boxes_[i] = between(rings[i], rings[i + 1]);
}

void StopRegion::widenForAll(Box& box, const MonochromaticSystem& lens) {
    widen(box, lens, {0.0, 0.0});
    constexpr int directions = 16;
    for (int k = 0; k <= directions; ++k)
        for (const double share : {0.5, 1.0}) {
            const double turn = std::numbers::pi * (static_cast<double>(k) / directions - 0.5);
            const double radius = share * lens.system.aperture.radiusMm();
            widen(box, lens, {radius * std::cos(turn), radius * std::sin(turn)});
        }
    box.highest = std::max(box.highest, -box.lowest);  // mirrored
    box.lowest = -box.highest;
}

StopRegion::Box StopRegion::between(const Box& inner, const Box& outer) {
    // Where nothing was seen to pass, who knows what does.
    for (const Box& box : {inner, outer})
        if (!(box.lowest < box.highest)) return {-infinity, infinity, infinity};
    Box box{std::min(inner.lowest, outer.lowest), std::max(inner.highest, outer.highest),
            std::max(inner.widest, outer.widest)};
    // Beyond what one ring differs from the next, and the directions tried from those between.
    constexpr double share = 0.08;
    const double margin = share * std::max({box.highest, -box.lowest, box.widest});
    box.lowest -= margin;
    box.highest += margin;
    box.widest += margin;
    return box;
}

double StopRegion::steepest() const {
    double most = 0.0;
    for (const EdgeRay& ray : edge_) most = std::max(most, ray.slope.norm());
    return most;
}

Eigen::Vector2d StopRegion::nearest(AperturePoint aperture, const Eigen::Vector2d& slope) const {
    const double radius = aperture.mm.norm();
    const std::size_t ring =
        std::min(static_cast<std::size_t>(radius * ringsPerMm_), boxes_.size() - 1);
    const Box& box = boxes_[ring];
    const Eigen::Vector2d middle = centre(aperture.mm), off = slope - middle;
    Eigen::Vector2d along(1.0, 0.0);
    if (isAxial_ && radius > 0.0) along = aperture.mm / radius;
    const Eigen::Vector2d across(-along.y(), along.x());
    const Eigen::Vector2d inFrame(off.dot(along), off.dot(across));
    const Eigen::Vector2d inside(std::clamp(inFrame.x(), box.lowest, box.highest),
                                 std::clamp(inFrame.y(), -box.widest, box.widest));
    if (inside == inFrame) return slope;  // to the bit
    return middle + inside.x() * along + inside.y() * across;
}

}  // namespace etendue
