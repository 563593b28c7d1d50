// Renders on a machine that is unkind: killed at any time, no room, no memory, odd names and
// clocks.
#include <doctest/doctest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "renderer/film.h"
#include "renderer/part_file.h"
#include "tests/tools/renders.h"
#include "tools/farm_scripts.h"
#include "tools/part_keeper.h"

using namespace etendue;

namespace {

namespace fs = std::filesystem;

constexpr int killed = 128 + SIGKILL;

std::uint32_t samplesHeld(const fs::path& part) {
    return fs::exists(part) ? static_cast<std::uint32_t>(readPartInfo(part).ranges.count()) : 0;
}

/// A render that goes on whatever happened, and looks after its part.
class KilledRender {
public:
    explicit KilledRender(const Renders& renders, int threads)
        : renders_(renders),
          options_("--checkpoint 1e-9 --resume -s estimator.kind=bdpt --threads " +
                   std::to_string(threads) + " --samples ") {}

    std::string line(std::uint32_t samples = 1'000'000) const {
        return renders_.renderLine("k.exr", options_ + std::to_string(samples));
    }
    /// After a kill: each part is whole, and no sample that was in one is lost.
    void checkParts() {
        for (const char* name : {"k.part.exr", "k.part.old.exr"})
            if (fs::exists(renders_.path(name)))
                CHECK_NOTHROW(static_cast<void>(readPart(renders_.path(name))));
        const std::uint32_t held = samplesHeld(renders_.path("k.part.exr"));
        CHECK(held >= held_);
        held_ = held;
    }
    /// Finishes it: the bits of a render that nobody disturbed, and nothing left behind.
    void checkEnd() const {
        const std::uint32_t samples = held_ + 3;
        CHECK(run(line(samples)).code == 0);
        REQUIRE(
            renders_
                .render("whole.exr", "-s estimator.kind=bdpt --samples " + std::to_string(samples))
                .code == 0);
        CHECK(renders_.pixels("k.exr") == renders_.pixels("whole.exr"));
        CHECK(renders_.names() == std::vector<std::string>{"k.exr", "s.toml", "whole.exr"});
        fs::remove(renders_.path("k.exr"));
    }
    std::uint32_t held() const { return held_; }

private:
    const Renders& renders_;
    std::string options_;
    std::uint32_t held_ = 0;
};

/// Renders that `kill`, told which kill it is, runs until their end: with 1, 2 and 4 threads.
template <class Kill>
void killAgainAndAgain(const Renders& renders, const std::string& when, const Kill& kill) {
    int kills = 0;
    for (const int threads : {1, 2, 4}) {
        CAPTURE(threads);
        KilledRender render(renders, threads);
        for (int i = 1; i <= 34; ++i) {
            CAPTURE(i);
            kills += kill(render, i).code == killed;
            render.checkParts();
        }
        CHECK(render.held() > 0);
        render.checkEnd();
    }
    CHECK(kills == 102);
    MESSAGE(kills << " kills " << when);
}

/// Of this process, in bytes.
std::size_t residentBytes() {
    std::ifstream statm("/proc/self/statm");
    std::size_t pages = 0, resident = 0;
    statm >> pages >> resident;
    return resident * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
}

std::size_t openFiles() {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()));
}

/// In a file system of its own at `mount`, which ends with the line.
Outcome shellOnDisk(const fs::path& mount, const std::string& size, const std::string& line) {
    return shell("exec unshare -rm sh -c 'exec 2>&1; mount -t tmpfs -o size=" + size + " none " +
                 mount.string() + " && { " + line + "; }'");
}

/// Says so where the system allows no such thing (some containers).
bool canMount(const fs::path& mount) {
    fs::create_directories(mount);
    const bool can = shellOnDisk(mount, "1m", "true").code == 0;
    WARN_MESSAGE(can, "no file system may be mounted here: nothing is tested");
    return can;
}

}  // namespace

