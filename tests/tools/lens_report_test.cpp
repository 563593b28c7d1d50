#include "tools/lens_report.h"

#include <cmath>
#include <cstdlib>

#include "tests/support/temporary_folder.h"
#include "tests/tools/command_outcome.h"

using namespace etendue;

namespace {

std::size_t countOf(const std::string& text, const std::string& fragment) {
    std::size_t count = 0;
    for (std::size_t at = text.find(fragment); at != std::string::npos;
         at = text.find(fragment, at + 1))
        ++count;
    return count;
}

/// Fits are kept there and not in the user's cache.
struct OwnCache {
    TemporaryFolder folder;
    OwnCache() { setenv("XDG_CACHE_HOME", folder.path().c_str(), 1); }
    ~OwnCache() { unsetenv("XDG_CACHE_HOME"); }
};

/// A small and quick fit.
LensReportCommand quickReport(const char* lens) {
    LensReportCommand command;
    command.choice.lens = lens;
    command.options.terms = 16;
    command.options.degree = 7;
    return command;
}

}  // namespace

TEST_CASE("Lens report: the page is whole, alone and without numbers that are none") {
    const TemporaryFolder folder;
    const std::filesystem::path out = folder.path() / "new" / "folder";
    const Outcome outcome = run("lens report tessar-100mm --terms 16 --degree 7 -o " + out.string(),
                                "XDG_CACHE_HOME=" + folder.path().string());
    REQUIRE(outcome.code == 0);
    const std::string page = readFile(out / "index.html"), json = readFile(out / "report.json");
    CHECK(page.starts_with("<!doctype html>"));
    CHECK(page.ends_with("</html>\n"));
    for (const char* tag : {"svg", "table", "figure", "div", "h2", "p"})
        CHECK(countOf(page, "<" + std::string(tag) + ">") +
                  countOf(page, "<" + std::string(tag) + " ") ==
              countOf(page, "</" + std::string(tag) + ">"));
    // Nothing is fetched: the only addresses are the names of the SVG namespace.
    CHECK(countOf(page, "http") == countOf(page, "xmlns=\"http://www.w3.org/2000/svg\""));
    CHECK(countOf(page, "src=") == 0);
    CHECK(countOf(page, ">nan") + countOf(page, " nan") + countOf(page, "\"nan") == 0);
    CHECK(contains(page, "etendue lens report tessar-100mm --terms 16 --degree 7 -o "));
    for (const char* key : {"\"spots\"", "\"opencv_pinhole\"", "\"opencv_fisheye\"",
                            "\"vignetting\"", "\"direction_mrad_row_by_row\"", "\"two_step\"",
                            "\"across_mm\"", "\"paraxial_focus\"", "\"tangential_focus_mm\""})
        CHECK(contains(json, key));
    CHECK(countOf(json, "nan") == 0);
}

TEST_CASE(
    "Lens report: exact and fitted spots are of the same rays, and as far apart as the fit says") {
    const OwnCache cache;
    const LensReport report = makeReport(quickReport("tessar-100mm"));
    REQUIRE(report.spots.size() >= 5);
    const ErrorSummary& error = report.fit.fit.errors.sensorMicrometres;
    for (const ReportSpot& spot : report.spots) {
        CHECK(spot.exactRmsMm > 0.0);
        CHECK(spot.fittedRmsMm == doctest::Approx(spot.exactRmsMm).epsilon(0.1));
        CHECK(1e3 * spot.largestShiftMm < 3.0 * error.most);
        for (std::size_t line = 0; line < reportLinesNm.size(); ++line)
            CHECK(spot.exact[line].size() == spot.fitted[line].size());
    }
    // All of the sensor's diagonal is bright and has chief rays.
    const ReportAxis& axis = report.curves.front().axis;
    CHECK(axis.edgeMm == doctest::Approx(std::hypot(18.0, 12.0)));
    CHECK(axis.chiefMm == doctest::Approx(axis.edgeMm));
    CHECK(report.newton.back().highMm == doctest::Approx(axis.edgeMm));
}

TEST_CASE(
    "Lens report: field curvature begins on the axis at the focus of the longitudinal curve") {
    const OwnCache cache;
    const LensReport report = makeReport(quickReport("tessar-100mm"));
    const ReportCurves& curves = report.curves.front();
    REQUIRE(curves.fieldCurvature.size() == curves.heightsMm.size());
    const double paraxial = curves.focusShiftMm[1].front();
    CHECK(curves.fieldCurvature.front().tangentialMm ==
          doctest::Approx(paraxial).scale(1.0).epsilon(5e-4));  // as "focusShiftMm: close to…"
    CHECK(curves.fieldCurvature.back().tangentialMm !=
          doctest::Approx(curves.fieldCurvature.back().sagittalMm));
}

TEST_CASE("Lens report: an anamorphic lens is looked at in both of its planes" *
          doctest::test_suite("slow")) {
    const OwnCache cache;
    LensReportCommand command = quickReport("anamorphic-80x90mm");
    command.options.degree = 5;
    command.choice.sensorMm = {16.0, 12.0};
    const LensReport report = makeReport(command);
    REQUIRE(report.curves.size() == 2);
    CHECK(report.curves[0].axis.name == "x");
    CHECK(report.curves[1].axis.name == "y");
    REQUIRE(report.pinhole.has_value());
    // Chief rays spread from the exit pupil; the sensor lies between the foci of x and y.
    const ParaxialData& data = report.info.paraxial;
    const auto seen = [&](const ParaxialAxis& axis) {
        const double pupil = axis.exitPupilZMm - data.lastVertexZMm;
        return axis.focalLengthMm * (report.info.sensorDistanceMm + pupil) /
               (axis.backFocalDistanceMm + pupil);
    };
    const Eigen::Vector2d& focal = report.pinhole->focalLengthMm;
    CHECK(focal.x() == doctest::Approx(seen(data.x)).epsilon(5e-3));
    CHECK(focal.y() == doctest::Approx(seen(data.y)).epsilon(5e-3));
    CHECK(focal.x() < 0.95 * focal.y());
}

TEST_CASE("Lens report: what is in the place of its folder or its files is told before the fit") {
    const TemporaryFolder folder;
    const std::string report = "lens report tessar-100mm -o ";
    const std::string quick = "XDG_CACHE_HOME=" + folder.path().string() + " timeout 5";
    const std::string file = folder.write("file", "").string();
    const Outcome place = run(report + file, quick);
    CHECK(place.code == 65);
    CHECK(place.output == "etendue: " + file + ": is a file, expected a folder\n");
    std::filesystem::create_directories(folder / "out/report.json");
    const Outcome page = run(report + (folder / "out").string(), quick);
    CHECK(page.code == 65);
    CHECK(page.output == "etendue: " + (folder / "out/report.json").string() +
                             ": is a folder, not a file to write\n");
}

TEST_CASE("Lens report: the command that it names makes it again") {
    LensReportCommand command;
    command.choice.lens = "zoom-57-143mm";
    command.choice.zoomPosition = "143 mm";
    command.choice.fNumber = 4.0;
    command.options.form = FitForm::sensorState;
    command.folder = "out";
    CHECK(commandLine(command) ==
          "etendue lens report zoom-57-143mm --zoom \"143 mm\" --f-number 4 --form sensor-state -o "
          "out");
}
