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
bool isAnyAbove(const ConfigTable& table, const char* key, double most) {
    try {
        for (const double number : table.numbers(key, 0, Range::any()))
            if (number > most) return true;
    } catch (const InputError&) {
    }
    return false;
}

/// Meshes of millions of triangles are legal, as far as the memory goes, and take as long as they
/// take.
bool isLarge(const ConfigTable& root) {
    const std::vector<ConfigTable> meshes = root.tables("mesh");
    for (const ConfigTable& mesh : meshes)
        if (isAbove(mesh, "segments", 64) || isAbove(mesh, "minor_segments", 64) ||
            isAbove(mesh, "subdivisions", 32))
            return true;
    return meshes.size() > 32;
}

/// Sums of light and exposures that a float may not hold.
bool isBright(const ConfigTable& root) {
    constexpr double most = 1e9;
    for (const ConfigTable& material : root.tables("material"))
        if (isAnyAbove(material, "emission", most)) return true;
    for (const ConfigTable& light : root.tables("light"))
        for (const char* key : {"radiance", "intensity", "irradiance"})
            if (isAnyAbove(light, key, most) || isAbove(light, "scale", most)) return true;
    return isAbove(root.table("camera"), "exposure", 30.0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const FuzzFolder folder = folderOfScenes();
    const std::string text(textOf(data, size));
    if (namesAnotherFolder(text)) return 0;
    const std::filesystem::path file = folder.write("scene.toml", text);
    try {
        const ConfigTable root = Config::load(file).root();
        if (!isLarge(root)) checkRender(file, isBright(root));
    } catch (const InputError&) {
    }
    return 0;
}
