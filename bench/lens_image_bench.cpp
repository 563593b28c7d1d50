// What a fit's error does to a picture: stated, predicted ray by ray, and rendered.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

#include "statistics/statistics.h"
#include "tests/support/lens_image_error.h"

namespace etendue {
namespace {

constexpr std::size_t replicates = 16;

/// How strongly the pictures hold the predicted pattern, with its interval of 99 %. The pattern is
/// that of half of the replicates and looked for in the others and in the pictures, whose noise is
/// independent of its own.
std::string ratioText(const PredictionSet& set, PixelMap Prediction::*map,
                      const std::vector<PixelMap>& measured) {
    const PixelMap pattern = meanOf(set.maps(map, 0, replicates / 2));
    const auto others = factorsOf(pattern, set.maps(map, replicates / 2, replicates));
    const WelchResult welch = welchTest(factorsOf(pattern, measured), others);
    const double predicted = summarize(others).mean;
    const double halfWidth =
        studentQuantile(0.99, welch.degreesOfFreedom) * welch.standardError / predicted;
    // Where the replicates themselves hardly share a pattern there is none to look for.
    if (!(halfWidth > 0.0 && halfWidth < 1.0)) return "–";
    return fmt::format("{:.3f} ± {:.3f}", 1.0 + welch.difference / predicted, halfWidth);
}

void printRow(const LensPair& pair, const std::string& name, const std::vector<PixelMap>& traced,
              std::uint32_t samples) {
    const PredictionSet set = predict(pair, replicates, 16, 1);
    const auto scene = chartScene(pair.chart);
    const std::vector<PixelMap> measured = differences(
        renderChart(*scene, *pair.fittedCamera, "pt", samples, 1, static_cast<int>(traced.size())),
        traced);
    const StatedBound bound = statedBound(pair, set.facts);
    const FitErrors& stated = pair.fit.errors;
    const auto predicted = set.maps(&Prediction::firstOrder, 0, replicates);
    const PixelMap exact = meanOf(set.maps(&Prediction::exact, 0, replicates));
    const double picture = summarize(meanOf(traced)).mean;
    const double statedShare =
        pair.fit.clipErrors.wronglyAccepted + pair.fit.clipErrors.wronglyBlocked;
    fmt::print("| {} | {} | {:.2g} | {:.2g} / {:.2g} | {:.2g} | {:.2g} | {:.2g} / {:.2g} | ", name,
               pair.fit.settings.terms, stated.directionMrad.rms, stated.sensorMicrometres.rms,
               1e3 * set.facts.shiftRmsMm,
               1e-3 * stated.sensorMicrometres.rms / pair.view.pixelMm(),
               100.0 * stated.throughputRelative.rms, 100.0 * statedShare,
               100.0 * set.facts.decidedOtherwise);
    const double percent = 100.0 / picture;
    fmt::print("{:.2g} / {:.2g} / {:.2g} | ", percent * bound.rms, percent * sharedRms(predicted),
               percent * sharedRms(measured));
    // The bound of the largest says nothing where rays are decided otherwise.
    fmt::print("{} / {:.2g} / {:.2g} | ",
               set.facts.decidedOtherwise > 0.0 ? "–" : fmt::format("{:.2g}", percent * bound.most),
               percent * largest(meanOf(predicted)), percent * largest(meanOf(measured)));
    fmt::print("{} | {:.1g} |\n", ratioText(set, &Prediction::firstOrder, measured),
               100.0 * rms(difference(meanOf(predicted), exact)) / rms(exact));
    std::fflush(stdout);
}

}  // namespace
}  // namespace etendue

/// Arguments: the project's folder, pixels across (48), samples per pixel and seed (16), seeds
/// (12).
int main(int argc, char** argv) {
    using namespace etendue;
    const std::filesystem::path project = argc > 1 ? argv[1] : ".";
    const int width = argc > 2 ? std::atoi(argv[2]) : 48;
    const auto samples = static_cast<std::uint32_t>(argc > 3 ? std::atoi(argv[3]) : 16);
    const int seeds = argc > 4 ? std::atoi(argv[4]) : 12;
    struct Case {
        const char *name, *file;
        double sensorWidthMm, focusDistanceMm;
        std::optional<double> fNumber;
    };
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Case cases[] = {{"double Gauss", "double-gauss-100mm", 36.0, infinity, {}},
                          {"…, f/5.6", "double-gauss-100mm", 36.0, infinity, 5.6},
                          {"…, unfocused", "double-gauss-100mm", 36.0, 4000.0, {}},
                          {"fisheye", "fisheye-10mm", 23.5, infinity, {}},
                          {"…, f/5.6, 18 mm", "fisheye-10mm", 18.0, infinity, 5.6},
                          {"…, unfocused", "fisheye-10mm", 23.5, 150.0, {}},
                          {"anamorphic", "anamorphic-80x90mm", 22.0, infinity, {}},
                          {"…, f/8, 6 mm", "anamorphic-80x90mm", 6.0, infinity, 8.0},
                          {"…, unfocused", "anamorphic-80x90mm", 22.0, 4000.0, {}}};
    fmt::print(
        "| lens | terms | mrad | µm: stated / here | pixels | J τ % | "
        "decided otherwise %: stated / here | rms %: bound / predicted / measured | "
        "largest %: bound / predicted / measured | measured ÷ predicted | "
        "first order leaves out % |\n"
        "|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const Case& one : cases) {
        std::vector<PixelMap> traced;
        for (const int terms : {4, 8, 16, 32, 64}) {
            const LensPair pair = makeLensPair(
                {.lensFile = project / "scenes/lenses" / (std::string(one.file) + ".toml"),
                 .sensorWidthMm = one.sensorWidthMm,
                 .width = width,
                 .height = width * 2 / 3,
                 .fNumber = one.fNumber,
                 .focusDistanceMm = one.focusDistanceMm},
                terms);
            if (traced.empty())
                traced = renderChart(*chartScene(pair.chart), *pair.tracedCamera, "pt", samples, 1,
                                     seeds);
            printRow(pair, one.name, traced, samples);
        }
    }
    return 0;
}