TEST_SUITE_BEGIN("statistical");

TEST_CASE("Unkind machine: killed at any time, a render goes on to the same bits") {
    const Renders renders;
    // Some before it begins, most while it renders, however long a start takes here.
    const auto start = std::chrono::steady_clock::now();
    REQUIRE(renders.render("x.exr", "--samples 1").code == 0);
    std::chrono::duration<double> startSeconds = std::chrono::steady_clock::now() - start;
    fs::remove(renders.path("x.exr"));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(0.5, 2.5);
    std::uint32_t held = 0;
    killAgainAndAgain(renders, "at random times", [&](const KilledRender& render, int) {
        if (render.held() == held) startSeconds *= 1.05;  // the machine has become slower
        held = render.held();
        return shell("timeout -s KILL " + std::to_string(share(random) * startSeconds.count()) +
                     " " + ETENDUE_COMMAND + " " + render.line());
    });
}

TEST_CASE("Unkind machine: killed in the middle of writing a part, it has the old one or the new") {
    killAgainAndAgain(
        Renders(), "inside the write of a part",
        [](const KilledRender& render, int call) { return killAtCall(call, render.line()); });
}

TEST_CASE("Unkind machine: killed while a render ends, there is the old picture or the new one") {
    const Renders renders;
    REQUIRE(renders.render("old.exr", "--samples 2 --keep-part").code == 0);
    REQUIRE(renders.render("new.exr", "--samples 3").code == 0);
    const std::vector<float> before = renders.pixels("old.exr"), after = renders.pixels("new.exr");
    const fs::path x = renders.path("x.exr"), part = renders.path("x.part.exr");
    const std::string end = renders.renderLine("x.exr", "--samples 3 --resume");
    const auto begin = [&] {
        fs::copy(renders.path("old.exr"), x, fs::copy_options::overwrite_existing);
        fs::copy(renders.path("old.part.exr"), part, fs::copy_options::overwrite_existing);
    };
    int kills = 0, old = 0;
    for (begin(); killAtCall(kills + 1, end).code == killed; begin()) {
        ++kills;
        CAPTURE(kills);
        const std::vector<float> pixels = renders.pixels("x.exr");
        CHECK((pixels == before || pixels == after));
        old += pixels == before;
        // Gone is the part only where the picture of its samples is there.
        CHECK((fs::exists(part) || pixels == after));
        if (fs::exists(part)) CHECK(readPartInfo(part).ranges.count() == 2);
    }
    CHECK(renders.pixels("x.exr") == after);
    CHECK(old >= 4);
    CHECK(kills > old);
    MESSAGE(kills << " kills, one at each call that changes a file; the old picture after " << old);
}

TEST_CASE("Unkind machine: a full disk is an error, and what is there stays whole") {
    const Renders renders;
    REQUIRE(renders.render("whole.exr", "--samples 6").code == 0);
    const std::vector<float> whole = renders.pixels("whole.exr");
    if (!canMount(renders.path("disk"))) return;
    int errors = 0, pictures = 0, resumed = 0;
    for (int kilobytes = 4; kilobytes <= 120; kilobytes += 4) {
        CAPTURE(kilobytes);
        const std::string options = "--samples 6 --checkpoint 1e-9 --resume";
        const Outcome outcome = shellOnDisk(
            renders.path("disk"), std::to_string(kilobytes) + "k",
            std::string(ETENDUE_COMMAND) + " " + renders.renderLine("disk/x.exr", options) +
                "; code=$?; cp -r " + renders.path("disk").string() + " " +
                renders.path("left").string() + "; exit $code");
        CAPTURE(outcome.output);
        if (outcome.code == 0) {
            ++pictures;
            CHECK(renders.pixels("left/x.exr") == whole);
        } else {
            ++errors;
            CHECK(outcome.code == 1);
            CHECK(contains(outcome.output, "x.exr: cannot write: No space left on device"));
            CHECK_FALSE(fs::exists(renders.path("left/x.exr")));
            // Elsewhere it goes on from what it has.
            resumed += fs::exists(renders.path("left/x.part.exr"));
            REQUIRE(renders.render("left/x.exr", options).code == 0);
            CHECK(renders.pixels("left/x.exr") == whole);
        }
        fs::remove_all(renders.path("left"));
    }
    CHECK(errors > 0);
    CHECK(pictures > 0);
    CHECK(resumed > 0);
    MESSAGE(errors << " sizes too small, " << resumed << " of them with a part; " << pictures
                   << " large enough");
}

