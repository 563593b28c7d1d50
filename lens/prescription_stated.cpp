// Whether a table gives what its header states, and if not, which of its numbers is to blame.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "lens/axial_beam.h"
#include "lens/number_text.h"
#include "lens/paraxial.h"
#include "lens/prescription_check.h"

namespace etendue {

namespace {

/// Focal lengths and back focal distances in x and y.
using Lengths = std::array<double, 4>;

Lengths lengthsOf(const StatedData& stated) {
    return {stated.focalLengthXMm, stated.focalLengthYMm, stated.backFocalDistanceXMm,
            stated.backFocalDistanceYMm};
}

Lengths lengthsOf(const Prescription& prescription) {
    const ParaxialData data = paraxialData(OpticalSystem(prescription));
    return {data.x.focalLengthMm, data.y.focalLengthMm, data.x.backFocalDistanceMm,
            data.y.backFocalDistanceMm};
}

/// Nothing when `found` agrees with `stated`.
std::optional<std::size_t> firstDisagreement(const Lengths& found, const Lengths& stated) {
    for (std::size_t i = 0; i < found.size(); ++i)
        if (!(std::abs(found[i] - stated[i]) <= statedLengthTolerance * std::abs(stated[i % 2])))
            return i;
    return {};
}

/// A number of the table that a slip of the pen may have spoilt.
struct Suspect {
    std::size_t surface;
    std::string key;
    double written, wanted;
    std::string text() const {
        return "surface[" + std::to_string(surface) + "]." + key + " were " + numberText(wanted) +
               " (it is " + numberText(written) + ")";
    }
    double relativeChange() const { return std::abs(wanted - written) / std::abs(written); }
};

using Change = std::function<void(Surface&, double)>;

/// The value of one number that gives the stated focal length (in y) and everything else besides.
/// In curvatures and thicknesses 1/f is linear, in an index nearly so: secant steps on 1/f.
std::optional<double> repaired(const Prescription& prescription, std::size_t surface,
                               double written, double apart, const Change& change) {
    const Lengths stated = lengthsOf(prescription.stated);
    const auto lengthsAt = [&](double value) -> std::optional<Lengths> {
        Prescription trial = prescription;
        change(trial.surfaces[surface], value);
        if (findFault(trial)) return {};
        return lengthsOf(trial);
    };
    double before = written, value = written + apart;
    double missBefore = 1.0 / lengthsOf(prescription)[1] - 1.0 / stated[1];
    constexpr int mostSteps = 8;
    for (int i = 0; i < mostSteps; ++i) {
        const std::optional<Lengths> lengths = lengthsAt(value);
        if (!lengths) return {};
        const double miss = 1.0 / (*lengths)[1] - 1.0 / stated[1];
        if (std::abs(miss) <= 1e-9 / stated[1])
            return firstDisagreement(*lengths, stated) ? std::nullopt : std::optional(value);
        const double next = value - miss * (value - before) / (miss - missBefore);
        before = value;
        missBefore = miss;
        value = next;
    }
    return {};
}

std::vector<Suspect> suspects(const Prescription& prescription) {
    std::vector<Suspect> found;
    for (std::size_t i = 0; i < prescription.surfaces.size(); ++i) {
        const Surface& surface = prescription.surfaces[i];
        if (surface.kind != SurfaceKind::stop && std::isfinite(surface.radiusMm)) {
            const double curvature = 1.0 / surface.radiusMm;
            if (const auto value = repaired(prescription, i, curvature, 0.01 * curvature,
                                            [](Surface& s, double c) { s.radiusMm = 1.0 / c; }))
                found.push_back({i, "radius_mm", surface.radiusMm, 1.0 / *value});
        }
        if (i + 1 < prescription.surfaces.size())
            if (const auto value = repaired(prescription, i, surface.thicknessMm,
                                            0.01 * std::abs(prescription.stated.focalLengthYMm),
                                            [](Surface& s, double t) { s.thicknessMm = t; }))
                found.push_back({i, "thickness_mm", surface.thicknessMm, *value});
        const double nd = refractiveIndex(surface.behind, dLineNm);
        if (nd > 1.0)
            if (const auto value =
                    repaired(prescription, i, nd, 1e-3, [](Surface& s, double index) {
                        s.behind = ConradyGlass{index, 0.0, 0.0};
                    }))
                found.push_back({i, "nd", nd, *value});
    }
    std::ranges::sort(found, {}, &Suspect::relativeChange);
    return found;
}

std::string suspicion(const Prescription& prescription) {
    const std::vector<Suspect> found = suspects(prescription);
    if (found.empty()) return "; no single radius, thickness or index explains it";
    constexpr std::size_t most = 3;
    std::string text = "; header and table would agree if ";
    for (std::size_t i = 0; i < std::min(most, found.size()); ++i)
        text += (i > 0 ? ", or if " : "") + found[i].text();
    return text;
}

}  // namespace

std::optional<PrescriptionFault> findContradiction(const Prescription& prescription) {
    static const std::array<std::string, 4> keys{"focal_length_x_mm", "focal_length_mm",
                                                 "back_focal_distance_x_mm",
                                                 "back_focal_distance_mm"};
    const Lengths stated = lengthsOf(prescription.stated), found = lengthsOf(prescription);
    if (const auto wrong = firstDisagreement(found, stated)) {
        const bool isX = *wrong % 2 == 0 && isAnamorphic(prescription);
        return PrescriptionFault{{},
                                 keys[isX ? *wrong : *wrong | 1],
                                 "the header states " + numberText(stated[*wrong]) +
                                     " mm, the table gives " + numberText(found[*wrong]) + " mm" +
                                     suspicion(prescription)};
    }
    const AxialBeam beam = widestAxialBeam(OpticalSystem(prescription));
    const double fNumber = 0.5 * std::sqrt(found[0] * found[1] / (beam.radiusXMm * beam.radiusYMm));
    const double statedNumber = prescription.stated.fNumber;
    if (!(std::abs(fNumber - statedNumber) <= statedFNumberTolerance * statedNumber))
        return PrescriptionFault{{},
                                 "f_number",
                                 "the header states " + numberText(statedNumber) +
                                     ", the table gives " + numberText(fNumber) +
                                     ", where surface[" + std::to_string(beam.limitingSurface) +
                                     "].semi_aperture_mm limits the axial beam"};
    return {};
}

}  // namespace etendue
