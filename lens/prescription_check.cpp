#include "lens/prescription_check.h"

#include <algorithm>
#include <cmath>

#include "lens/number_text.h"

namespace etendue {

namespace {

using Fault = std::optional<PrescriptionFault>;

std::string surfaceName(std::size_t index) { return "surface[" + std::to_string(index) + "]"; }

bool isStop(const Surface& surface) { return surface.kind == SurfaceKind::stop; }

Fault stopFault(const Prescription& prescription) {
    std::optional<std::size_t> stop;
    for (std::size_t i = 0; i < prescription.surfaces.size(); ++i) {
        if (!isStop(prescription.surfaces[i])) continue;
        if (stop)
            return PrescriptionFault{i, "type",
                                     "a second stop; the first is " + surfaceName(*stop)};
        stop = i;
    }
    if (!stop) return PrescriptionFault{{}, "surface", "no stop among the surfaces"};
    if (prescription.surfaces.size() == 1)
        return PrescriptionFault{{}, "surface", "nothing but a stop"};
    return {};
}

Fault shapeFault(const Surface& surface, std::size_t index) {
    const auto fault = [index](std::string key, std::string message) {
        return PrescriptionFault{index, std::move(key), std::move(message)};
    };
    if (std::isnan(surface.radiusMm) || surface.radiusMm == 0.0)
        return fault("radius_mm", "a radius must differ from 0 (inf for a plane)");
    if (!std::isfinite(surface.thicknessMm))
        return fault("thickness_mm", "the thickness must be finite");
    if (!(surface.semiApertureMm > 0.0 && std::isfinite(surface.semiApertureMm)))
        return fault("semi_aperture_mm", "the semi-aperture must be positive");
    if (!std::isfinite(surface.conic)) return fault("conic", "the conic must be finite");
    for (std::size_t i = 0; i < surface.asphere.size(); ++i)
        if (!std::isfinite(surface.asphere[i]))
            return fault("a" + std::to_string(2 * i + 4), "the coefficient must be finite");
    const double square = surface.semiApertureMm * surface.semiApertureMm;
    const SurfaceShape shape = lensSpaceShape(surface);
    if (!(conicRadicand(shape, square) >= 0.0)) {
        const double reach = std::abs(surface.radiusMm) / std::sqrt(1.0 + surface.conic);
        return fault("semi_aperture_mm", "the semi-aperture " + numberText(surface.semiApertureMm) +
                                             " mm is beyond the surface, which ends at " +
                                             numberText(reach) + " mm from the axis");
    }
    return {};
}

Fault mediumFault(const Surface& surface, std::size_t index, const Glass& front) {
    if (!isPlausible(surface.behind))
        return PrescriptionFault{index, "nd",
                                 "no glass: between 350 and 1100 nm its index must be at least 1 "
                                 "and fall toward the red"};
    if (!surface.coating) return {};
    const Coating& coating = *surface.coating;
    const double rarer = std::min(refractiveIndex(front, shortestWavelengthNm),
                                  refractiveIndex(surface.behind, shortestWavelengthNm));
    if (!(coating.index >= rarer && std::isfinite(coating.index)))
        return PrescriptionFault{
            index, "coating.index",
            "a coating must not be rarer than both media, " + numberText(rarer)};
    if (!(coating.designWavelengthNm > 0.0 && coating.thicknessWaves > 0.0))
        return PrescriptionFault{index, "coating", "wavelength and thickness must be positive"};
    return {};
}

/// Distance from `surface` to the one `apartMm` behind it, least over the smaller clear aperture;
/// not a number where one has no height, along both axes and the diagonal, which is enough for
/// surfaces of revolution and cylinders.
double leastGap(const Surface& surface, const Surface& behind, double apartMm) {
    const SurfaceShape here = lensSpaceShape(surface), there = lensSpaceShape(behind);
    const double rim = std::min(surface.semiApertureMm, behind.semiApertureMm);
    constexpr int steps = 64;
    double least = apartMm;
    for (int i = 1; i <= steps; ++i) {
        const double h = rim * i / steps;
        for (const double turn : {0.0, std::sqrt(0.5), 1.0}) {
            const double x = h * turn, y = h * std::sqrt(1.0 - turn * turn);
            const auto sagAt = [&](const SurfaceShape& shape) {
                return sag(shape, heightSquared(shape, x, y));
            };
            const double gap = apartMm + sagAt(here) - sagAt(there);
            if (std::isnan(gap)) return gap;
            least = std::min(least, gap);
        }
    }
    return least;
}

/// The stop is no body: only what bends light must not cross.
Fault crossingFault(const Prescription& prescription) {
    std::optional<std::size_t> before;
    double apart = 0.0;
    for (std::size_t i = 0; i < prescription.surfaces.size(); ++i) {
        const Surface& surface = prescription.surfaces[i];
        if (isStop(surface)) {
            apart += surface.thicknessMm;
            continue;
        }
        if (before) {
            const Surface& front = prescription.surfaces[*before];
            const double gap = leastGap(front, surface, apart);
            if (std::isnan(gap))
                return PrescriptionFault{*before, "semi_aperture_mm",
                                         surfaceName(*before) + " or " + surfaceName(i) +
                                             " has no height within its semi-aperture"};
            const double rounding = 1e-9 * (std::abs(apart) + surface.semiApertureMm);
            if (!(gap >= -rounding))
                return PrescriptionFault{*before, "thickness_mm",
                                         surfaceName(*before) + " and " + surfaceName(i) + ", " +
                                             numberText(apart) +
                                             " mm apart on the axis, cross by " + numberText(-gap) +
                                             " mm within their semi-apertures"};
        }
        before = i;
        apart = surface.thicknessMm;
    }
    return {};
}

}  // namespace

Fault findFault(const Prescription& prescription) {
    if (Fault fault = stopFault(prescription)) return fault;
    Glass front = Air{};
    for (std::size_t i = 0; i < prescription.surfaces.size(); ++i) {
        const Surface& surface = prescription.surfaces[i];
        if (Fault fault = shapeFault(surface, i)) return fault;
        if (Fault fault = mediumFault(surface, i, front)) return fault;
        front = surface.behind;
    }
    if (!std::holds_alternative<Air>(front))
        return PrescriptionFault{prescription.surfaces.size() - 1, "nd",
                                 "behind the last surface there must be air"};
    return crossingFault(prescription);
}

}  // namespace etendue
