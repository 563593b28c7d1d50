// [camera]: where it stands, and which lens it looks through.
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "lens/axial_beam.h"
#include "lens/fit_cache.h"
#include "lens/fit_domain.h"
#include "lens/polynomial_lens.h"
#include "renderer/scene_parts.h"

namespace etendue {

namespace {

Transform placeCamera(const ConfigTable& table) {
    const Vec3d from = vector3(table, "from"), to = vector3(table, "to");
    const Vec3d up = table.has("up") ? vector3(table, "up") : Vec3d{0, 1, 0};
    if (!(length(to - from) > 0.0)) table.fail("to", "must differ from 'from'");
    if (!(length(cross(up, to - from)) > 1e-9 * length(up) * length(to - from)))
        table.fail("up", "must not be parallel to the viewing direction");
    return lookAt(from, to, up);
}

/// Focal length, or the horizontal field of view that the sensor's width turns into one.
double focalLengthMm(const ConfigTable& table, double sensorWidthMm) {
    if (!table.has("fov")) return table.number("focal_length_mm", {1e-3, 1e5}, 50.0);
    if (table.has("focal_length_mm")) table.fail("fov", "give either fov or focal_length_mm");
    const double fovDegrees = table.number("fov", {0.01, 179.0});
    return 0.5 * sensorWidthMm / std::tan(fovDegrees * std::numbers::pi / 360.0);
}

/// Distance in front of a thin lens, when `distance` is counted from the sensor as on a lens
/// barrel: u + v = d with 1/u + 1/v = 1/f.
double distanceFromLensMm(const ConfigTable& table, double distanceMm, double focalMm) {
    if (std::isinf(distanceMm)) return distanceMm;
    if (!(distanceMm > 4.0 * focalMm))
        table.fail("focus_distance", "counted from the sensor, must exceed four focal lengths: " +
                                         std::to_string(4e-3 * focalMm) + " m");
    return 0.5 * (distanceMm + std::sqrt(distanceMm * (distanceMm - 4.0 * focalMm)));
}

std::shared_ptr<const LensModel> loadThinLens(const ConfigTable& table, double focalMm,
                                              LoadedScene& loaded) {
    loaded.fNumber = table.number("f_number", {0.1, 1e4});
    loaded.focusDistance = table.number("focus_distance", {1e-6, Range::infinity});
    const double u = distanceFromLensMm(table, loaded.focusDistance * 1e3, focalMm);
    return makeThinLens(focalMm, u, 0.5 * focalMm / loaded.fNumber);
}

/// What the photographer sets. Errors name the key that the lens cannot follow.
LensSettings loadLensSettings(const ConfigTable& table, const Prescription& prescription) {
    const OpticalSystem system(prescription);
    const auto attempt = [&](const char* key, const auto& setting) {
        try {
            setting();
        } catch (const std::invalid_argument& error) {
            table.fail(key, error.what());
        }
    };
    LensSettings settings;
    if (table.has("f_number")) {
        settings.fNumber = table.number("f_number", {0.1, 1e4});
        attempt("f_number", [&] { stopRadiusForFNumber(system, *settings.fNumber); });
    }
    settings.focusDistanceMm =
        1e3 * table.number("focus_distance", {1e-6, Range::infinity}, Range::infinity);
    attempt("focus_distance",
            [&] { sensorDistanceMm(paraxialData(system), settings.focusDistanceMm); });
    settings.blades.count = static_cast<int>(table.integer("blades", {0, 64}, 0));
    settings.blades.rotationDegrees = table.number("blade_rotation", {-360.0, 360.0}, 0.0);
    settings.blades.roundness = table.number("blade_roundness", Range::unit(), 0.0);
    attempt("blades", [&] { Aperture(1.0, settings.blades); });
    return settings;
}

FitSettings loadFitSettings(const ConfigTable& table, const std::string& representation,
                            const Prescription& prescription) {
    FitSettings settings;
    settings.form = representation == "sensor-state" ? FitForm::sensorState : FitForm::twoPoint;
    if (isAnamorphic(prescription)) settings.basis = PolynomialBasis::twoPlane;
    settings.terms = static_cast<int>(table.integer("terms", {1, 1000}, settings.terms));
    settings.degree = static_cast<int>(table.integer("degree", {1, mostPower}, settings.degree));
    return settings;
}

/// `sensorSizeMm`: of all film points that a filter may ask for.
std::shared_ptr<const LensModel> loadLens(const ConfigTable& table,
                                          const Eigen::Vector2d& sensorSizeMm,
                                          const LoadOptions& options, LoadingScene& loading,
                                          LoadedScene& loaded) {
    const std::filesystem::path file = table.file("lens");
    loading.files.push_back(file);
    const Prescription prescription = loadPrescription(file, table.text("zoom", ""));
    const LensSettings settings = loadLensSettings(table, prescription);
    loaded.fNumber = settings.fNumber.value_or(prescription.stated.fNumber);
    loaded.focusDistance = 1e-3 * settings.focusDistanceMm;
    const std::string representation =
        table.choice("representation", {"two-point", "sensor-state", "traced"}, "two-point");
    const FitSettings fitSettings = loadFitSettings(table, representation, prescription);
    if (representation == "traced") return makeTracedLens(prescription, settings);

    DomainRequest request;
    request.sensorSizeMm = sensorSizeMm;
    request.focusDistanceMm = settings.focusDistanceMm;
    request.fNumber = settings.fNumber;
    const FitDomain domain = fitDomain(prescription, request);
    const auto notice = [&](const std::string& sentence) { loading.notes.push_back(sentence); };
    const LensFit fit =
        cachedFit(prescription, domain, fitSettings, options.fitCache, notice, options.fitProgress);
    return std::make_shared<PolynomialLens>(prescription, fit,
                                            Aperture(domain.apertureRadiusMm, settings.blades));
}

}  // namespace

Transform lookAt(Vec3d from, Vec3d to, Vec3d up) {
    const Vec3d z = normalize(to - from);
    const Vec3d x = normalize(cross(up, z));
    return {x, cross(z, x), z, from};
}

void loadCamera(const ConfigTable& table, const LoadOptions& options, LoadingScene& loading,
                LoadedScene& loaded) {
    CameraSettings settings;
    settings.width = loaded.film.width;
    settings.height = loaded.film.height;
    settings.worldFromLens = placeCamera(table);
    settings.sensorWidthMm = table.number("sensor_width_mm", {1e-3, 1e5}, 36.0);
    settings.exposureStops = table.number("exposure", {-60, 60}, 0.0);
    std::shared_ptr<const LensModel> lens;
    if (table.has("lens")) {
        if (table.has("model")) table.fail("model", "give either model or lens");
        const double pixelMm = settings.sensorWidthMm / settings.width;
        const double margin = 2.0 * static_cast<double>(loaded.film.filterRadius);
        const Eigen::Vector2d sensorSizeMm(pixelMm * (settings.width + margin),
                                           pixelMm * (settings.height + margin));
        lens = loadLens(table, sensorSizeMm, options, loading, loaded);
    } else {
        const std::string model = table.choice("model", {"pinhole", "thin-lens"}, "pinhole");
        const double focalMm = focalLengthMm(table, settings.sensorWidthMm);
        lens = model == "pinhole" ? makePinhole(focalMm) : loadThinLens(table, focalMm, loaded);
    }
    table.finish();
    loaded.camera = std::make_unique<Camera>(std::move(lens), settings);
}

}  // namespace etendue
