#include "renderer/mtl_reader.h"

#include <doctest/doctest.h>

#include <string>

#include "tests/config/error_message.h"
#include "tests/support/temporary_folder.h"

namespace etendue {
namespace {

struct MtlResult {
    std::vector<ObjMaterial> materials;
    std::vector<std::string> notes;
};

/// The file is FOLDER/sub/m.mtl.
class MtlFixture {
public:
    MtlFixture() {
        std::filesystem::create_directory(folder_ / "sub");
        for (const char* image : {"a.png", "sub/b.png", "sub/with space.png", "sub/1"})
            writeFile(folder_ / image, "");
    }

    MtlResult read(const std::string& text, const std::set<std::string>& wanted = {"m"}) const {
        writeFile(file(), text);
        MtlResult result;
        result.materials = readMtl(file(), wanted, result.notes);
        return result;
    }
    ObjMaterial readOne(const std::string& statements) const {
        const MtlResult result = read("newmtl m\n" + statements);
        REQUIRE(result.materials.size() == 1);
        return result.materials[0];
    }
    /// Without the file's name.
    std::string errorOf(const std::string& text) const {
        const std::string message = errorMessage([&] { read(text); });
        return message.substr(std::min(message.size(), file().string().size()));
    }
    std::filesystem::path file() const { return folder_ / "sub/m.mtl"; }
    std::filesystem::path path(const std::string& name) const { return folder_ / name; }

private:
    TemporaryFolder folder_;
};

}  // namespace

TEST_CASE("readMtl: reads what a material has, and says what it has not") {
    const MtlFixture fixture;
    const ObjMaterial full = fixture.readOne(
        "Ns 96.5\nKd 0.1 0.2 0.3\nKs 0.4\nKe 5 6 7\nNi 1.45\nd 0.25\nillum 7\nPr 0.125\nPm 1\n");
    CHECK(full.name == "m");
    CHECK(full.diffuse == Vec3{0.1f, 0.2f, 0.3f});
    CHECK(full.specular == Vec3{0.4f, 0.4f, 0.4f});
    CHECK(full.emission == Vec3{5, 6, 7});
    CHECK(full.shininess == 96.5f);
    CHECK(full.indexOfRefraction == 1.45f);
    CHECK(full.opacity == 0.25f);
    CHECK(full.illuminationModel == 7);
    CHECK(full.roughness == 0.125f);
    CHECK(full.metallic == 1.0f);

    const ObjMaterial empty = fixture.readOne("");
    CHECK(empty.diffuse == Vec3{0.5f, 0.5f, 0.5f});
    CHECK(empty.opacity == 1.0f);
    CHECK(!empty.roughness);
    CHECK(!empty.metallic);
    CHECK(empty.diffuseMap.empty());
}

TEST_CASE("readMtl: d holds against Tr, wherever it stands") {
    const MtlFixture fixture;
    CHECK(fixture.readOne("Tr 0.25\n").opacity == 0.75f);
    CHECK(fixture.readOne("d 0.5\nTr 0.25\n").opacity == 0.5f);
    CHECK(fixture.readOne("Tr 0.25\nd 0.5\n").opacity == 0.5f);
    CHECK(contains(fixture.read("newmtl m\nd 0.5\nTr 0.25\n").notes.at(0), ":3: Tr ignored"));
    CHECK(fixture.read("newmtl m\nd 0.75\nTr 0.25\n").notes.empty());
}

TEST_CASE("readMtl: names may be empty or hold blanks, the first definition holds") {
    const MtlFixture fixture;
    const MtlResult result = fixture.read(
        "newmtl \nKd 0.8 0.8 0.8\nnewmtl  two  words \nKd 0.1\nnewmtl other\nnewmtl two  words\nKd "
        "1\n",
        {"", "two  words"});
    REQUIRE(result.materials.size() == 2);
    CHECK(result.materials[0].name == "");
    CHECK(result.materials[0].diffuse == Vec3{0.8f, 0.8f, 0.8f});
    CHECK(result.materials[1].name == "two  words");
    CHECK(result.materials[1].diffuse == Vec3{0.1f, 0.1f, 0.1f});
    REQUIRE(result.notes.size() == 1);
    CHECK(contains(result.notes[0], ":6: an earlier definition of \"two  words\" holds"));
}

TEST_CASE("readMtl: finds images as written, on Windows too, or by their bare name") {
    const MtlFixture fixture;
    const auto mapOf = [&](const std::string& name) {
        return fixture.readOne("map_Kd " + name + "\n").diffuseMap;
    };
    CHECK(mapOf("b.png") == fixture.path("sub/b.png"));
    CHECK(mapOf("./b.png") == fixture.path("sub/b.png"));
    CHECK(mapOf("../a.png") == fixture.path("a.png"));
    CHECK(mapOf("..\\a.png") == fixture.path("a.png"));
    CHECK(mapOf("with space.png \r") == fixture.path("sub/with space.png"));
    CHECK(mapOf(fixture.path("a.png").string()) == fixture.path("a.png"));
    const MtlResult result = fixture.read("newmtl m\nmap_d C:\\some where\\b.png\n");
    CHECK(result.materials.at(0).opacityMap == fixture.path("sub/b.png"));
    CHECK(contains(result.notes.at(0), ":2: no file \"C:\\some where\\b.png\", taking "));
}

TEST_CASE("readMtl: a missing image is an error where a material is wanted, and only there") {
    const MtlFixture fixture;
    const std::string text = "newmtl x\nmap_Kd gone.png\nnewmtl m\nKd 1\n";
    CHECK(fixture.read(text).materials.size() == 1);
    const auto read = [&] { fixture.read(text, {"x"}); };
    CHECK(errorMessage(read) == fixture.file().string() + ":2: no file \"gone.png\" in " +
                                    fixture.file().parent_path().string());
    CHECK(errorCode(read) == ExitCode::missingFile);
    // A folder is no image.
    CHECK(contains(fixture.errorOf("newmtl m\nmap_Kd ../sub\n"), ":2: no file \"../sub\""));
}

TEST_CASE("readMtl: skips the options of images with a note") {
    const MtlFixture fixture;
    for (const std::string options :
         {"-s 1 1 1", "-s 2", "-o 0.5 0.5", "-clamp on", "-blendu off -blendv off", "-mm 0 1",
          "-bm 0.3 -s 1 2 -texres 512", "-imfchan r", "-cc on\t-t 0 0 0", "-type sphere"}) {
        CAPTURE(options);
        const MtlResult result = fixture.read("newmtl m\nmap_Kd " + options + " b.png\n");
        CHECK(result.materials.at(0).diffuseMap == fixture.path("sub/b.png"));
        REQUIRE(result.notes.size() == 1);
        CHECK(
            contains(result.notes[0], ": ignored map_Kd " + options.substr(0, options.find(' '))));
    }
    CHECK(fixture.readOne("map_Kd -s 1 1 1\n").diffuseMap == fixture.path("sub/1"));
}

TEST_CASE("readMtl: an image without Kd counts in full") {
    const MtlFixture fixture;
    CHECK(fixture.readOne("map_Kd b.png\n").diffuse == Vec3{1, 1, 1});
    CHECK(fixture.readOne("Kd 0.5 0.25 0\nmap_Kd b.png\n").diffuse == Vec3{0.5f, 0.25f, 0});
    // Kd of one material says nothing about the next.
    const MtlResult result =
        fixture.read("newmtl x\nKd 0.1\nnewmtl m\nmap_Kd b.png\nnewmtl y\n", {"x", "m", "y"});
    CHECK(result.materials.at(1).diffuse == Vec3{1, 1, 1});
    CHECK(result.materials.at(2).diffuse == Vec3{0.5f, 0.5f, 0.5f});
    CHECK(result.materials.at(2).diffuseMap.empty());
}

TEST_CASE("readMtl: refuses bad values in one message with file and line") {
    const MtlFixture fixture;
    const struct {
        const char* text;
        const char* message;
    } table[] = {
        {"newmtl m\nKd red\n", ":2: Kd: expected a number from 0 to 1e18, found \"red\""},
        {"newmtl m\nKd nan 0 0\n", ":2: Kd: expected a number from 0 to 1e18, found \"nan\""},
        {"newmtl m\nKd 0.5 0.5\n", ":2: Kd: expected a number from 0 to 1e18, found \"\""},
        {"newmtl m\nKd\n", ":2: Kd: expected a number from 0 to 1e18, found \"\""},
        {"newmtl m\nKd 1 1 1 1\n", ":2: Kd: unexpected \"1\""},
        {"newmtl m\nKd 0 -0.5 0\n", ":2: Kd: expected a number from 0 to 1e18, found \"-0.5\""},
        {"newmtl m\nKs spectral x.rfl\n",
         ":2: Ks: expected a number from 0 to 1e18, found \"spectral\""},
        {"newmtl m\nKe inf\n", ":2: Ke: expected a number from 0 to 1e18, found \"inf\""},
        {"newmtl m\nNs 1,5\n", ":2: Ns: expected a number from 0 to 1e18, found \"1,5\""},
        {"newmtl m\nNs -1\n", ":2: Ns: expected a number from 0 to 1e18, found \"-1\""},
        {"newmtl m\nNi 1000\n", ":2: Ni: expected a number from 0 to 100, found \"1000\""},
        {"newmtl m\nd -0.1\n", ":2: d: expected a number from 0 to 1e18, found \"-0.1\""},
        {"newmtl m\nTr x\n", ":2: Tr: expected a number from 0 to 1e18, found \"x\""},
        {"newmtl m\nillum 11\n", ":2: illum: expected a number from 0 to 10, found \"11\""},
        {"newmtl m\nillum 1.5\n", ":2: illum: expected a whole number"},
        {"newmtl m\nPr 1e400\n", ":2: Pr: expected a number from 0 to 1e18, found \"1e400\""},
        {"newmtl m\nPm\n", ":2: Pm: expected a number from 0 to 1e18, found \"\""},
        {"newmtl unwanted\n\nKd x\n", ":3: Kd: expected a number from 0 to 1e18, found \"x\""},
        {"Kd 1 1 1\nnewmtl m\n", ":1: Kd: before the first newmtl"},
        {"\xFF\xFEn\0e\0", ": UTF-16 text, expected UTF-8"},
    };
    for (const auto& bad : table) {
        CAPTURE(bad.text);
        CHECK(fixture.errorOf(bad.text) == bad.message);
    }
    const std::string zero("newmtl m\n\0", 10);
    CHECK(fixture.errorOf(zero) == ": not a text file, byte 9 is 0");
    std::vector<std::string> notes;
    CHECK(errorMessage([&] { readMtl(fixture.path("none.mtl"), {}, notes); }) ==
          fixture.path("none.mtl").string() + ": no such file");
}

TEST_CASE("readMtl: notes what it ignores or corrects") {
    const MtlFixture fixture;
    const MtlResult result = fixture.read(
        "newmtl m # not a comment\nnewmtl m\nKa 1 1 1\nKd 0.5 # half\nTf 1 1 1\nKa 0 0 0\nmap_Bump "
        "x.png\n"
        "Ni 0\nd 1.5\nmap_Kd\n");
    CHECK(result.materials.at(0).opacity == 1.0f);
    CHECK(result.materials.at(0).indexOfRefraction == 1.5f);
    const std::string file = fixture.file().string();
    CHECK(result.notes ==
          std::vector<std::string>{file + ":8: Ni 0 ignored", file + ":9: d above 1 taken as 1",
                                   file + ":10: map_Kd names no file",
                                   file + ": ignored \"Ka\", \"Tf\", \"map_Bump\""});
}

}  // namespace etendue
