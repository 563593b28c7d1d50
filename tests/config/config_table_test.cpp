#include <doctest/doctest.h>

#include <functional>
#include <limits>

#include "config/config.h"
#include "tests/config/error_message.h"

namespace etendue {
namespace {

struct BadValue {
    std::string value;  // of key "x"
    std::function<void(const ConfigTable&)> read;
    std::string expected;
};

/// Each value stands on line 3 in table "t".
void checkRefused(const std::vector<BadValue>& table) {
    for (const BadValue& bad : table) {
        CAPTURE(bad.value);
        const ConfigTable t = parsed("[t]\n\nx = " + bad.value + "\n").root().table("t");
        CHECK(errorMessage([&] { bad.read(t); }) == "scene.toml:3: t.x" + bad.expected);
    }
}

std::function<void(const ConfigTable&)> number(Range range) {
    return [range](const ConfigTable& t) { t.number("x", range); };
}
std::function<void(const ConfigTable&)> integer(Range range) {
    return [range](const ConfigTable& t) { t.integer("x", range); };
}
std::function<void(const ConfigTable&)> numbers(std::size_t count, Range range) {
    return [=](const ConfigTable& t) { t.numbers("x", count, range); };
}

}  // namespace

TEST_CASE("ConfigTable: getters return what the file says") {
    const ConfigTable t = parsed(R"(
whole = 3
real = 0.25
least = -9223372036854775808
endless = inf
yes = true
word = "sky é"
choice = "bdpt"
point = [1, 2.5, -3e2]
none = []
words = ["a", "b"]
"a.b" = 7
)")
                              .root();
    CHECK(t.number("whole", Range::any()) == 3.0);
    CHECK(t.number("real", Range::unit()) == 0.25);
    CHECK(t.number("endless", {0, Range::infinity}) == Range::infinity);
    CHECK(t.integer("whole", {3, 3}) == 3);
    CHECK(t.integer("least", Range::any()) == std::numeric_limits<std::int64_t>::min());
    CHECK(t.boolean("yes", false));
    CHECK(t.text("word") == "sky é");
    CHECK(t.choice("choice", {"pt", "bdpt"}) == "bdpt");
    CHECK(t.numbers("point", 3, Range::any()) == std::vector<double>{1.0, 2.5, -300.0});
    CHECK(t.numbers("point", 0, Range::any()).size() == 3);
    CHECK(t.numbers("none", 0, Range::any()).empty());
    CHECK(t.texts("words") == std::vector<std::string>{"a", "b"});
    CHECK(t.texts("word") == std::vector<std::string>{"sky é"});
    CHECK(t.integer("a.b", Range::any()) == 7);
    CHECK(t.has("point"));
    CHECK(!t.has("a"));
    CHECK(t.isArray("point"));
    CHECK(t.isArray("none"));
    CHECK(!t.isArray("words"));
    CHECK(!t.isArray("missing"));
    CHECK(t.isText("word"));
    CHECK(!t.isText("whole"));
    CHECK(!t.isText("missing"));
    t.finish();
}

TEST_CASE("ConfigTable: a missing key gives the fallback or nothing") {
    const ConfigTable t = parsed("").root();
    CHECK(t.number("x", Range::unit(), 0.5) == 0.5);
    CHECK(t.integer("x", Range::positive(), 4) == 4);
    CHECK(t.boolean("x", true));
    CHECK(t.text("x", "default") == "default");
    CHECK(t.choice("x", {"a", "b"}, "b") == "b");
    CHECK(t.texts("x").empty());
    CHECK(t.files("x").empty());
    CHECK(t.tables("x").empty());
    CHECK(t.table("x").keys().empty());
    CHECK(t.table("x").table("y").number("z", Range::unit(), 0.5) == 0.5);
}

TEST_CASE("ConfigTable: a missing key without fallback is an error at its table") {
    const ConfigTable t = parsed("\n[t]\nfnumber = 1\nwidths = 2").root().table("t");
    CHECK(t.integer("widths", Range::any()) == 2);
    CHECK(errorMessage([&] { t.number("x", Range::positive()); }) ==
          "scene.toml:2: t.x: missing, expected a positive number");
    CHECK(errorMessage([&] { t.numbers("x", 3, Range::any()); }) ==
          "scene.toml:2: t.x: missing, expected an array of 3, each a number");
    CHECK(errorMessage([&] {
              t.choice("x", {"a", "b"});
          }) == "scene.toml:2: t.x: missing, expected one of \"a\", \"b\"");
    CHECK(errorMessage([&] { t.text("x"); }) == "scene.toml:2: t.x: missing, expected a string");
    CHECK(errorMessage([&] { t.file("x"); }) == "scene.toml:2: t.x: missing, expected a file name");
    CHECK(errorMessage([&] {
              t.table("u").integer("x", {1, 8});
          }) == "scene.toml:2: t.u.x: missing, expected an integer from 1 to 8");
    // A key that nothing has asked for may be what was meant; one that has been read is not.
    CHECK(errorMessage([&] { t.number("f_number", Range::any()); }) ==
          "scene.toml:2: t.f_number: missing, expected a number; is it 'fnumber' at scene.toml:3?");
    CHECK(errorMessage([&] { t.number("width", Range::any()); }) ==
          "scene.toml:2: t.width: missing, expected a number");
}

TEST_CASE("ConfigTable: numbers outside their range are refused in readable words") {
    constexpr double inf = Range::infinity;
    checkRefused({
        {"\"abc\"", number({0.5, 128}), ": expected a number from 0.5 to 128, got \"abc\""},
        {"0.25", number({0.5, 128}), ": expected a number from 0.5 to 128, got 0.25"},
        {"129", number({0.5, 128}), ": expected a number from 0.5 to 128, got 129"},
        {"0", number(Range::positive()), ": expected a positive number, got 0"},
        {"-1.0", number(Range::nonNegative()), ": expected a number of at least 0, got -1.0"},
        {"1.5", number(Range::unit()), ": expected a number from 0 to 1, got 1.5"},
        {"3", number({-1e30, 2}), ": expected a number of at most 2, got 3"},
        {"3", number({1e-30, 2}), ": expected a positive number of at most 2, got 3"},
        {"-1", number({0, inf}), ": expected a number of at least 0 or inf, got -1"},
        {"true", number(Range::any()), ": expected a number, got true"},
        // Neither nan, nor inf unless the range reaches it.
        {"nan", number(Range::any()), ": expected a number, got nan"},
        {"nan", number({-inf, inf}), ": expected a number or inf, got nan"},
        {"inf", number(Range::any()), ": expected a number, got inf"},
        {"-inf", number({0, inf}), ": expected a number of at least 0 or inf, got -inf"},
        {"inf", number(Range::positive()), ": expected a positive number, got inf"},
        // Beyond an end that is otherwise left unsaid.
        {"1e31", number(Range::any()), ": expected a number from -1e+30 to 1e+30, got 1e+31"},
        {"1e-31", number(Range::positive()), ": expected a number from 1e-30 to 1e+30, got 1e-31"},

        {"1.5", integer({1, 8}), ": expected an integer from 1 to 8, got 1.5"},
        {"2.0", integer({1, 8}), ": expected an integer from 1 to 8, got 2.0"},
        {"9", integer({1, 8}), ": expected an integer from 1 to 8, got 9"},
        {"0", integer({1, 1e30}), ": expected an integer of at least 1, got 0"},
        {"-1", integer(Range::positive()), ": expected a positive integer, got -1"},
        {"'7'", integer(Range::any()), ": expected an integer, got \"7\""},
        // 2^53 + 1, which a double would round to 2^53.
        {"9007199254740993", integer({0, 9007199254740992.0}),
         ": expected an integer from 0 to 9007199254740992, got 9007199254740993"},

        {"1", numbers(3, Range::any()), ": expected an array of 3, each a number, got 1"},
        {"[1, 2]", numbers(3, Range::unit()),
         ": expected an array of 3, each a number from 0 to 1, got an array of 2 values"},
        {"[]", numbers(3, Range::any()),
         ": expected an array of 3, each a number, got an empty array"},
        {"'a'", numbers(0, Range::any()), ": expected an array, each a number, got \"a\""},
        {"[1, 'a', 3]", numbers(3, Range::any()), "[1]: expected a number, got \"a\""},
        {"[1, 2, nan]", numbers(0, Range::any()), "[2]: expected a number, got nan"},
        {"[[1], 2]", numbers(2, Range::any()), "[0]: expected a number, got an array of 1 value"},
    });
}

TEST_CASE("ConfigTable: values of another type are refused") {
    const auto boolean = [](const ConfigTable& t) { t.boolean("x", true); };
    const auto text = [](const ConfigTable& t) { t.text("x"); };
    const auto textOr = [](const ConfigTable& t) { t.text("x", "fallback"); };
    const auto choice = [](const ConfigTable& t) { t.choice("x", {"pinhole", "thin-lens"}); };
    const auto choiceOfNone = [](const ConfigTable& t) { t.choice("x", {}); };
    const auto choiceOr = [](const ConfigTable& t) { t.choice("x", {"a"}, "a"); };
    const auto texts = [](const ConfigTable& t) { t.texts("x"); };
    const auto file = [](const ConfigTable& t) { t.file("x"); };
    const auto files = [](const ConfigTable& t) { t.files("x"); };
    const auto table = [](const ConfigTable& t) { t.table("x"); };
    const auto tables = [](const ConfigTable& t) { t.tables("x"); };
    const std::string longText(100, 'y');
    const std::string longAccents = std::string(59, 'y') + "\u00e9\u00e9";
    checkRefused({
        {'"' + longAccents + '"', boolean,
         ": expected true or false, got \"" + std::string(59, 'y') + "...\""},
        {"1", boolean, ": expected true or false, got 1"},
        {"'true'", boolean, ": expected true or false, got \"true\""},
        {"1", text, ": expected a string, got 1"},
        {"false", textOr, ": expected a string, got false"},
        {"[1, 2]", text, ": expected a string, got an array of 2 values"},
        {"{}", text, ": expected a string, got a table"},
        {"1979-05-27", text, ": expected a string, got a date or time"},
        {"07:32:00", text, ": expected a string, got a date or time"},
        {"1", choice, ": expected one of \"pinhole\", \"thin-lens\", got 1"},
        {"1", choiceOr, ": expected one of \"a\", got 1"},
        {"'thin_lens'", choice,
         ": expected one of \"pinhole\", \"thin-lens\", got \"thin_lens\"; did you mean "
         "'thin-lens'?"},
        {"'a'", choiceOfNone,
         ": expected one of the names defined here (there are none), got \"a\""},
        {"''", choice, ": expected one of \"pinhole\", \"thin-lens\", got \"\""},
        {"\"\\u001b\\n\"", choice,
         ": expected one of \"pinhole\", \"thin-lens\", got \"\\x1b\\n\""},
        {'"' + longText + '"', choice,
         ": expected one of \"pinhole\", \"thin-lens\", got \"" + longText.substr(0, 60) + "...\""},
        {"1", texts, ": expected a string or an array of them, got 1"},
        {"['a', 1]", texts, "[1]: expected a string, got 1"},
        {"['a', ['b']]", files, "[1]: expected a string, got an array of 1 value"},
        {"1", file, ": expected a file name in quotes, got 1"},
        {"''", file, ": expected a file name in quotes, got \"\""},
        {"\"a\\u0000b\"", file, ": expected a file name in quotes, got \"a\\x00b\""},
        {"1", table, ": expected a table, got 1"},
        {"[{}]", table, ": expected a table, got an array of 1 value"},
        {"{}", tables, ": expected an array of tables, [[t.x]], got a table"},
        {"[1]", tables, "[0]: expected a table, got 1"},
        {"[{}, 1]", tables, "[1]: expected a table, got 1"},
    });
}

TEST_CASE("ConfigTable: an error in a file that a key names ends with who named it") {
    const ScratchFolder folder("named");
    folder.write("a.obj", "");
    const Config config = Config::parse("[[mesh]]\nfile = 'a.obj'\n", folder.path() / "scene.toml");
    const ConfigTable mesh = config.root().tables("mesh")[0];
    const auto fail = [](const std::filesystem::path&) -> int {
        throw InputError("a.obj:7: no faces", ExitCode::missingFile);
    };
    CHECK(errorMessage([&] { mesh.readFile("file", fail); }) ==
          "a.obj:7: no faces (named by " + (folder.path() / "scene.toml").string() +
              ":2, mesh[0].file)");
    CHECK(errorCode([&] { mesh.readFile("file", fail); }) == ExitCode::missingFile);
    CHECK(mesh.readFile("file", [](const std::filesystem::path& file) {
        return file.filename().string();
    }) == "a.obj");
}

TEST_CASE("ConfigTable: finish names the first key that nothing has asked for") {
    const std::string text = "[camera]\nlens = 'a'\n\nfnumber = 2\nzzz = 1\n";
    const auto finishAfter = [&](const std::function<void(const ConfigTable&)>& read) {
        const ConfigTable camera = parsed(text).root().table("camera");
        read(camera);
        return errorMessage([&] { camera.finish(); });
    };
    CHECK(finishAfter([](const ConfigTable&) {}) ==
          "scene.toml:2: camera.lens: unknown key; none is known here");
    CHECK(finishAfter([](const ConfigTable& t) {
              t.text("lens");
              t.number("f_number", Range::any(), 1.0);
          }) == "scene.toml:4: camera.fnumber: unknown key; did you mean 'f_number'?");
    CHECK(finishAfter([](const ConfigTable& t) {
              for (const char* key : {"lens", "fnumber", "width"}) t.has(key);
          }) == "scene.toml:5: camera.zzz: unknown key; known are 'fnumber', 'lens', 'width'");
    CHECK(finishAfter([](const ConfigTable& t) {
              for (const char* key : {"lens", "fnumber", "zzz"}) t.has(key);
          }) == "");
}

TEST_CASE("ConfigTable: copies share what has been asked for") {
    const ConfigTable original = parsed("a = 1\nb = 2\n").root();
    const ConfigTable copy = original;
    original.has("a");
    copy.has("b");
    original.finish();
    copy.finish();
}

TEST_CASE("ConfigTable: messages in an array of tables name the entry") {
    const ConfigTable root = parsed(R"([[material]]
ior = 0
[[material]]
name = "glass"
[material.coat]
ior = 0
[[material.layer]]
ior = 0
[[material.layer]]
name = "inner"
ior = 0
)")
                                 .root();
    const std::vector<ConfigTable> materials = root.tables("material");
    REQUIRE(materials.size() == 2);
    const auto iorError = [](const ConfigTable& table) {
        return errorMessage([&] { table.number("ior", {1, 4}); });
    };
    const std::string rest = ": expected a number from 1 to 4, got 0";
    CHECK(iorError(materials[0]) == "scene.toml:2: material[0].ior" + rest);
    CHECK(iorError(materials[1].table("coat")) ==
          "scene.toml:6: material[1].coat.ior (\"glass\")" + rest);
    const std::vector<ConfigTable> layers = materials[1].tables("layer");
    CHECK(iorError(layers[0]) == "scene.toml:8: material[1].layer[0].ior (\"glass\")" + rest);
    CHECK(iorError(layers[1]) == "scene.toml:11: material[1].layer[1].ior (\"inner\")" + rest);
    CHECK(errorMessage([&] { materials[1].text("type"); }) ==
          "scene.toml:3: material[1].type (\"glass\"): missing, expected a string");
    CHECK(materials[1].where() == "scene.toml:3");
}

TEST_CASE("ConfigTable: a key that is no bare word is quoted in messages") {
    const ConfigTable t = parsed("['a.b']\n\"c\\nd\" = 1\n\"\" = 1").root().table("a.b");
    CHECK(errorMessage([&] { t.text("c\nd"); }).starts_with("scene.toml:2: \"a.b\".\"c\\nd\": "));
    CHECK(errorMessage([&] { t.text(""); }).starts_with("scene.toml:3: \"a.b\".\"\": "));
}

TEST_CASE("ConfigTable: fail speaks at the key's line, or at the table's") {
    const ConfigTable t = parsed("\n[t]\na = 1\n").root().table("t");
    CHECK(errorMessage([&] { t.fail("a", "is odd"); }) == "scene.toml:3: t.a: is odd");
    CHECK(errorMessage([&] { t.fail("b", "is odd"); }) == "scene.toml:2: t.b: is odd");
    CHECK(errorMessage([&] { t.fail("", "is odd"); }) == "scene.toml:2: t: is odd");
    CHECK(errorMessage([] { parsed("").root().fail("", "is odd"); }) == "scene.toml:1: is odd");
}

TEST_CASE("ConfigTable: failEntry speaks at the line of a text of several, with its index") {
    const ConfigTable t = parsed("a = [\"x\",\n\"y\"]\nb = \"x\"\n").root();
    CHECK(errorMessage([&] { t.failEntry("a", 1, "is odd"); }) == "scene.toml:2: a[1]: is odd");
    CHECK(errorMessage([&] { t.failEntry("b", 0, "is odd"); }) == "scene.toml:3: b: is odd");
}

TEST_CASE("ConfigTable: failNamedFile says where a file is named, or could have been") {
    const ConfigTable t = parsed("\n[t]\na = \"x.obj\"\n").root().table("t");
    const InputError error("x.obj:7: no faces", ExitCode::missingFile);
    CHECK(errorMessage([&] { t.failNamedFile("a", error); }) ==
          "x.obj:7: no faces (named by scene.toml:3, t.a)");
    CHECK(errorMessage([&] { t.failNamedFile("b", error); }) ==
          "x.obj:7: no faces (named by scene.toml:2, t.b)");
}

TEST_CASE("ConfigTable: files are found from the folder of the file that names them") {
    const ScratchFolder folder("config_files");
    folder.write("meshes/a.obj", "");
    folder.write("scenes/b.obj", "");
    const auto file = folder.write("scenes/scene.toml", R"(
one = "../meshes/a.obj"
more = ["b.obj", "../meshes/a.obj"]
lost = "c.obj"
some = ["b.obj", "c.obj"]
folder = "../meshes"
)");
    const ConfigTable t = Config::load(file).root();
    const std::filesystem::path a = folder.path() / "meshes/a.obj";
    const std::filesystem::path b = folder.path() / "scenes/b.obj";
    CHECK(t.file("one") == a);
    CHECK(t.files("one") == std::vector{a});
    CHECK(t.files("more") == std::vector{b, a});

    const std::string lost = (folder.path() / "scenes/c.obj").string() + ": no such file";
    CHECK(errorMessage([&] { t.file("lost"); }) == file.string() + ":4: lost: " + lost);
    CHECK(errorCode([&] { t.file("lost"); }) == ExitCode::missingFile);
    CHECK(errorMessage([&] { t.files("some"); }) == file.string() + ":5: some[1]: " + lost);
    CHECK(contains(errorMessage([&] { t.file("folder"); }), "meshes: is a directory"));
}

TEST_CASE("ConfigTable: reads a table that outlives its document") {
    const ConfigTable t = [] { return parsed("a.b.c = 5").root().table("a").table("b"); }();
    CHECK(t.integer("c", Range::any()) == 5);
}

}  // namespace etendue
