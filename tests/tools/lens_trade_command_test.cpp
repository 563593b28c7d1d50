#include <algorithm>

#include "tests/lens/prescriptions.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/command_outcome.h"
#include "tools/text_table.h"

using namespace etendue;

TEST_CASE("Text table: columns are as wide as their widest cell, words to the left") {
    const std::string table = alignedTable({{"lens", "µm"}, {"a", "1.25"}, {"tessar", "3"}}, "lr");
    CHECK(table == "  lens      µm\n  a       1.25\n  tessar     3\n");
}

TEST_CASE("Lens command: trade prints a row for every fit, and writes them as CSV and as a plot" *
          doctest::test_suite("slow")) {
    const TemporaryFolder folder;
    const std::string csv = (folder / "trade.csv").string(), svg = (folder / "trade.svg").string();
    const Outcome outcome =
        run("lens trade double-gauss-100mm tessar-100mm --terms 4,6 --degree 3 --basis axial "
            "--form two-point --csv " +
            csv + " --plot " + svg);
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.output, "mul-adds"));
    const std::string rows = readFile(csv);
    CHECK(std::ranges::count(rows, '\n') == 5);
    CHECK(rows.starts_with(
        "lens,zoom_position,form,basis,terms,degree,multiply_adds,direction_mrad_rms,"));
    CHECK(contains(rows, "tessar-100mm,,two-point,axial,6,3,"));
    CHECK(contains(readFile(svg), "</svg>"));
    const Outcome json = run(
        "lens trade double-gauss-100mm --terms 4 --degree 3 --basis axial --form two-point --json");
    CHECK(contains(json.output, "\"connect_lost_percent\": 0,"));
}

TEST_CASE("Lens command: a fit and a trade of a zoom lens say at which position" *
          doctest::test_suite("slow")) {
    const TemporaryFolder folder;
    const std::string cache = "XDG_CACHE_HOME=" + folder.path().string();
    const std::string at = "zoom-57-143mm --zoom '143 mm' --terms 4 --degree 3 ";
    CHECK(contains(run("lens fit " + at, cache).output, "Zoom, 57 to 143 mm f/2.8, at 143 mm\n"));
    CHECK(contains(run("lens fit --json " + at, cache).output, "\"zoom_position\": \"143 mm\""));
    const std::string csv = (folder / "t.csv").string(), svg = (folder / "t.svg").string();
    const std::string trade =
        "lens trade " + at + "--basis axial --form two-point --csv " + csv + " --plot " + svg;
    CHECK(contains(run(trade).output, "\n  zoom-57-143mm at 143 mm  two-point  axial"));
    CHECK(contains(readFile(csv), "\nzoom-57-143mm,143 mm,two-point,axial,4,3,"));
    CHECK(contains(readFile(svg), ">zoom-57-143mm at 143 mm, two-point, axial, degree 3<"));
    CHECK(contains(run(trade + " --json").output, "\"zoom_position\": \"143 mm\""));
    // A comma in a name is no end of a cell.
    const std::filesystem::path comma = folder / "a,b.toml";
    std::filesystem::copy_file(lensFile("tessar-100mm.toml"), comma);
    CHECK(run("lens trade '" + comma.string() +
              "' --terms 4 --degree 3 --basis axial --form two-point --csv " + csv)
              .code == 0);
    CHECK(contains(readFile(csv), "\n\"a,b\",,two-point,axial,4,3,"));
    // The first that it lists, where none is named.
    CHECK(
        contains(run("lens fit zoom-57-143mm --terms 4 --degree 3", cache).output, ", at 57 mm\n"));
}

TEST_CASE("Lens command: a trade whose file cannot be written prints its table all the same") {
    const Outcome outcome =
        run("lens trade tessar-100mm --terms 4 --degree 3 --basis axial --form two-point "
            "--csv /dev/full");
    CHECK(outcome.code == 1);
    CHECK(contains(outcome.output, "/dev/full: cannot write"));
    CHECK(contains(outcome.output, "\n  tessar-100mm  two-point  axial"));
}

TEST_CASE("Lens command: trade without a lens, or with a basis that does not suit it, is refused") {
    CHECK(run("lens trade").code == 64);
    CHECK(run("lens trade anamorphic-80x90mm --basis axial").code == 64);
    CHECK(run("lens trade double-gauss-100mm --form other").code == 64);
}

TEST_CASE("Lens command: trade's published table has no lenses, settings or files of the user's" *
          doctest::test_suite("slow")) {
    for (const std::string other :
         {"tessar-100mm", "--zoom x", "--sensor 36,24", "--focus 2", "--f-number 8", "--terms 8",
          "--degree 5", "--basis axial", "--form two-point", "--csv t.csv", "--plot t.svg"}) {
        CAPTURE(other);
        const Outcome outcome = run("lens trade --slides " + other, "timeout 5");
        CHECK(outcome.code == 64);
        CHECK(contains(outcome.output, "excludes --slides"));
    }
    CHECK(run("lens trade --slides --help").code == 0);
}
