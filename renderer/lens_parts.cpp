// [camera] lens = …: a lens of glass, by its exact trace or by a polynomial fitted to it.
#include <algorithm>

#include "lens/axial_beam.h"
#include "lens/fit_cache.h"
#include "lens/fit_domain.h"
#include "lens/fit_file.h"
#include "lens/outer_pupil.h"
#include "lens/polynomial_lens.h"
#include "renderer/camera_focus.h"
#include "renderer/content_hash.h"
#include "renderer/lens_terms.h"
#include "renderer/scene_parts.h"

namespace etendue {

namespace {

/// The ray from `film` through the centre of the stop, with the lens focused at infinity: what the
/// photographer points at.
ExitRay chiefRay(const ConfigTable& table, const Prescription& prescription,
                 const CameraSettings& settings, Vec2 film) {
    const Eigen::Vector2d sensorMm = sensorPointMm(settings, film);
    const auto ray = makeTracedLens(prescription, {})
                         ->trace({sensorMm}, {Eigen::Vector2d::Zero()},
                                 static_cast<double>(Wavelengths::rgbWavelengthNm));
    if (!ray) table.fail("focus_pixel", "no light reaches that pixel through the lens");
    return *ray;
}

double focusDistanceMm(const ConfigTable& table, const Prescription& prescription,
                       const ParaxialData& data, const CameraSettings& settings,
                       const Scene& scene) {
    const FocusRequest request = focusRequest(table, settings);
    const char* key = keyOf(request);
    if (request.sensorShiftMm)
        return attempt(table, key,
                       [&] { return focusDistanceForShiftMm(data, *request.sensorShiftMm); });
    double distanceMm = request.distanceMm.value_or(std::numeric_limits<double>::infinity());
    if (request.point || request.film) {
        double depthMm = 0.0;
        if (request.point) {
            depthMm = depthOfPointMm(table, settings.worldFromLens, *request.point);
        } else {
            const ExitRay ray = chiefRay(table, prescription, settings, *request.film);
            depthMm = depthSeenMm(table, scene, settings.worldFromLens,
                                  {ray.origin.x(), ray.origin.y(), ray.origin.z()},
                                  {ray.direction.x(), ray.direction.y(), ray.direction.z()});
        }
        distanceMm = attempt(table, key,
                             [&] { return focusDistanceForDepthMm(prescription, data, depthMm); });
    }
    attempt(table, key, [&] { return sensorDistanceMm(data, distanceMm); });
    return distanceMm;
}

/// What the photographer sets. Errors name the key that the lens cannot follow.
LensSettings loadLensSettings(const ConfigTable& table, const Prescription& prescription,
                              const CameraSettings& camera, const Scene& scene) {
    const OpticalSystem system(prescription);
    LensSettings settings;
    if (table.has("f_number")) {
        settings.fNumber = table.number("f_number", {0.1, 1e4});
        attempt(table, "f_number", [&] { return stopRadiusForFNumber(system, *settings.fNumber); });
    }
    settings.focusDistanceMm =
        focusDistanceMm(table, prescription, paraxialData(system), camera, scene);
    settings.blades.count = static_cast<int>(table.integer("blades", {0, 64}, 0));
    settings.blades.rotationDegrees = table.number("blade_rotation", {-360.0, 360.0}, 0.0);
    settings.blades.roundness = table.number("blade_roundness", Range::unit(), 0.0);
    attempt(table, "blades", [&] { return Aperture(1.0, settings.blades); });
    return settings;
}

/// The lens of the file that the table names, at the zoom position that it names, or else the
/// first.
Prescription prescriptionOf(const ConfigTable& table, LoadingScene& loading) {
    const std::vector<Prescription> positions =
        table.readFile("lens", [&](const std::filesystem::path& file) {
            loading.files.push_back(file);
            return loadPrescriptions(file);
        });
    if (!table.has("zoom")) return positions.front();
    std::vector<std::string> names;
    for (const Prescription& position : positions) names.push_back(position.zoomPosition);
    if (names.front().empty()) table.fail("zoom", "this lens does not zoom");
    const std::string wanted = table.choice("zoom", names);
    return positions[static_cast<std::size_t>(std::ranges::find(names, wanted) - names.begin())];
}

FitSettings loadFitSettings(const ConfigTable& table, const std::string& representation,
                            const Prescription& prescription) {
    FitSettings settings;
    settings.form = representation == "sensor-state" ? FitForm::sensorState : FitForm::twoPoint;
    if (isAnamorphic(prescription)) settings.basis = PolynomialBasis::twoPlane;
    if (representation == "auto" && table.has("terms"))
        table.fail("terms", "representation = \"auto\" chooses them");
    settings.terms = static_cast<int>(table.integer("terms", {1, 1000}, settings.terms));
    settings.degree = static_cast<int>(table.integer("degree", {1, mostPower}, settings.degree));
    return settings;
}

}  // namespace

std::shared_ptr<const LensModel> loadLens(const ConfigTable& table, CameraSettings& camera,
                                          const LoadOptions& options, LoadingScene& loading,
                                          LoadedScene& loaded) {
    const Prescription prescription = prescriptionOf(table, loading);
    const StatedData& stated = prescription.stated;
    camera.worldFromLens =
        placeCamera(table, {stated.focalLengthXMm, stated.focalLengthYMm}, camera, *loaded.scene);
    const std::string representation = table.choice(
        "representation", {"two-point", "sensor-state", "traced", "auto"}, "two-point");
    const FitSettings fitSettings = loadFitSettings(table, representation, prescription);
    const LensSettings settings = loadLensSettings(table, prescription, camera, *loaded.scene);
    table.finish();  // a mistyped key is reported now, and not after seconds of fitting
    loaded.fNumber = settings.fNumber.value_or(stated.fNumber);
    loaded.focusDistance = 1e-3 * settings.focusDistanceMm;
    if (loaded.estimator.usesOuterPupil)
        camera.outerPupil = std::make_shared<OuterPupil>(makeTracedLens(prescription, settings));
    if (representation == "traced") {
        loaded.lensModel = "exact trace";
        return makeTracedLens(prescription, settings);
    }

    DomainRequest request;
    const double margin = 2.0 * static_cast<double>(loaded.film.filterRadius);
    const Eigen::Vector2d filmPoints(camera.width + margin, camera.height + margin);
    request.sensorSizeMm =
        filmPoints * (camera.sensorWidthMm / camera.width) + 2.0 * camera.sensorOffsetMm.cwiseAbs();
    request.focusDistanceMm = settings.focusDistanceMm;
    request.fNumber = settings.fNumber;
    constexpr double rgbNm = Wavelengths::rgbWavelengthNm;
    request.shortestWavelengthNm = camera.isDispersive ? Wavelengths::shortestNm : rgbNm;
    request.longestWavelengthNm = camera.isDispersive ? Wavelengths::longestNm : rgbNm;
    const FitDomain domain = fitDomain(prescription, request);
    const auto notice = [&](const std::string& sentence) { loading.notes.push_back(sentence); };
    const auto fitOf = [&](int terms) {
        FitSettings wanted = fitSettings;
        wanted.terms = terms;
        return cachedFit(prescription, domain, wanted, options.fitCache, notice,
                         options.fitProgress);
    };
    LensFit fit;
    if (representation == "auto") {
        ChosenFit chosen = chooseTerms(fitOf, camera.sensorWidthMm, loaded.samples);
        fit = std::move(chosen.fit);
        loading.notes.push_back(std::move(chosen.reason));
    } else {
        fit = fitOf(fitSettings.terms);
    }
    loaded.lensModel =
        std::string(fit.settings.form == FitForm::sensorState ? "sensor-state" : "two-point") +
        ", " + std::to_string(fit.settings.terms) + " terms, degree " +
        std::to_string(fit.settings.degree);
    loaded.fit = FitSummary{fit.settings.terms, fit.settings.degree, fit.errors.directionMrad.rms,
                            fit.errors.sensorMicrometres.rms, contentHash({}, {fitFileText(fit)})};
    return std::make_shared<PolynomialLens>(prescription, fit,
                                            Aperture(domain.apertureRadiusMm, settings.blades));
}

}  // namespace etendue