TEST_CASE("Unkind machine: a folder that may not be written is an error at once") {
    const Renders renders;
    REQUIRE(renders.render("a.part.exr", "--range 0:1").code == 0);
    if (!canMount(renders.path("disk"))) return;
    const auto check = [&](const std::string& line) {
        const Outcome outcome = shellOnDisk(renders.path("disk"), "1m",
                                            "mount -o remount,ro " + renders.path("disk").string() +
                                                "; " + ETENDUE_COMMAND + std::string(" ") + line);
        CAPTURE(outcome.output);
        CHECK(outcome.code == 1);
        CHECK(contains(outcome.output, "disk/"));
        CHECK(contains(outcome.output, "Read-only file system"));
    };
    check(renders.renderLine("disk/x.exr", "--samples 1000000"));
    check("merge " + renders.path("a.part.exr").string() + " -o " +
          renders.path("disk/x.exr").string());
}

TEST_CASE("Unkind machine: a folder in the place of an output is an error at once") {
    const Renders renders;
    fs::create_directories(renders.path("x.exr"));
    fs::create_directories(renders.path("y.part.exr"));
    const std::pair<const char*, const char*> cases[] = {
        {"x.exr", "x.exr"}, {"y.exr", "y.part.exr"}, {"y.part.exr", "y.part.exr"}};
    for (const auto& [output, folder] : cases) {
        const Outcome outcome = renders.render(output, "--samples 1000000");
        CAPTURE(outcome.output);
        CHECK(outcome.code == 65);
        CHECK(contains(outcome.output, folder));
        CHECK(contains(outcome.output, "folder"));
    }
    REQUIRE(renders.render("a.part.exr", "--range 0:1").code == 0);
    for (const char* options : {"", "--preview /no/such/folder/x.png"}) {
        const Outcome outcome =
            renders.merge({"a.part.exr"}, *options ? "m.exr" : "x.exr", options);
        CAPTURE(outcome.output);
        CHECK(outcome.code != 0);
        CHECK(contains(outcome.output, "folder"));
    }
}

TEST_CASE("Unkind machine: too little memory is an error, never another picture") {
    const Renders renders;
    REQUIRE(renders.render("whole.exr", "--samples 2").code == 0);
    const std::vector<float> whole = renders.pixels("whole.exr");
    int starts = 0, errors = 0, pictures = 0;
    for (int megabytes = 100; pictures < 12 && megabytes < 20'000;
         megabytes += 1 + megabytes / 100) {
        CAPTURE(megabytes);
        const std::string limited =
            "ulimit -v " + std::to_string(megabytes * 1024) + "; exec " + ETENDUE_COMMAND + " ";
        // With less than some 500 MB the system does not get as far as the program: it maps and
        // starts the libraries.
        starts = shell(limited + "--version").code == 0 ? starts + 1 : 0;
        if (starts < 3) continue;
        const Outcome outcome =
            shell(limited + renders.renderLine("x.exr", "--samples 2 --threads 2"));
        CAPTURE(outcome.output);
        if (outcome.code == 0) {
            ++pictures;
            CHECK(renders.pixels("x.exr") == whole);
            fs::remove(renders.path("x.exr"));
        } else {
            ++errors;
            CHECK(outcome.code == 1);
            CHECK(contains(outcome.output, "etendue: "));  // not a crash: an error of ours
        }
        CHECK(renders.names() == std::vector<std::string>{"s.toml", "whole.exr"});
    }
    CHECK(errors > 0);
    CHECK(pictures == 12);
    MESSAGE(errors << " limits too small, " << pictures << " large enough");
}

