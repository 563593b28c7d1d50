#include "config/config.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <random>

#include "tests/config/error_message.h"

namespace etendue {
namespace {

const std::string validScene = R"(# A comment with [[[ brackets and a.b.c dots
include = ["materials.toml"]

[film]
width = 720
height = 480

[camera]
model = "thin-lens"  # "quoted"
from = [0.0, 1.5, -4e0]
note = """two
lines with "quotes" and [ brackets"""
size.x = 1.0
size.y = 2.0

[[material]]
name = 'glass'
ior = 1.5
"red.green" = { inside = [1, 2], flag = true }

[[material]]
name = "wall"
made = 1979-05-27T07:32:00Z
)";

/// Calls every getter on every value; each may refuse, by InputError alone.
void readEverything(const ConfigTable& table) {
    const std::vector<std::function<void(const std::string&)>> getters = {
        [&](const std::string& key) { table.number(key, Range::any()); },
        [&](const std::string& key) { table.integer(key, Range::positive()); },
        [&](const std::string& key) { table.boolean(key, false); },
        [&](const std::string& key) { table.text(key); },
        [&](const std::string& key) {
            table.choice(key, {"pinhole", "thin-lens"});
        },
        [&](const std::string& key) { table.numbers(key, 3, Range::unit()); },
        [&](const std::string& key) { table.texts(key); },
        [&](const std::string& key) { table.file(key); },
        [&](const std::string& key) { table.files(key); },
        [&](const std::string& key) { readEverything(table.table(key)); },
        [&](const std::string& key) {
            for (const ConfigTable& entry : table.tables(key)) readEverything(entry);
        }};
    errorMessage([&] { table.finish(); });
    for (const std::string& key : table.keys())
        for (const auto& getter : getters) errorMessage([&] { getter(key); });
    table.finish();
}

/// Any outcome but a crash or a foreign exception will do; an error names a line of the text.
void checkSurvives(const std::string& text) {
    const std::string message = errorMessage([&] { readEverything(parsed(text).root()); });
    if (message.empty()) return;
    CAPTURE(text);
    CAPTURE(message);
    REQUIRE(message.starts_with("scene.toml:"));
    const auto lineCount = 1 + std::count(text.begin(), text.end(), '\n');
    const int line = std::stoi(message.substr(std::string("scene.toml:").size()));
    CHECK(line >= 1);
    CHECK(line <= lineCount);
}

}  // namespace

TEST_CASE("Config: a text that is no document names the line and what is wrong") {
    struct BadText {
        std::string text, expected;
    };
    const std::vector<BadText> table = {
        {"a = 1\n\na = 2\n", "scene.toml:3: not valid TOML (key-value pair): cannot redefine"},
        {"[a]\nb = 1\n[a]\n", "scene.toml:3: "},
        {"a = 1\n[a]\n", "scene.toml:2: "},
        {"a = { b = 1 }\na.c = 2\n", "scene.toml:2: "},
        {"a = 1\nb =\n", "scene.toml:2: "},
        {"a = 1\nb\n", "scene.toml:2: "},
        {"a = 'open\nb = 1\n", "scene.toml:1: "},
        {"\r\na = [1,\r\n2\r\n", "scene.toml:3: "},
        // Texts that break assertions within toml++ 3.3.
        {"a = 1\n[}\nb = 2\n", "scene.toml:2: not valid TOML"},
        {"a = 1\n[[\t", "scene.toml:2: not valid TOML"},
        {"\n[\nb = 2\n", "scene.toml:2: not valid TOML"},
        {std::string("\n[\0\n", 4), "scene.toml:2: not valid TOML"},
        // Beyond ASCII where TOML has none.
        {"\n\nh\u00f6he = 1\n", "scene.toml:3: a character that only quotes may hold"},
        {"a = 1 \u00a0\n", "scene.toml:1: a character that only quotes may hold"},
        {"[\u2028\n", "scene.toml:1: a character that only quotes may hold"},
        // And where toml++ 3.3 must not meet it.
        {"a = \"\"\"b\\ \ufdbf\"\"\"", "scene.toml:1: a character beyond ASCII right behind"},
        {"a = \"\"\"b\\\n \n  \ufdbf\"\"\"", "scene.toml:3: a character beyond ASCII right behind"},
        {"a = 2\"\ufe7f\"", "scene.toml:1: a character that only quotes may hold"},
        {"a = [2'\ufe7f']", "scene.toml:1: a character that only quotes may hold"},
        {"a = 1e999", "scene.toml:1: "},
        {"a = 99999999999999999999", "scene.toml:1: "},
        {std::string("a = 1\n\0b = 2\n", 13), "scene.toml:2: "},
        // Not UTF-8: a stray byte, overlong, a surrogate, beyond U+10FFFF, cut short.
        {"a = '''\n\n\xff'''", "scene.toml:3: not valid UTF-8"},
        {"a = 1\n# \xc0\x80", "scene.toml:2: not valid UTF-8"},
        {"a = '\xe0\x80\x80'", "scene.toml:1: not valid UTF-8"},
        {"a = '\xed\xa0\x80'", "scene.toml:1: not valid UTF-8"},
        {"a = '\xf4\x90\x80\x80'", "scene.toml:1: not valid UTF-8"},
        {"a = 1 # \xe2\x82", "scene.toml:1: not valid UTF-8"},
        {"\xff\xfe[\0a\0]\0", "scene.toml:1: not valid UTF-8"},
    };
    for (const BadText& bad : table) {
        CAPTURE(bad.text);
        const std::string message = errorMessage([&] { parsed(bad.text); });
        CHECK_MESSAGE(message.starts_with(bad.expected), message);
    }
}

