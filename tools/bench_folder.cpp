#include "tools/bench_folder.h"

#include <cctype>
#include <vector>

namespace etendue {

namespace {

/// A name that any file system takes, of several names.
std::string fileName(const std::vector<std::string>& parts) {
    std::string name;
    for (const std::string& part : parts) {
        if (part.empty()) continue;
        if (!name.empty()) name += '.';
        for (const char c : part)
            name += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '+' ? c : '_';
    }
    return name;
}

}  // namespace

std::filesystem::path BenchFolder::picture(const BenchConfiguration& c, int seed) const {
    return path / "pictures" /
           (fileName({c.scene, c.camera, c.variant, c.estimator, std::to_string(seed)}) + ".exr");
}

std::filesystem::path BenchFolder::referencePicture(const std::string& scene,
                                                    const std::string& camera) const {
    return path / "pictures" / (fileName({scene, camera, "reference"}) + ".exr");
}

std::filesystem::path BenchFolder::techniques(const std::string& scene,
                                              const std::string& camera) const {
    return path / "pictures" / (fileName({scene, camera, "techniques"}) + ".exr");
}

}  // namespace etendue
