#include "tools/write_file.h"

#include <fmt/format.h>

#include <cctype>
#include <map>
#include <system_error>

#include "config/config.h"
#include "renderer/atomic_file.h"

namespace etendue {

namespace {

void checkPlace(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (!std::filesystem::is_directory(folder, error))
        throw InputError(fmt::format("{}: no such folder", folder.string()), ExitCode::missingFile);
    if (std::filesystem::is_directory(file, error))
        throw InputError(fmt::format("{}: is a folder, not a file to write", file.string()));
}

void checkExtension(const std::filesystem::path& file, const std::string& expected) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (!extension.empty() && extension != expected)
        throw InputError(
            fmt::format("{}: this picture is written as {}", file.string(), expected.substr(1)),
            ExitCode::usage);
}

/// One for all paths of a file, whether or not it is there; empty where nothing can be lost.
std::filesystem::path placeOf(const std::filesystem::path& file) {
    if (file.empty() || isWrittenDirectly(file)) return {};
    std::error_code error;
    const std::filesystem::path absolute = std::filesystem::absolute(file);
    const std::filesystem::path place = std::filesystem::weakly_canonical(absolute, error);
    return error ? absolute : place;
}

}  // namespace

void writeWholeFile(const std::filesystem::path& file, std::string_view text) {
    checkPlace(file);
    writeFileAtomically(file, text.data(), text.size());
}

void checkWritable(const std::filesystem::path& file, const std::string& extension) {
    if (!file.empty()) checkExtension(file, extension);
    checkWritable(file);
}

void checkWritable(const std::filesystem::path& file) {
    if (!file.empty()) checkPlace(file);
}

void checkFolder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::path place;
    for (const std::filesystem::path& name : folder) {
        place /= name;
        if (std::filesystem::exists(place, error) && !std::filesystem::is_directory(place, error))
            throw InputError(fmt::format("{}: is a file, expected a folder", place.string()));
    }
}

void makeFolder(const std::filesystem::path& folder) {
    checkFolder(folder);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw std::system_error(error, folder.string() + ": cannot make this folder");
}

void checkDistinct(const std::vector<GivenFile>& written, const std::vector<GivenFile>& read) {
    std::map<std::filesystem::path, std::string> names;
    for (const GivenFile& r : read) names.emplace(placeOf(r.file), r.name);
    for (const GivenFile& w : written) {
        const std::filesystem::path place = placeOf(w.file);
        if (place.empty()) continue;
        const auto [other, isNew] = names.emplace(place, w.name);
        if (!isNew)
            throw InputError(fmt::format("{}: is {} and {}, and one would replace the other",
                                         w.file.string(), other->second, w.name),
                             ExitCode::usage);
    }
}

}  // namespace etendue