TEST_CASE("Config: nesting beyond 64 levels is an error and never a stack overflow") {
    struct BadText {
        std::string text, place;
    };
    const std::string dotted = repeated("a.", 1000000) + "a";
    const std::vector<BadText> table = {
        {"\na = " + repeated("[", 100000), "scene.toml:2: "},
        {"\na = " + repeated("{a=", 100000), "scene.toml:2: "},
        {"\na = " + repeated("[[{a=[", 30000), "scene.toml:2: "},
        {"\n\n" + dotted + " = 1", "scene.toml:3: "},
        {"\n\n[" + dotted + "]", "scene.toml:3: "},
        {"\n\n[[" + dotted + "]]", "scene.toml:3: "},
        {"x = { " + dotted + " = 1 }", "scene.toml:1: "},
        {"x = [1, { y = 1, " + dotted + " = 1 }]", "scene.toml:1: "},
        {repeated("\"a.b\" . ", 100000) + "a = 1", "scene.toml:1: "},
        // Behind what looks like an open string or comment but is none.
        {"x = { y = \"\\\"\", " + dotted + " = 1 }", "scene.toml:1: "},
        {"x = { y = '\\', " + dotted + " = 1 }", "scene.toml:1: "},
        {"x = { y = \"\", " + dotted + " = 1 }", "scene.toml:1: "},
        {"x = { y = \"\"\"\n\"\"\"\", " + dotted + " = 1 }", "scene.toml:2: "},
        {"x = { y = '''\n''''', " + dotted + " = 1 }", "scene.toml:2: "},
        {"x = { y = '#', " + dotted + " = 1 }", "scene.toml:1: "},
        {"# ''' \"\"\"\n" + dotted + " = 1", "scene.toml:2: "},
        // Each part is shallow enough; the sum is not.
        {"[a." + repeated("a.", 38) + "a]\n" + repeated("b.", 39) + "b = 1", "scene.toml:2: "},
        {repeated("b.", 39) + "b = " + repeated("[", 40) + repeated("]", 40), "scene.toml:1: "},
    };
    for (const BadText& bad : table) {
        CAPTURE(bad.text.substr(0, 30));
        const std::string message = errorMessage([&] { parsed(bad.text); });
        CHECK_MESSAGE(message == bad.place + "nested deeper than 64 levels", message);
    }
}