TEST_CASE("Unkind machine: ten thousand checkpoints leave nothing behind") {
    const TemporaryFolder folder;
    const Film film({16, 12, 0, 0, 16, 12}, {}, FilmColor::rgb);
    PartInfo info;
    info.window = film.window();
    PartKeeper keeper(folder / "x.part.exr", info, 0, {});
    std::size_t bytes = 0, files = 0;
    for (std::uint32_t checkpoint = 1; checkpoint <= 10'000; ++checkpoint) {
        keeper.write(film, checkpoint, 1.0, {});
        if (checkpoint != 1'000) continue;
        bytes = residentBytes();
        files = openFiles();
    }
    const std::size_t after = residentBytes(), grownBytes = after - std::min(bytes, after);
    CHECK(grownBytes < 1'000'000);
    CHECK(openFiles() == files);
    CHECK(folder.names() == std::vector<std::string>{"x.part.exr", "x.part.old.exr"});
    CHECK(samplesHeld(folder / "x.part.exr") == 10'000);
    MESSAGE("9,000 more checkpoints took " << grownBytes << " bytes of memory");
}

TEST_CASE("Unkind machine: a clock that jumps changes nothing") {
    const Renders renders;
    REQUIRE(renders.render("whole.exr", "--samples 9").code == 0);
    const std::string jumping = "LD_PRELOAD=" ETENDUE_UNKIND_MACHINE " UNKIND_CLOCK=1 ";
    const long long jumped = std::stoll(shell(jumping + "date +%s").output),
                    now = std::stoll(shell("date +%s").output);
    CHECK(std::abs(jumped - now) > 1'000'000);
    const Outcome outcome =
        shell(jumping + ETENDUE_COMMAND + " " +
              renders.renderLine("x.exr", "--samples 9 --checkpoint 0.01 --time 3600"));
    CAPTURE(outcome.output);
    CHECK(outcome.code == 0);
    CHECK(renders.pixels("x.exr") == renders.pixels("whole.exr"));
}

TEST_CASE("Unkind machine: names with spaces, quotes and letters of all kinds") {
    const Renders renders;
    REQUIRE(renders.render("whole.exr", "--samples 4").code == 0);
    // Latin-1, too, is a name: here of the scene, which the part's header tells.
    const std::string name = "Étendue „f/2\u00a0·\u00a0光“ it's #1 %s";
    const std::string folder = renders.path(name).string();
    fs::create_directories(folder);
    fs::copy(renders.path("s.toml"), renders.path(name) / "sc\xe8ne.toml");
    const auto quoted = [&](const std::string& file) { return shellQuoted(folder + "/" + file); };
    const std::string begin = "render " + quoted("sc\xe8ne.toml") + " --quiet --size 40,24 -o ";
    REQUIRE(run(begin + quoted("a b.exr") + " --samples 2 --keep-part").code == 0);
    REQUIRE(run(begin + quoted("a b.exr") + " --samples 3 --resume --keep-part").code == 0);
    REQUIRE(run(begin + quoted("ç.part.exr") + " --range 3:4").code == 0);
    const Outcome merged = run("merge " + quoted("a b.part.exr") + " " + quoted("ç.part.exr") +
                               " -o " + quoted("ü.exr") + " --preview " + quoted("ü.png"));
    CAPTURE(merged.output);
    CHECK(merged.code == 0);
    CHECK(renders.pixels(name + "/ü.exr") == renders.pixels("whole.exr"));
    CHECK(fs::exists(renders.path(name) / "ü.png"));
}
TEST_SUITE_END();
