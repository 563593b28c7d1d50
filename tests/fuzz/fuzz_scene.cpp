// Scene files: what loads renders without a bad sample.
//
// The files that a scene may name: t.png, sky.exr, m.obj with m.mtl, lens.toml, part.toml (an
// include) and scene.toml, which is itself.
#include "config/config.h"
#include "tests/fuzz/scene_checks.h"

using namespace etendue;

namespace {

constexpr const char* model =
    "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
    "usemtl red\nf 1/1 2/2 3/3\n";
constexpr const char* modelMaterials = "newmtl red\nKd 0.8 0.1 0.1\nmap_Kd t.png\n";
constexpr const char* part = "[[material]]\nname = \"part\"\ncolor = [0.1, 0.2, 0.3]\n";

FuzzFolder folderOfScenes() {
    const FuzzFolder folder = folderWithImages();
    folder.write("m.obj", model);
    folder.write("m.mtl", modelMaterials);
    folder.write("part.toml", part);
    const std::filesystem::path here = std::filesystem::path(__FILE__).parent_path();
    std::filesystem::copy_file(here / "../../scenes/lenses/tessar-100mm.toml", folder / "lens.toml",
                               std::filesystem::copy_options::overwrite_existing);
    return folder;
}

/// Names stay in the folder, or the fuzzer would read what is elsewhere: no slash, and none in
/// disguise.
bool namesAnotherFolder(std::string_view text) {
    return text.find('/') != text.npos || text.find("\\u") != text.npos ||
           text.find("\\U") != text.npos;
}

bool isAbove(const ConfigTable& table, const char* key, double most) {
    try {
        return table.has(key) && table.number(key, Range::any()) > most;
    } catch (const InputError&) {
        return false;
    }
}

/// Meshes of millions of triangles are legal, as far as the memory goes, and take as long as they
/// take.
bool isLarge(const std::string& text) {
    try {
        double triangles = 0;
        for (const ConfigTable& mesh : Config::parse(text, "scene.toml").root().tables("mesh")) {
            for (const char* key : {"segments", "minor_segments"})
                if (isAbove(mesh, key, 64)) return true;
            if (isAbove(mesh, "subdivisions", 32)) return true;
            triangles += 4096;
        }
        return triangles > 32 * 4096;
    } catch (const InputError&) {
        return false;
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const FuzzFolder folder = folderOfScenes();
    const std::string text(textOf(data, size));
    if (namesAnotherFolder(text) || isLarge(text)) return 0;
    try {
        checkRender(folder.write("scene.toml", text));
    } catch (const InputError&) {
    }
    return 0;
}
