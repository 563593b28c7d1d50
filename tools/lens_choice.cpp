#include "tools/lens_choice.h"

#include <fmt/format.h>

#include <cmath>

#include "config/config.h"

namespace etendue {

namespace {

/// The nearest scenes/lenses in `folder` or above; empty when there is none.
std::filesystem::path lensFolderAbove(std::filesystem::path folder) {
    std::error_code error;
    for (; !folder.empty(); folder = folder.parent_path()) {
        const std::filesystem::path lenses = folder / "scenes" / "lenses";
        if (std::filesystem::is_directory(lenses, error)) return lenses;
        if (folder == folder.root_path()) break;
    }
    return {};
}

}  // namespace

std::filesystem::path findLensFile(const std::string& lens) {
    std::error_code error;
    const std::filesystem::path file = lens;
    if (std::filesystem::exists(file, error) || file.has_parent_path()) return file;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
    std::vector<std::string> names;
    for (const auto& start : {std::filesystem::current_path(error), program}) {
        const std::filesystem::path folder = lensFolderAbove(start);
        if (folder.empty()) continue;
        for (const std::string& name : {lens, lens + ".toml"})
            if (std::filesystem::is_regular_file(folder / name, error)) return folder / name;
        for (const auto& entry : std::filesystem::directory_iterator(folder, error))
            names.push_back(entry.path().stem().string());
    }
    const std::optional<std::string> nearest = nearestName(file.stem().string(), names);
    throw InputError(fmt::format("{}: no such file, and no such lens in scenes/lenses{}", lens,
                                 nearest ? "; did you mean \"" + *nearest + "\"?" : ""),
                     ExitCode::missingFile);
}

Prescription loadPrescription(const LensChoice& choice) {
    return loadPrescription(findLensFile(choice.lens), choice.zoomPosition);
}

LensSettings settingsOf(const LensChoice& choice) {
    return {choice.fNumber, {}, 1e3 * choice.focusMetres};
}

DomainRequest requestOf(const LensChoice& choice) {
    DomainRequest request;
    request.sensorSizeMm = {choice.sensorMm[0], choice.sensorMm[1]};
    request.focusDistanceMm = 1e3 * choice.focusMetres;
    request.fNumber = choice.fNumber;
    return request;
}

std::string titleOf(const Prescription& prescription) {
    const std::string& position = prescription.zoomPosition;
    return position.empty() ? prescription.name
                            : fmt::format("{}, at {}", prescription.name, position);
}

std::string describe(const LensChoice& choice, double fNumber) {
    const std::string opening =
        fmt::format("f/{:.2f}{}", fNumber, choice.fNumber ? "" : " wide open");
    const std::string focus = std::isinf(choice.focusMetres)
                                  ? std::string("focus at infinity")
                                  : fmt::format("focus at {:g} m", choice.focusMetres);
    return opening + ", " + focus;
}

}  // namespace etendue
