#include "tools/farm_folder.h"

#include <fmt/format.h>

#include <optional>

#include "config/config.h"
#include "renderer/part_file.h"
#include "tools/json.h"
#include "tools/version.h"
#include "tools/write_file.h"

namespace etendue {

namespace {

/// All that the samples depend on, as words.
struct Setting {
    const char* key;
    std::vector<std::string> values;
};

std::vector<Setting> settingsOf(const FarmJob& job, const std::string& sceneHash) {
    std::vector<std::string> size;
    for (const int n : job.size) size.push_back(std::to_string(n));
    return {{"program", {fmt::format("etendue {}", version)}},
            {"scene", {job.scene.string()}},
            {"camera", {job.camera.string()}},
            {"size", size},
            {"set", job.overrides},
            {"seed", {std::to_string(job.seed)}},
            {"samples", {std::to_string(job.plan.samples)}},
            {"task_samples", {std::to_string(job.plan.taskSamples)}},
            {"scene_hash", {sceneHash}}};
}

/// In TOML; a string of JSON is one of TOML's, too.
std::string listText(const std::vector<std::string>& values) {
    if (values.size() == 1) return Json(values.front()).text();
    std::string text;
    for (const std::string& value : values) text += (text.empty() ? "" : ", ") + Json(value).text();
    return "[" + text + "]";
}

std::string settingsText(const std::vector<Setting>& settings) {
    std::string text = "# What the parts in this folder are of. Written by etendue farm.\n";
    for (const Setting& setting : settings)
        text += fmt::format("{} = {}\n", setting.key, listText(setting.values));
    return text;
}

void checkSettings(const std::filesystem::path& file, const std::vector<Setting>& settings) {
    const Config config = Config::load(file);
    const ConfigTable root = config.root();
    for (const Setting& setting : settings) {
        const std::vector<std::string> known = root.texts(setting.key);
        if (known == setting.values) continue;
        root.fail(setting.key, fmt::format("the parts here are of {}, not of {}; take another "
                                           "folder for other pictures",
                                           listText(known), listText(setting.values)));
    }
    root.finish();
}

bool isWhole(const std::filesystem::path& part) {
    try {
        readPartInfo(part);
        return true;
    } catch (const InputError&) {
        return false;
    }
}

/// What a part holds, if it is there and whole. From a damaged one no render can go on; where the
/// part before it is whole, a render goes on from that by itself.
std::optional<SampleRanges> rangesIn(const std::filesystem::path& part,
                                     const std::function<void(const std::string&)>& notice) {
    if (!std::filesystem::exists(part)) return {};
    try {
        return readPartInfo(part).ranges;
    } catch (const InputError& error) {
        notice(error.what());
    }
    if (!isWhole(previousPart(part))) {
        const std::string aside = part.string() + ".damaged";
        std::filesystem::rename(part, aside);
        notice(fmt::format("it is now {}", aside));
    }
    return {};
}

}  // namespace

void claimFarmFolder(const FarmJob& job, const std::string& sceneHash) {
    const std::filesystem::path file = job.folder / "farm.toml";
    const std::vector<Setting> settings = settingsOf(job, sceneHash);
    if (std::filesystem::exists(file)) checkSettings(file, settings);
    for (const auto& folder : {job.parts(), job.logs(), job.picture.parent_path()})
        makeFolder(folder);
    if (!std::filesystem::exists(file)) writeWholeFile(file, settingsText(settings));
}

std::vector<std::uint32_t> missingTasks(const FarmJob& job,
                                        const std::function<void(const std::string&)>& notice) {
    std::vector<std::uint32_t> missing;
    for (std::uint32_t task = 0; task < job.plan.taskCount(); ++task) {
        const std::filesystem::path part = job.parts() / job.plan.partOf(task);
        const std::optional<SampleRanges> ranges = rangesIn(part, notice);
        if (!ranges || !ranges->holes(job.plan.rangeOf(task)).empty()) missing.push_back(task);
    }
    return missing;
}

}  // namespace etendue
