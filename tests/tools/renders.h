// Renders that stop, go on and add up, as commands in a folder of their own.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "renderer/image_io.h"
#include "tests/support/temporary_folder.h"
#include "tests/tools/command_outcome.h"
#include "tests/tools/every_material_scene.h"

namespace etendue {

/// A folder with a scene of every material, and commands on it.
class Renders {
public:
    Renders() : scene_(folder_.write("s.toml", everyMaterialScene)) {}

    std::string renderLine(const std::string& output, const std::string& options) const {
        return "render " + scene_.string() + " -o " + path(output).string() +
               " --quiet --size 40,24 " + options;
    }
    Outcome render(const std::string& output, const std::string& options) const {
        return run(renderLine(output, options));
    }
    std::string mergeLine(const std::vector<std::string>& parts, const std::string& output,
                          const std::string& options = "") const {
        std::string line = "merge";
        for (const std::string& part : parts) line += ' ' + path(part).string();
        return line + " -o " + path(output).string() + ' ' + options;
    }
    Outcome merge(const std::vector<std::string>& parts, const std::string& output,
                  const std::string& options = "") const {
        return run(mergeLine(parts, output, options));
    }
    std::vector<float> pixels(const std::string& picture) const {
        return readExrChannels(path(picture), {"R", "G", "B"})->pixels;
    }
    std::filesystem::path path(const std::string& name) const { return folder_ / name; }
    std::vector<std::string> names() const { return folder_.names(); }

private:
    TemporaryFolder folder_;
    std::filesystem::path scene_;
};

}  // namespace etendue