TEST_CASE("Config: brackets and dots in strings, comments and numbers are not nesting") {
    const std::string noise = repeated("[{.", 100000);
    const std::vector<std::string> texts = {
        "a = \"" + noise + "\"",
        "a = '" + noise + "'",
        "a = \"\"\"\n" + noise + "\n\\\"\"\" " + noise + "\"\"\"",
        "a = '''\n" + noise + "\n'' ' " + noise + "'''",
        "a = 1 # " + noise + "\nb = 2",
        "a = [" + repeated("1.5, ", 100000) + "]",
        "a = [" + repeated("[1.5],\n", 100000) + "]",
        "'" + noise + "' = 1",
        "a = " + repeated("[", 64) + repeated("]", 64),
        repeated("a.", 63) + "a = 1"};
    for (const std::string& text : texts) {
        CAPTURE(text.substr(0, 30));
        CHECK(errorMessage([&] { parsed(text); }) == "");
    }
    CHECK(errorMessage([] { parsed("a = " + repeated("[", 65) + repeated("]", 65)); }) != "");
    CHECK(errorMessage([] { parsed(repeated("a.", 64) + "a = 1"); }) != "");
}

TEST_CASE("Config: a text cut anywhere is read or refused at one of its lines") {
    for (std::size_t length = 0; length <= validScene.size(); ++length)
        checkSurvives(validScene.substr(0, length));
}

TEST_CASE("Config: random bytes and random changes are read or refused at one of their lines") {
    std::mt19937 random(1);
    const auto below = [&random](std::size_t count) { return random() % count; };
    for (int trial = 0; trial < 2000; ++trial) {
        std::string bytes(below(200), ' ');
        for (char& byte : bytes) byte = static_cast<char>(below(256));
        checkSurvives(bytes);
    }
    const std::string_view syntax = "[]{}.=,'\"\\#\n\r\t\0ae0";
    for (int trial = 0; trial < 1000; ++trial) {
        std::string text = validScene;
        for (std::size_t changes = 1 + below(5); changes > 0; --changes)
            text[below(text.size())] = syntax[below(syntax.size())];
        checkSurvives(text);
    }
    for (int trial = 0; trial < 2000; ++trial) {
        std::string text;
        for (std::size_t left = below(60); left > 0; --left) text += syntax[below(syntax.size())];
        checkSurvives(text);
    }
}

TEST_CASE("Config: an empty text, a mark of byte order and CRLF line ends are fine") {
    CHECK(parsed("").root().keys().empty());
    CHECK(parsed("\xef\xbb\xbf").root().keys().empty());
    CHECK(parsed("\n\n# nothing").root().keys().empty());
    CHECK(Config().root().keys().empty());

    const ConfigTable root = parsed(
                                 "\xef\xbb\xbf"
                                 "a = 1\r\n\r\n[b]\r\nc = 'x'\r\n")
                                 .root();
    CHECK(root.integer("a", Range::any()) == 1);
    CHECK(root.table("b").text("c") == "x");
    CHECK(errorMessage([&] {
              root.table("b").number("c", Range::unit());
          }).starts_with("scene.toml:4: b.c: "));
}

TEST_CASE("Config: load tells what keeps a file from being read") {
    const ScratchFolder folder("config_load");
    const std::filesystem::path missing = folder.path() / "missing.toml";
    CHECK(errorMessage([&] { Config::load(missing); }) == missing.string() + ": no such file");
    CHECK(errorCode([&] { Config::load(missing); }) == ExitCode::missingFile);
    CHECK(errorMessage([&] { Config::load(folder.path()); }) ==
          folder.path().string() + ": is a directory");
    CHECK(errorCode([&] { Config::load(folder.path()); }) == ExitCode::missingFile);
    CHECK(errorCode([] { Config::load(""); }) == ExitCode::missingFile);
    CHECK(errorCode([] { Config::load(std::string(100000, 'a')); }) == ExitCode::missingFile);

    const auto file = folder.write("scene.toml", "a = 1\nb = \n");
    CHECK(errorMessage([&] { Config::load(file); }).starts_with(file.string() + ":2: "));
    CHECK(errorCode([&] { Config::load(file); }) == ExitCode::badInput);

    const auto large = folder.write("large.toml", std::string(17'000'000, '\n'));
    CHECK(errorMessage([&] { Config::load(large); }) == large.string() + ": larger than 16 MB");
    CHECK(errorCode([&] { Config::load(large); }) == ExitCode::badInput);
}

