// The commands about lenses as a user meets them.
#include <sys/stat.h>

#include "tests/lens/prescriptions.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/command_outcome.h"

using namespace etendue;

TEST_CASE("Lens command: info tells what the header of a lens states") {
    const Outcome outcome = run("lens info tessar-100mm");
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.output, "Tessar"));
    CHECK(contains(outcome.output, "US patent 2,854,889"));
    CHECK(contains(outcome.output, "99.996 mm"));
    CHECK(contains(outcome.output, "79.809 mm"));
    CHECK(contains(outcome.output, "1.69100"));
    const Outcome json =
        run("lens info " + lensFile("anamorphic-80x90mm.toml").string() + " --json");
    CHECK(json.code == 0);
    CHECK(contains(json.output, "\"symmetry\": \"anamorphic\""));
    CHECK(contains(json.output, "\"focal_length_mm\": 80.69"));
    CHECK(contains(json.output, "\"focal_length_mm\": 90.59"));
}

TEST_CASE("Lens command: a zoom position is chosen by its name") {
    CHECK(contains(run("lens info zoom-57-143mm --zoom '143 mm'").output, "143.076 mm"));
    const Outcome wrong = run("lens info zoom-57-143mm --zoom '100 mm'");
    CHECK(wrong.code == 65);
    CHECK(contains(wrong.output, "57 mm"));
}

TEST_CASE(
    "Lens command: wrong usage is 64, a bad lens 65, a missing one 66 with the nearest name") {
    const TemporaryFolder folder;
    CHECK(run("lens").code == 64);
    CHECK(run("lens info").code == 64);
    CHECK(run("lens info tessar-100mm --f-number 0.3").code == 64);
    CHECK(run("lens info tessar-100mm --focus 0.1").code == 64);
    const std::string bad = folder.write("bad.toml", "name = \"x\"\nsurfce = []\n").string();
    const Outcome badOutcome = run("lens info " + bad);
    CHECK(badOutcome.code == 65);
    CHECK(contains(badOutcome.output, "bad.toml"));
    const Outcome missing = run("lens info tesar-100mm");
    CHECK(missing.code == 66);
    CHECK(contains(missing.output, "tessar-100mm"));
}

TEST_CASE("Lens command: a setting that is no number, or beyond all lenses, is wrong usage" *
          doctest::test_suite("slow")) {
    const std::vector<std::pair<const char*, const char*>> cases{
        {"--sensor nan,nan", "expected a number from 0.001 to 100000"},
        {"--sensor 1e9,1", "expected a number from 0.001 to 100000"},
        {"--sensor 36,0", "expected a number from 0.001 to 100000"},
        {"--sensor 36", "--sensor"},
        {"--f-number nan", "expected a number from 0.1 to 10000"},
        {"--f-number 0.05", "expected a number from 0.1 to 10000"},
        {"--f-number 2e4", "expected a number from 0.1 to 10000"},
        {"--focus nan", "expected a number above 0"},
        {"--focus 0", "expected a number above 0"},
        {"--focus -1", "expected a number above 0"},
        {"--focus 2m", "expected a number above 0"}};
    for (const auto& bad : cases) {
        CAPTURE(bad.first);
        const Outcome outcome = run("lens info tessar-100mm " + std::string(bad.first));
        CHECK(outcome.code == 64);
        CHECK(contains(outcome.output, bad.second));
    }
    CHECK(run("lens info tessar-100mm --focus inf --sensor 1e5,1e-3 --f-number 1e4").code == 0);
    CHECK(run("lens draw tessar-100mm -o /dev/null --wavelengths nan").code == 64);
    CHECK(run("lens fit tessar-100mm --wavelengths nan,nan").code == 64);
}

TEST_CASE("Lens command: draw writes a whole picture with every field") {
    const TemporaryFolder folder;
    const std::string svg = (folder.path() / "lens.svg").string();
    const Outcome outcome = run("lens draw fisheye-181-10mm --fields 4 --rays 3 --json -o " + svg);
    CHECK(outcome.code == 0);
    CHECK(contains(outcome.output, "\"rays\": 3"));
    CHECK_FALSE(contains(outcome.output, "\"rays\": 0"));
    const std::string picture = readFile(svg);
    CHECK(contains(picture, "Fisheye with aspheres"));
    CHECK(contains(picture, "f = 9.71 mm, f/2.11 wide open, focus at infinity, sensor 36 × 24 mm"));
    for (const char* colour : {"\"c0 thin\"", "\"c1 thin\"", "\"c2 thin\"", "\"c3 thin\""})
        CHECK(contains(picture, colour));
    CHECK(picture.ends_with("</svg>\n"));
    CHECK(run("lens draw tessar-100mm --f-number 8 --focus 3 -o " + svg).code == 0);
    CHECK(contains(readFile(svg), ", f/8.00, focus at 3 m, "));
    CHECK(run("lens draw tessar-100mm -o " + (folder.path() / "no/x.svg").string()).code == 66);
    CHECK(run("lens draw tessar-100mm --wavelengths 200 -o " + svg).code == 64);
}

