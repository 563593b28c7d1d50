// The TOML of a prescription. toml++ stays behind config.h.
#include <algorithm>
#include <stdexcept>

#include "config/config.h"
#include "lens/prescription.h"
#include "lens/prescription_check.h"

namespace etendue {

namespace {

constexpr Range numberOrInfinity{-Range::infinity, Range::infinity};

struct KindName {
    SurfaceKind kind;
    const char* name;
};
constexpr std::array kindNames{KindName{SurfaceKind::spherical, "spherical"},
                               KindName{SurfaceKind::conic, "conic"},
                               KindName{SurfaceKind::aspheric, "aspheric"},
                               KindName{SurfaceKind::cylinderX, "cylinder-x"},
                               KindName{SurfaceKind::cylinderY, "cylinder-y"},
                               KindName{SurfaceKind::planar, "planar"},
                               KindName{SurfaceKind::stop, "stop"}};

SurfaceKind kindOf(const ConfigTable& table) {
    std::vector<std::string> names;
    for (const KindName& entry : kindNames) names.emplace_back(entry.name);
    const std::string name = table.choice("type", names, kindNames.front().name);
    return kindNames[static_cast<std::size_t>(std::ranges::find(names, name) - names.begin())].kind;
}

/// A number, or one for each zoom position.
double zoomNumber(const ConfigTable& table, std::string_view key, Range range, std::size_t zoom,
                  std::size_t zoomCount) {
    if (!table.isArray(key)) return table.number(key, range);
    if (zoomCount == 1)
        table.fail(key, "expected a number: a list is for lenses with zoom_positions");
    return table.numbers(key, zoomCount, range)[zoom];
}

Glass glassOf(const ConfigTable& table) {
    const bool hasName = table.has("glass"), hasTerms = table.has("sellmeier");
    const bool hasNumber = table.has("nd");
    if (hasName + hasTerms + hasNumber > 1)
        table.fail("", "more than one of nd, glass and sellmeier: which is the medium?");
    if (hasName) try {
            return glassFromCatalogue(table.text("glass"));
        } catch (const std::invalid_argument& error) {
            table.fail("glass", error.what());
        }
    if (hasTerms) {
        const std::vector<double> terms = table.numbers("sellmeier", 6, Range::any());
        return SellmeierGlass{{terms[0], terms[1], terms[2]}, {terms[3], terms[4], terms[5]}};
    }
    if (hasNumber)
        return glassFromAbbeNumber(table.number("nd", {1.0, 10.0}),
                                   table.number("vd", Range::positive()));
    return Air{};
}

std::optional<Coating> coatingOf(const ConfigTable& surface) {
    if (!surface.has("coating")) return {};
    const ConfigTable table = surface.table("coating");
    const Coating standard;
    const Coating coating{
        table.number("index", {1.0, 10.0}),
        table.number("design_wavelength_nm", {1.0, 1e5}, standard.designWavelengthNm),
        table.number("thickness_waves", {1e-6, 100.0}, standard.thicknessWaves)};
    table.finish();
    return coating;
}

std::array<double, 7> asphereOf(const ConfigTable& table) {
    std::array<double, 7> asphere{};
    for (std::size_t i = 0; i < asphere.size(); ++i)
        asphere[i] = table.number("a" + std::to_string(2 * i + 4), Range::any(), 0.0);
    return asphere;
}

Surface surfaceOf(const ConfigTable& table, const Glass& front, std::size_t zoom,
                  std::size_t zoomCount) {
    Surface surface;
    surface.kind = kindOf(table);
    surface.thicknessMm = zoomNumber(table, "thickness_mm", Range::any(), zoom, zoomCount);
    surface.semiApertureMm = table.number("semi_aperture_mm", Range::positive());
    if (surface.kind == SurfaceKind::stop) {
        surface.behind = front;
        table.finish();
        return surface;
    }
    if (surface.kind != SurfaceKind::planar)
        surface.radiusMm = table.number("radius_mm", numberOrInfinity);
    if (surface.kind == SurfaceKind::conic) surface.conic = table.number("conic", Range::any());
    if (surface.kind == SurfaceKind::aspheric) {
        surface.conic = table.number("conic", Range::any(), 0.0);
        surface.asphere = asphereOf(table);
    }
    surface.behind = glassOf(table);
    surface.coating = coatingOf(table);
    table.finish();
    return surface;
}

StatedData statedOf(const ConfigTable& root, bool isAnamorphic, std::size_t zoom,
                    std::size_t zoomCount) {
    const auto read = [&](std::string_view key, Range range) {
        return zoomNumber(root, key, range, zoom, zoomCount);
    };
    StatedData stated;
    stated.focalLengthYMm = read("focal_length_mm", Range::positive());
    stated.backFocalDistanceYMm = read("back_focal_distance_mm", Range::positive());
    stated.fNumber = read("f_number", Range::positive());
    stated.focalLengthXMm = stated.focalLengthYMm;
    stated.backFocalDistanceXMm = stated.backFocalDistanceYMm;
    if (isAnamorphic) {
        stated.focalLengthXMm = read("focal_length_x_mm", Range::positive());
        stated.backFocalDistanceXMm = read("back_focal_distance_x_mm", Range::positive());
    }
    return stated;
}

[[noreturn]] void failAt(const PrescriptionFault& fault, const ConfigTable& root,
                         const std::vector<ConfigTable>& surfaces) {
    if (!fault.surface) root.fail(fault.key, fault.message);
    const ConfigTable& surface = surfaces[*fault.surface];
    const std::string prefix = "coating.";
    if (fault.key.starts_with(prefix))
        surface.table("coating").fail(fault.key.substr(prefix.size()), fault.message);
    std::string key = fault.key;
    if (key == "nd" && !surface.has("nd")) {
        key.clear();
        for (const char* medium : {"glass", "sellmeier"})
            if (surface.has(medium)) key = medium;
    }
    surface.fail(key, fault.message);
}

Prescription prescriptionOf(const ConfigTable& root, const std::vector<ConfigTable>& surfaces,
                            const std::vector<std::string>& zooms, std::size_t zoom) {
    const std::size_t zoomCount = std::max<std::size_t>(1, zooms.size());
    Prescription prescription;
    prescription.name = root.text("name");
    prescription.source = root.text("source");
    prescription.notes = root.text("notes", "");
    if (!zooms.empty()) prescription.zoomPosition = zooms[zoom];
    Glass front = Air{};
    for (const ConfigTable& table : surfaces) {
        prescription.surfaces.push_back(surfaceOf(table, front, zoom, zoomCount));
        front = prescription.surfaces.back().behind;
    }
    prescription.stated = statedOf(root, isAnamorphic(prescription), zoom, zoomCount);
    root.finish();
    if (const auto fault = findFault(prescription)) failAt(*fault, root, surfaces);
    if (const auto fault = findContradiction(prescription)) failAt(*fault, root, surfaces);
    return prescription;
}

}  // namespace

std::vector<Prescription> loadPrescriptions(const std::filesystem::path& file) {
    const ConfigTable root = Config::load(file).root();
    const std::vector<std::string> zooms = root.texts("zoom_positions");
    const std::vector<ConfigTable> surfaces = root.tables("surface");
    constexpr std::size_t mostSurfaces = 200;
    if (surfaces.empty() || surfaces.size() > mostSurfaces)
        root.fail("surface", "expected 1 to " + std::to_string(mostSurfaces) + " surfaces, got " +
                                 std::to_string(surfaces.size()));
    std::vector<Prescription> prescriptions;
    for (std::size_t zoom = 0; zoom < std::max<std::size_t>(1, zooms.size()); ++zoom)
        prescriptions.push_back(prescriptionOf(root, surfaces, zooms, zoom));
    return prescriptions;
}

Prescription loadPrescription(const std::filesystem::path& file, std::string_view zoomPosition) {
    std::vector<Prescription> all = loadPrescriptions(file);
    if (zoomPosition.empty()) return all.front();
    std::vector<std::string> names;
    for (Prescription& prescription : all) {
        if (prescription.zoomPosition == zoomPosition) return prescription;
        names.push_back(prescription.zoomPosition);
    }
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "\"" : ", \"") + name + '"';
    throw InputError(file.string() + ": no zoom position \"" + std::string(zoomPosition) +
                     "\", expected " + (names.front().empty() ? "none: it does not zoom" : list));
}

}  // namespace etendue