TEST_CASE("Config: load reads what parse reads") {
    const ScratchFolder folder("config_same");
    const std::string padded = validScene + repeated("# padding past one block\n", 5000);
    const ConfigTable root = Config::load(folder.write("scene.toml", padded)).root();
    CHECK(root.keys() == parsed(padded).root().keys());
    CHECK(root.keys() == std::vector<std::string>{"include", "film", "camera", "material"});
    CHECK(root.table("camera").keys() == std::vector<std::string>{"model", "from", "note", "size"});
}

TEST_CASE("Config: merge appends arrays of tables and adds keys") {
    Config scene = Config::parse(
        "include = 'b.toml'\n[film]\nwidth = 1\n[[material]]\nname = 'a'\nior = 0\n", "a.toml");
    const ConfigTable before = scene.root();
    const Config other = Config::parse(
        "include = 'c.toml'\n\n[film]\nheight = 'x'\n[[material]]\nname = 'b'\nior = 1\n"
        "[[light]]\ntype = 's'\n[film.crop]\nleft = 3\n",
        "b.toml");
    scene.merge(other);

    const ConfigTable root = scene.root();
    CHECK(root.texts("include") == std::vector<std::string>{"b.toml"});
    CHECK(root.table("film").keys() == std::vector<std::string>{"width", "height", "crop"});
    CHECK(root.table("film").table("crop").integer("left", Range::any()) == 3);
    CHECK(root.tables("light").size() == 1);
    const std::vector<ConfigTable> materials = root.tables("material");
    REQUIRE(materials.size() == 2);
    CHECK(materials[0].text("name") == "a");
    CHECK(materials[1].text("name") == "b");

    // Every value keeps its own file and line.
    CHECK(errorMessage([&] {
              materials[0].number("ior", {1, 4});
          }) == "a.toml:6: material[0].ior (\"a\"): expected a number from 1 to 4, got 0");
    CHECK(errorMessage([&] {
              materials[1].number("ior", {2, 4});
          }) == "b.toml:7: material[1].ior (\"b\"): expected a number from 2 to 4, got 1");
    CHECK(errorMessage([&] {
              root.table("film").number("height", Range::unit());
          }).starts_with("b.toml:4: film.height: "));
    CHECK(root.table("film").where() == "a.toml:2");

    // What was taken before, and what was merged, stay as they were.
    CHECK(before.tables("material").size() == 1);
    CHECK(other.root().tables("material").size() == 1);
    CHECK(other.root().text("include") == "c.toml");
}

TEST_CASE("Config: merge refuses a key that both documents set, naming both lines") {
    struct Conflict {
        std::string a, b, expected;
    };
    const std::vector<Conflict> table = {
        {"x = 1", "\nx = 1", "b.toml:2: x: already set at a.toml:1"},
        {"[t]\n\nx = 1", "t.x = 2", "b.toml:1: t.x: already set at a.toml:3"},
        {"x = [1]", "x = [2]", "b.toml:1: x: already set at a.toml:1"},
        {"x = 1", "[x]", "b.toml:1: x: already set at a.toml:1"},
        {"[[x]]", "\n[x]", "b.toml:2: x: already set at a.toml:1"},
        {"t.include = 1", "t.include = 1", "b.toml:1: t.include: already set at a.toml:1"},
    };
    for (const Conflict& conflict : table) {
        Config scene = Config::parse(conflict.a, "a.toml");
        CHECK(errorMessage([&] { scene.merge(Config::parse(conflict.b, "b.toml")); }) ==
              conflict.expected);
    }
}

TEST_CASE("Config: merging a document with itself doubles its arrays of tables") {
    Config scene = parsed("[[mesh]]\n[[mesh]]\n");
    scene.merge(scene);
    CHECK(scene.root().tables("mesh").size() == 4);
}

}  // namespace etendue
