#include <doctest/doctest.h>

#include "config/config.h"
#include "tests/config/error_message.h"

namespace etendue {
namespace {

const std::string scene = R"([camera]
f_number = 2.8
from = [0, 1, 2]

[[material]]
name = "glass"
ior = 1.5

[[material]]
name = "red.wall"

[[material]]
name = "twin"

[[material]]
name = "twin"
)";

Config withOverride(std::string_view assignment) {
    Config config = parsed(scene);
    config.set(assignment);
    return config;
}

}  // namespace

TEST_CASE("Config: set replaces a value or adds one") {
    const auto camera = [](std::string_view assignment) {
        return withOverride(assignment).root().table("camera");
    };
    CHECK(camera("camera.f_number=4").number("f_number", Range::any()) == 4.0);
    CHECK(camera(" camera . f_number = 4.5 ").number("f_number", Range::any()) == 4.5);
    CHECK(camera("camera.focus=inf").number("focus", {0, Range::infinity}) == Range::infinity);
    CHECK(camera("camera.from=[1, 2.5]").numbers("from", 2, Range::any())[1] == 2.5);
    CHECK(camera("camera.from.1=7").numbers("from", 3, Range::any())[1] == 7.0);
    CHECK(camera("camera.traced=true").boolean("traced", false));
    CHECK(camera("camera.film.width=5").table("film").integer("width", Range::any()) == 5);
    CHECK(camera("camera={f_number = 1}").keys() == std::vector<std::string>{"f_number"});
}

TEST_CASE("Config: set takes a bare word as a string") {
    const auto text = [](const std::string& value) {
        return withOverride("x=" + value).root().text("x");
    };
    CHECK(text("bdpt") == "bdpt");
    CHECK(text("two-point") == "two-point");
    CHECK(text("../lenses/a b.toml") == "../lenses/a b.toml");
    CHECK(text("#1") == "#1");
    CHECK(text("a=b") == "a=b");
    CHECK(text("'in quotes'") == "in quotes");
    CHECK(text("\"\"") == "");
    CHECK(text(repeated("a.", 1000) + "a").size() == 2001);
}

TEST_CASE("Config: set finds an array's entry by name or index") {
    const auto materials = [](std::string_view assignment) {
        return withOverride(assignment).root().tables("material");
    };
    CHECK(materials("material.glass.ior=1.7")[0].number("ior", Range::any()) == 1.7);
    CHECK(materials("material.0.ior=1.7")[0].number("ior", Range::any()) == 1.7);
    CHECK(materials("material.\"red.wall\".ior=1.7")[1].number("ior", Range::any()) == 1.7);
    CHECK(materials("material.'red.wall'.a.b=1")[1].table("a").integer("b", Range::any()) == 1);
    CHECK(materials("material.3.ior=1.7")[3].number("ior", Range::any()) == 1.7);
}

TEST_CASE("Config: set refuses what it cannot place, naming what is near") {
    struct BadAssignment {
        std::string assignment, expected;
    };
    const std::vector<BadAssignment> table = {
        {"", "expected key=value"},
        {"camera.f_number", "expected key=value"},
        {"=1", "no empty part"},
        {"camera..f_number=1", "no empty part"},
        {".camera=1", "no empty part"},
        {"camera.=1", "no empty part"},
        {"camera.f_number=", "expected a value after '='"},
        {"camera.f_number=  ", "expected a value after '='"},
        {"camera.f_number=[1, 2", "not valid TOML (array)"},
        {"camera.f_number='abc", "not valid TOML"},
        {"camera.f_number=1\nother = 2", "expected one value"},
        {"camera.f_number=a\nb", "not valid TOML"},
        {"camera.f_number.x=1",
         "camera.f_number: has no key \"x\": it is 2.8, set at scene.toml:2"},
        {"material.glas.ior=1", "material: no entry \"glas\"; did you mean 'glass'?"},
        {"material.9.ior=1", "entries are 0 to 3 or 'glass', 'red.wall', 'twin'"},
        {"material.-1.ior=1", "material: no entry \"-1\""},
        {"material.0x1.ior=1", "material: no entry \"0x1\""},
        {"material.twin.ior=1", "material: more than one entry is named \"twin\""},
        {"camera.from.3=1", "camera.from: no entry \"3\"; entries are 0 to 2"},
        {repeated("a.", 64) + "a=1", "a key of more than 64 parts"},
        {repeated("a.", 100000) + "a=1", "a key of more than 64 parts"},
        {"a=" + repeated("[", 100000), "nested deeper than 64 levels"},
        {repeated("a.", 39) + "a=" + repeated("[", 40) + repeated("]", 40), "nested deeper"},
    };
    for (const BadAssignment& bad : table) {
        CAPTURE(bad.assignment.substr(0, 40));
        const std::string message = errorMessage([&] { withOverride(bad.assignment); });
        CHECK_MESSAGE(contains(message, bad.expected), message);
        CHECK_MESSAGE(message.starts_with("-s " + bad.assignment.substr(0, 9)), message);
    }
}

TEST_CASE("Config: a refused override leaves the document as it was") {
    Config config = parsed(scene);
    CHECK(errorMessage([&] { config.set("new.table.x='open"); }) != "");
    CHECK(config.root().keys() == std::vector<std::string>{"camera", "material"});
}

TEST_CASE("Config: errors in overridden values name the override, others keep their line") {
    const ConfigTable root = withOverride("camera.f_number=abc").root();
    CHECK(errorMessage([&] {
              root.table("camera").number("f_number", {0.5, 128});
          }) ==
          "-s camera.f_number=abc: camera.f_number: expected a number from 0.5 to 128, got "
          "\"abc\"");
    CHECK(errorMessage([&] {
              root.table("camera").numbers("from", 2, Range::any());
          }).starts_with("scene.toml:3: camera.from: "));

    const ConfigTable slip = withOverride("camra.f_number=2").root();
    slip.table("camera");
    slip.tables("material");
    CHECK(errorMessage([&] { slip.finish(); }) ==
          "-s camra.f_number=2: camra: unknown key; did you mean 'camera'?");
}

TEST_CASE("Config: a file set by an override is taken from the current folder") {
    const ScratchFolder folder("override_file");
    folder.write("scenes/here.obj", "");
    const auto file = folder.write("scenes/scene.toml", "mesh = 'here.obj'\n");
    Config config = Config::load(file);
    CHECK(config.root().file("mesh") == folder.path() / "scenes/here.obj");

    config.set("mesh=here.obj");
    CHECK(errorMessage([&] { config.root().file("mesh"); }) ==
          "-s mesh=here.obj: mesh: " + (std::filesystem::current_path() / "here.obj").string() +
              ": no such file");
    config.set("mesh=" + (folder.path() / "scenes/here.obj").string());
    CHECK(config.root().file("mesh") == folder.path() / "scenes/here.obj");
}

}  // namespace etendue