TEST_CASE("Lens command: fit reports its errors, and the second run takes it from the cache" *
          doctest::test_suite("slow")) {
    const TemporaryFolder folder;
    const std::string setting = "XDG_CACHE_HOME=" + folder.path().string();
    const std::string arguments = "lens fit tessar-100mm --terms 8 --degree 5";
    const Outcome first = run(arguments, setting);
    CHECK(first.code == 0);
    CHECK(contains(first.output, "fitting Tessar"));
    CHECK(contains(first.output, "8 terms of degree 5"));
    CHECK(contains(first.output, "mrad"));
    CHECK(contains(first.output, "étendue"));
    CHECK(contains(first.output, "kept in " + folder.path().string()));
    const Outcome second = run(arguments, setting);
    CHECK_FALSE(contains(second.output, "fitting"));
    CHECK(contains(second.output, "from the cache"));
    const std::string file = (folder.path() / "fit.json").string();
    const Outcome json = run(arguments + " --json -o " + file, setting);
    CHECK(contains(json.output, "\"from_cache\": true"));
    CHECK(contains(json.output, "\"direction_mrad\""));
    CHECK(readFile(file).starts_with("{"));
}

TEST_CASE("Lens command: a basis that does not suit the lens is refused") {
    CHECK(run("lens fit anamorphic-80x90mm --basis axial").code == 64);
    CHECK(run("lens fit tessar-100mm --basis axil").code == 64);
    CHECK(run("lens fit tessar-100mm --wavelengths 700,400").code == 64);
}

TEST_CASE("Lens command: what is written goes through a link and never replaces it") {
    const TemporaryFolder folder;
    folder.write("target.svg", "old");
    std::filesystem::create_symlink("target.svg", folder.path() / "link.svg");
    const std::string link = (folder.path() / "link.svg").string();
    CHECK(run("lens draw tessar-100mm -o " + link).code == 0);
    CHECK(std::filesystem::is_symlink(link));
    CHECK(contains(readFile(folder.path() / "target.svg"), "<svg"));
}

TEST_CASE("Lens command: a folder that does not exist is told before anything is fitted") {
    const TemporaryFolder folder;
    const std::string quick = "XDG_CACHE_HOME=" + folder.path().string() + " timeout 5";
    for (const std::string option : {"fit tessar-100mm -o ", "codegen tessar-100mm -o ",
                                     "trade tessar-100mm --csv ", "trade tessar-100mm --plot "}) {
        CAPTURE(option);
        const Outcome outcome = run("lens " + option + (folder / "no/file").string(), quick);
        CHECK(outcome.code == 66);
        CHECK(outcome.output == "etendue: " + (folder / "no").string() + ": no such folder\n");
    }
}

TEST_CASE("Lens command: none writes over its lens, or two of its files into one" *
          doctest::test_suite("slow")) {
    const TemporaryFolder folder;
    const std::string lens = (folder / "lens.toml").string();
    std::filesystem::copy_file(lensFile("tessar-100mm.toml"), lens);
    const std::string before = readFile(lens);
    const std::string plot = (folder / "plot").string();
    for (const std::string& line :
         {"lens draw " + lens + " -o " + lens, "lens fit " + lens + " -o " + lens,
          "lens codegen " + lens + " -o " + lens, "lens trade " + lens + " --csv " + lens,
          "lens trade " + lens + " --csv " + plot + " --plot " + plot}) {
        CAPTURE(line);
        const Outcome outcome = run(line);
        CHECK(outcome.code == 64);
        CHECK(contains(outcome.output, "one would replace the other"));
    }
    CHECK(readFile(lens) == before);
}

TEST_CASE("Lens command: a fit is written through links and into pipes, which stay what they are" *
          doctest::test_suite("slow")) {
    const TemporaryFolder folder;
    folder.write("target.json", "old");
    std::filesystem::create_symlink("target.json", folder.path() / "link.json");
    const std::string cache = "XDG_CACHE_HOME=" + folder.path().string();
    const std::string fit = "lens fit tessar-100mm --terms 4 --degree 3 -o ";
    const std::string linkedFit = (folder.path() / "link.json").string();
    CHECK(run(fit + linkedFit, cache).code == 0);
    CHECK(std::filesystem::is_symlink(linkedFit));
    CHECK(readFile(folder.path() / "target.json").starts_with("{"));
    const std::string pipe = (folder.path() / "pipe").string();
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    const std::string read = (folder.path() / "read.json").string();
    CHECK(run(fit + pipe + " & timeout 20 cat " + pipe + " > " + read + "; wait $!", cache).code ==
          0);
    CHECK(std::filesystem::is_fifo(pipe));
    CHECK(readFile(read) == readFile(folder.path() / "target.json"));
    CHECK(run(fit + (folder.path() / "no/fit.json").string(), cache).code == 66);
}
