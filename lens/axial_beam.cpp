#include "lens/axial_beam.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "lens/paraxial.h"
#include "lens/prescription_check.h"
#include "lens/sequential_trace.h"

namespace etendue {

namespace {

/// A ray parallel to the axis at the given height along the unit vector (x, y).
LensRay<double> axialRay(double height, double x, double y) {
    return {{x * height, y * height, 0.0}, {0.0, 0.0, -1.0}};
}

/// Height of the highest axial ray along (x, y) that passes, and where the next one ends.
std::pair<double, std::size_t> highestRay(const MonochromaticSystem& lens, double x, double y) {
    const auto passage = [&](double height) {
        LensRay<double> ray = axialRay(height, x, y);
        return carryToSensor<TraceMode::light>(lens, 0, lens.system.surfaces.size(), ray,
                                               [](auto...) {});
    };
    const auto passes = [&](double height) {
        return passage(height).status == TraceStatus::passed;
    };
    // Outward in steps: of rays that pass beyond the first that is blocked we want none.
    constexpr int steps = 256, halvings = 40;
    const double step = lens.system.surfaces.front().semiApertureMm / (steps - 1);
    int passed = 0;
    while (passed < steps && passes((passed + 1) * step)) ++passed;
    double low = passed * step, high = low + step;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (low + high);
        (passes(middle) ? low : high) = middle;
    }
    return {low, passage(high).surface};
}

/// Where the axial ray meets the stop: its distance from the axis.
double heightAtStop(const MonochromaticSystem& lens, double height, double x, double y,
                    double fNumber) {
    LensRay<double> ray = axialRay(height, x, y);
    const Passage passage =
        carryToSensor<TraceMode::geometry>(lens, 0, lens.system.stop + 1, ray, [](auto...) {});
    if (passage.status != TraceStatus::passed)
        throw std::invalid_argument("f/" + std::to_string(fNumber) +
                                    ": so wide a beam does not reach the stop");
    return std::hypot(ray.origin.x, ray.origin.y);
}

}  // namespace

AxialBeam widestAxialBeam(const OpticalSystem& system) {
    const std::vector<double> indices = refractiveIndices(system, dLineNm);
    const MonochromaticSystem lens{system, indices, dLineNm};
    const auto [heightY, limit] = highestRay(lens, 0.0, 1.0);
    return {highestRay(lens, 1.0, 0.0).first, heightY, limit};
}

double stopRadiusForFNumber(const OpticalSystem& system, double fNumber) {
    if (!(fNumber > 0.0 && std::isfinite(fNumber)))
        throw std::invalid_argument("the f-number must be positive");
    const std::vector<double> indices = refractiveIndices(system, dLineNm);
    const MonochromaticSystem lens{system, indices, dLineNm};
    const ParaxialData data = paraxialData(system);
    const double half = 0.5 / fNumber;
    const double x = heightAtStop(lens, half * data.x.focalLengthMm, 1.0, 0.0, fNumber);
    const double y = heightAtStop(lens, half * data.y.focalLengthMm, 0.0, 1.0, fNumber);
    const double radius = std::sqrt(x * y);
    const double widest = system.surfaces[system.stop].semiApertureMm;
    if (!(radius <= widest * (1.0 + statedFNumberTolerance)))
        throw std::invalid_argument("f/" + std::to_string(fNumber) + " needs a stop of " +
                                    std::to_string(radius) + " mm radius; it opens to " +
                                    std::to_string(widest) + " mm");
    return std::min(radius, widest);
}

}  // namespace etendue
