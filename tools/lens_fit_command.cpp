#include "tools/lens_fit_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <cmath>

#include "lens/fit_cache.h"
#include "lens/lens_trade.h"
#include "tools/progress.h"
#include "tools/write_file.h"

namespace etendue {

namespace {

constexpr double perCent = 100.0;

ErrorSummary scaled(const ErrorSummary& summary, double factor) {
    return {factor * summary.rms, factor * summary.percentile999, factor * summary.most};
}

FitSettings settingsFor(const Prescription& prescription, const FitOptions& options) {
    FitSettings settings;
    settings.form = options.form;
    settings.terms = options.terms;
    settings.degree = options.degree;
    settings.basis = basisFor(prescription, options.basis);
    return settings;
}

double share(std::int64_t part, std::int64_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

Json jsonOf(const FitDomain& domain) {
    return Json::object(
        {{"sensor_half_size_mm",
          Json::numbers({domain.sensorHalfSizeMm.x(), domain.sensorHalfSizeMm.y()})},
         {"image_radius_mm", domain.imageRadiusMm},
         {"sensor_distance_mm", domain.sensorDistanceMm},
         {"aperture_radius_mm", domain.apertureRadiusMm},
         {"wavelengths_nm",
          Json::numbers({domain.shortestWavelengthNm, domain.longestWavelengthNm})}});
}

void printReport(const Prescription& prescription, const ObtainedFit& obtained) {
    const LensFit& fit = obtained.fit;
    const RayCounts& drawn = fit.training;
    fmt::print("{}\n{}\n\n", titleOf(prescription), prescription.source);
    fmt::print("  fit       {}\n", describe(fit.settings));
    fmt::print("  cost      {}\n", describeCost(fit));
    fmt::print("  domain    {}\n", describe(fit.domain));
    fmt::print(
        "  rays      fitted to {} of {} drawn; {:.1f} % blocked; folded {:.2f} %, {:.2f} % of the "
        "light\n\n",
        drawn.passed, drawn.drawn, perCent * share(drawn.blocked, drawn.drawn),
        perCent * share(drawn.folded, drawn.drawn), perCent * drawn.foldedLight);
    if (drawn.unsolved + drawn.besidePupil > 0)
        fmt::print("  left out  {} without a solution, {} beside the pupil sphere\n\n",
                   drawn.unsolved, drawn.besidePupil);
    fmt::print("  error on {} rays drawn anew  {:>12}{:>12}{:>12}\n", fit.errors.rays, "rms",
               "99.9 %", "most");
    for (const FitErrorRow& row : errorRows(fit.errors))
        fmt::print("    {:<22}{:>8}{:>12.4g}{:>12.4g}{:>12.4g}\n", row.label, row.unit,
                   row.summary.rms, row.summary.percentile999, row.summary.most);
    fmt::print("    unsolved              {} rays\n\n", fit.errors.unsolved);
    fmt::print(
        "  rims      surface {}{}; {:.3f} % of the accepted rays would be blocked, {:.3f} % of "
        "those "
        "that pass are refused\n",
        fmt::join(fit.clip.surfaces, ", "),
        fit.clip.reflecting.empty()
            ? ""
            : fmt::format("; total reflection at {}", fmt::join(fit.clip.reflecting, ", ")),
        perCent * fit.clipErrors.wronglyAccepted, perCent * fit.clipErrors.wronglyBlocked);
}

}  // namespace

const char* formName(FitForm form) {
    return form == FitForm::twoPoint ? "two-point" : "sensor-state";
}

PolynomialBasis basisFor(const Prescription& prescription, std::optional<PolynomialBasis> wanted) {
    const bool hasAxis = !isAnamorphic(prescription);
    if (wanted == PolynomialBasis::axial && !hasAxis)
        throw InputError("--basis axial: " + prescription.name + " is not symmetric about an axis",
                         ExitCode::usage);
    return wanted.value_or(hasAxis ? PolynomialBasis::axial : PolynomialBasis::twoPlane);
}

std::string describe(const FitSettings& settings) {
    const std::string terms = settings.terms == allTerms ? std::string("all terms")
                                                         : fmt::format("{} terms", settings.terms);
    return fmt::format("{}, basis {}, {} of degree {} at most", formName(settings.form),
                       basisName(settings.basis), terms, settings.degree);
}

std::string describe(const FitDomain& domain) {
    const Eigen::Vector2d size = 2.0 * domain.sensorHalfSizeMm;
    std::string text = fmt::format("sensor {:g} × {:g} mm", size.x(), size.y());
    if (std::isfinite(domain.imageRadiusMm))
        text += fmt::format(" cut to ⌀ {:.2f} mm", 2.0 * domain.imageRadiusMm);
    return text + fmt::format(", {:.3f} mm behind the lens, stop ⌀ {:.3f} mm, {:g}–{:g} nm",
                              domain.sensorDistanceMm, 2.0 * domain.apertureRadiusMm,
                              domain.shortestWavelengthNm, domain.longestWavelengthNm);
}

std::string describeCost(const LensFit& fit) {
    return fmt::format("{} multiply-adds for the ray, {} for the rims", rayMultiplyAdds(fit),
                       multiplyAdds(fit.clip.squares));
}

std::vector<FitErrorRow> errorRows(const FitErrors& errors) {
    constexpr double micrometresPerMm = 1e3;
    return {{"outgoing direction", "mrad", "direction_mrad", errors.directionMrad},
            {"as seen on the sensor", "µm", "sensor_um", errors.sensorMicrometres},
            {"point where it leaves", "µm", "pupil_um", scaled(errors.pupilMm, micrometresPerMm)},
            {"throughput", "%", "throughput_percent", scaled(errors.throughputRelative, perCent)},
            {"étendue", "%", "etendue_percent", scaled(errors.etendue, perCent)}};
}

Json jsonOf(const LensFit& fit) {
    Json errors = Json::object();
    for (const FitErrorRow& row : errorRows(fit.errors))
        errors.add(row.key, Json::object({{"rms", row.summary.rms},
                                          {"percentile_99_9", row.summary.percentile999},
                                          {"most", row.summary.most}}));
    errors.add("rays", fit.errors.rays);
    errors.add("unsolved", fit.errors.unsolved);
    Json surfaces = Json::array();
    for (const std::size_t surface : fit.clip.surfaces) surfaces.add(surface);
    return Json::object(
        {{"form", formName(fit.settings.form)},
         {"basis", std::string(basisName(fit.settings.basis))},
         {"terms", fit.settings.terms},
         {"degree", fit.settings.degree},
         {"multiply_adds", rayMultiplyAdds(fit)},
         {"rim_multiply_adds", multiplyAdds(fit.clip.squares)},
         {"domain", jsonOf(fit.domain)},
         {"training", Json::object({{"drawn", fit.training.drawn},
                                    {"passed", fit.training.passed},
                                    {"blocked", fit.training.blocked},
                                    {"folded", fit.training.folded},
                                    {"unsolved", fit.training.unsolved},
                                    {"beside_pupil", fit.training.besidePupil},
                                    {"folded_light", fit.training.foldedLight}})},
         {"errors", std::move(errors)},
         {"rims", Json::object({{"surfaces", std::move(surfaces)},
                                {"wrongly_accepted", fit.clipErrors.wronglyAccepted},
                                {"wrongly_blocked", fit.clipErrors.wronglyBlocked}})}});
}

ObtainedFit obtainFit(const Prescription& prescription, const LensChoice& choice,
                      const FitOptions& options) {
    const FitSettings settings = settingsFor(prescription, options);
    DomainRequest request = requestOf(choice);
    request.shortestWavelengthNm = options.wavelengthsNm[0];
    request.longestWavelengthNm = options.wavelengthsNm[1];
    const FitDomain domain = fitDomain(prescription, request);
    const std::filesystem::path cache = fitCacheDirectory();
    bool isFromCache = true;
    const auto start = std::chrono::steady_clock::now();
    FitBar bar;
    const auto notice = [&](const std::string& sentence) {
        isFromCache = false;
        say(fmt::format("{}\n", sentence));
    };
    LensFit fit =
        cachedFit(prescription, domain, settings, cache, notice,
                  [&](double share, std::string_view stage) { bar.update(share, stage); });
    bar.clear();
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    const std::filesystem::path file =
        cache.empty() ? cache : fitCacheFile(cache, fitKey(prescription, domain, settings));
    return {std::move(fit), elapsed.count(), isFromCache, file};
}

ExitCode runLensFit(const LensFitCommand& command) {
    checkWritable(command.output);
    checkDistinct({{"-o", command.output}}, {{"the lens", findLensFile(command.choice.lens)}});
    const Prescription prescription = loadPrescription(command.choice);
    const ObtainedFit obtained = obtainFit(prescription, command.choice, command.options);
    if (!command.output.empty()) writeWholeFile(command.output, fitFileText(obtained.fit));
    if (command.asJson) {
        Json json = jsonOf(obtained.fit);
        json.add("lens", prescription.name);
        json.add("zoom_position", prescription.zoomPosition);
        json.add("seconds", obtained.seconds);
        json.add("from_cache", obtained.isFromCache);
        json.add("file", (command.output.empty() ? obtained.cacheFile : command.output).string());
        fmt::print("{}\n", json.text());
        return ExitCode::success;
    }
    printReport(prescription, obtained);
    const std::string where = obtained.cacheFile.empty() ? std::string("nowhere: no cache folder")
                                                         : obtained.cacheFile.string();
    if (obtained.isFromCache)
        fmt::print("  time      {:.1f} ms, from the cache: {}\n", 1e3 * obtained.seconds, where);
    else
        fmt::print("  time      {}; kept in {}\n", formatDuration(obtained.seconds), where);
    if (!command.output.empty()) fmt::print("  written   {}\n", command.output.string());
    return ExitCode::success;
}

}  // namespace etendue
