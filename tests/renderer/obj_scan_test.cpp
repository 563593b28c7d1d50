#include "renderer/obj_scan.h"

#include <doctest/doctest.h>

#include <string>

#include "renderer/text_lines.h"
#include "tests/config/error_message.h"

namespace etendue {
namespace {

ObjScan scanned(std::string text) { return scanObj(text, "a.obj"); }

std::string errorOf(const std::string& text) {
    return errorMessage([&] { scanned(text); });
}

const std::string squareCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";  // lines 1 to 4
const std::string cornersAndFace = squareCorners + "f 1 2 3 4\n";

struct BadText {
    std::string text;
    std::string message;  // or its beginning
};

void checkMessages(const std::vector<BadText>& table) {
    for (const BadText& bad : table) {
        CAPTURE(bad.text.substr(0, 200));
        CHECK(errorOf(bad.text).substr(0, bad.message.size()) == bad.message);
    }
}

}  // namespace

TEST_CASE("scanObj: counts what there is") {
    const ObjScan scan =
        scanned(squareCorners + "vn 0 0 1\nvt 0.5\nvt 0 1\nf 1 2 3 4\nf 1/1/1 2//1 3/2\n");
    CHECK(scan.positions == 4);
    CHECK(scan.normals == 1);
    CHECK(scan.textureCoordinates == 2);
    CHECK(scan.faces == 2);
    CHECK(scan.corners == 7);
    CHECK(scan.notes.empty());
}

TEST_CASE("scanObj: takes numbers as exporters write them") {
    for (const std::string number :
         {"0", "-0", "+1", "1.", ".5", "-.5", "+0.5", "1e3", "1E+003", "1.5e-010", "2.e1", "1e18",
          "-1e18", "1e-300", "0.00000000000000000000000000000000000000000000000001"}) {
        CAPTURE(number);
        CHECK(errorOf("v 0 0 " + number + "\nv 0 1 0\nv 1 0 0\nf 1 2 3\n") == "");
    }
}

TEST_CASE("scanObj: refuses numbers that are none, with the line") {
    for (const std::string word :
         {"nan",     "inf",    "-inf",  "NaN",   "abc",      "1,5",     "0x10",  "1e",
          "1e+",     ".",      "-",     "+",     "--1",      "+-1",     "1.2.3", "1d5",
          "-1.#IND", "3.1+e2", "1_000", "1e400", "infinity", "\xC2\xBD"}) {
        CAPTURE(word);
        const std::string message = "a.obj:2: expected a number, found \"" + word + "\"";
        CHECK(errorOf("\nv 0 " + word + " 0\n") == message);
        CHECK(errorOf("\nvn 0 0 " + word + "\n") == message);
        CHECK(errorOf("\nvt " + word + "\n") == message);
        CHECK(errorOf("\nv 0 0 0 1 1 " + word + "\n") == message);
    }
}

TEST_CASE("scanObj: refuses bad statements in one message with the line") {
    const std::string tooLarge = "a.obj:1: expected a number within ±1e18, found ";
    const std::string badCorner =
        "a.obj:5: expected a corner such as 1, 1/2, 1//3 or 1/2/3, found ";
    checkMessages({
        {"v 0 0 1.0001e18\n", tooLarge + "\"1.0001e18\""},
        {"v -1e19 0 0\n", tooLarge + "\"-1e19\""},
        {"vn 0 0 1e300\n", tooLarge + "\"1e300\""},
        {"v\n", "a.obj:1: v: expected 3 coordinates, with a weight or a colour or both, found 0"},
        {"v 1 2\n",
         "a.obj:1: v: expected 3 coordinates, with a weight or a colour or both, found 2"},
        {"v 1 2 3 4 5\n", "a.obj:1: v: expected 3 coordinates"},
        {"v 1 2 3 4 5 6 7 8\n", "a.obj:1: v: expected 3 coordinates"},
        {"vn 1 2\n", "a.obj:1: vn: expected 3 coordinates, found 2"},
        {"vn 1 2 3 4\n", "a.obj:1: vn: expected 3 coordinates, found 4"},
        {"vt\n", "a.obj:1: vt: expected 1 to 3 coordinates, found 0"},
        {"vt 1 2 3 4\n", "a.obj:1: vt: expected 1 to 3 coordinates, found 4"},
        {squareCorners + "f\n", "a.obj:5: f: expected 3 to 4096 corners, found 0"},
        {squareCorners + "f 1 2\n", "a.obj:5: f: expected 3 to 4096 corners, found 2"},
        {squareCorners + "f" + repeated(" 1 2 3", 1366),
         "a.obj:5: f: expected 3 to 4096 corners, found 4098"},
        {squareCorners + "f 1 2 0\n", "a.obj:5: index 0 in \"0\", they count from 1"},
        {squareCorners + "f 1 2 3/0\n", "a.obj:5: index 0 in \"3/0\", they count from 1"},
        {squareCorners + "f 1 2 3//-0\n", "a.obj:5: index 0 in \"3//-0\", they count from 1"},
        {squareCorners + "f 1 2 5\n", "a.obj:5: vertex index 5 of 4"},
        {squareCorners + "f 1 2 3\nf 1 2 9\nf 1 2 5\n", "a.obj:6: vertex index 9 of 4"},
        {squareCorners + "f 1 2 -5\n", "a.obj:5: vertex index -5 of 4"},
        {"v 0 0 0\nf -1 -2 -3\n" + squareCorners, "a.obj:2: vertex index -2 of 1"},
        {squareCorners + "f 1 2 1000000000\n", "a.obj:5: vertex index 1000000000 of 4"},
        {squareCorners + "f 1 2 4294967297\n", "a.obj:5: vertex index 4294967297 of 4"},
        {squareCorners + "f 1 2 100000000000000000000\n",
         "a.obj:5: vertex index 100000000000000000000 of 4"},
        {squareCorners + "f 1 2 -100000000000000000000\n",
         "a.obj:5: vertex index -100000000000000000000 of 4"},
        {squareCorners + "f 1 2 1e20\n", badCorner + "\"1e20\""},
        {squareCorners + "f 1/1 2/1 3/1\n", "a.obj:5: texture coordinate index 1 of 0"},
        {squareCorners + "f 1//1 2//1 3//1\n", "a.obj:5: normal index 1 of 0"},
        {squareCorners + "f 1//-1 2 3\n", "a.obj:5: normal index -1 of 0"},
        {squareCorners + "f 1 2 x\n", badCorner + "\"x\""},
        {squareCorners + "f 1 2 3.0\n", badCorner + "\"3.0\""},
        {squareCorners + "f 1 2 +3\n", badCorner + "\"+3\""},
        {squareCorners + "f 1 2 3/1/1/1\n", badCorner + "\"3/1/1/1\""},
        {squareCorners + "f 1 2 /1\n", badCorner + "\"/1\""},
        {squareCorners + "f 1 2 3/-\n", badCorner + "\"3/-\""},
        {squareCorners + "f 1 2 3\\", badCorner + "\"3\\\""},
        {squareCorners + "s x\nf 1 2 3\n",
         "a.obj:5: s: expected a group number or off, found \"x\""},
        {squareCorners + "s -1\nf 1 2 3\n",
         "a.obj:5: s: expected a group number or off, found \"-1\""},
        {"", "a.obj: no faces (f)"},
        {"\n\n# nothing\n", "a.obj: no faces (f)"},
        {squareCorners + "l 1 2 3\np 1\n", "a.obj: no faces (f)"},
        {"v 0 0 0 " + std::string(1'000'001, ' '), "a.obj:1: a line longer than 1000000 bytes"},
    });
    std::string manyMaterials = cornersAndFace;
    for (int i = 0; i < 65535; ++i) manyMaterials += "usemtl m" + std::to_string(i) + "\n";
    CHECK(errorOf(manyMaterials) == "a.obj:65540: more than 65535 materials");
}

TEST_CASE("scanObj: control characters do not reach the terminal through messages") {
    CHECK(errorOf("v 0 0 \x1b[31m\n") == "a.obj:1: expected a number, found \"\\x1b[31m\"");
}

TEST_CASE("scanObj: an index may name what comes later in the file") {
    CHECK(errorOf("f 1/1/1 2/1/1 3/1/1\n" + squareCorners + "vn 0 0 1\nvt 0 0\n") == "");
}

TEST_CASE("scanObj: every kind of line end, continued lines and comments, with the right lines") {
    for (const std::string end : {"\n", "\r\n", "\r"}) {
        CAPTURE(end);
        const std::string text = "# head \\" + end + end + "v 0 0 \\" + end + " 0 # origin" + end +
                                 "v 1 0 0" + end + "\tv\t0 1 0" + end + "f 1 \\" + end + "2 \\" +
                                 end + "3#no" + end;
        CHECK(errorOf(text) ==
              "a.obj:7: expected a corner such as 1, 1/2, 1//3 or 1/2/3, found \"3#no\"");
        const ObjScan scan = scanned(text.substr(0, text.find("#no")));
        CHECK(scan.positions == 3);
        CHECK(scan.corners == 3);
    }
}

TEST_CASE("scanObj: a line joined from very many takes no longer than others") {
    // Looking back to its start at every joint would take the square of its length.
    const std::string joints = repeated("\\\n", 480'000);
    CHECK(errorOf(squareCorners + "f 1 2 " + joints + "3\n") == "");
    CHECK(errorOf(squareCorners + "f 1 2 " + joints + "3\nx\nf 1\n") ==
          "a.obj:480007: f: expected 3 to 4096 corners, found 1");
}

TEST_CASE("scanObj: leaves a text in which joined lines and trailing comments are blank") {
    std::string text = cornersAndFace + "f 1 2 \\\r\n3 # one \\\nf 1 2 3 4\n";
    scanObj(text, "a.obj");
    CHECK(text == cornersAndFace + "f 1 2    3        " + "\nf 1 2 3 4\n");
}

TEST_CASE("scanObj: material names keep their blanks, and appear once each, in order") {
    const ObjScan scan = scanned(squareCorners +
                                 "f 1 2 3\nusemtl red  and blue \nf 1 2 3\nusemtl\nf 1 2 3\n"
                                 "usemtl unused\nusemtl red  and blue\nf 1 2 3\nf 1 2 3\n");
    CHECK(scan.materialNames == std::vector<std::string>{"", "red  and blue", "unused"});
    REQUIRE(scan.materials.size() == 4);
    const std::uint32_t expected[4][2] = {{0, 0}, {1, 1}, {2, 0}, {3, 1}};
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(scan.materials[i].firstFace == expected[i][0]);
        CHECK(scan.materials[i].value == expected[i][1]);
    }
    CHECK(scanned(squareCorners + "usemtl a\nf 1 2 3\n").materialNames ==
          std::vector<std::string>{"a"});
}

TEST_CASE("scanObj: smoothing groups and libraries are reported where they stand") {
    const ObjScan scan =
        scanned(squareCorners + "mtllib a b.mtl\ns 3\nf 1 2 3\ns off\ns on\nf 1 2 3\nmtllib c.mtl");
    REQUIRE(scan.smoothing.size() == 2);
    CHECK(scan.smoothing[0].value == 3);
    CHECK(scan.smoothing[1].firstFace == 1);
    CHECK(scan.smoothing[1].value == 1);
    REQUIRE(scan.libraries.size() == 2);
    CHECK(scan.libraries[0].names == "a b.mtl");
    CHECK(scan.libraries[0].line == 5);
    CHECK(scan.libraries[1].line == 11);
}

TEST_CASE("scanObj: says what it ignores, once per kind") {
    const ObjScan scan = scanned(
        "o x\ng y\nv 0 0 0 1 1 1\nv 1 0 0 0 0 0\nv 0 1 0 1\nl 1 2\nl 2 3\np 1\n"
        "curv 0 1 1 2\nvp 1 2\nhello world\nhello\nf 1 2 3\n");
    CHECK(scan.notes == std::vector<std::string>{
                            "a.obj:9: 1 free-form curves and surfaces (curv, curv2, surf) ignored",
                            "a.obj:6: 2 lines (l) ignored", "a.obj:8: 1 points (p) ignored",
                            "a.obj:11: 2 statements \"hello\" ignored",
                            "a.obj:3: 2 vertex colours ignored"});
    std::string noise = cornersAndFace;
    for (int i = 0; i < 1000; ++i) noise += "x" + std::to_string(i) + "\n";
    CHECK(scanned(noise).notes.size() <= 21);
}

}  // namespace etendue
