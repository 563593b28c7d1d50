#include "tools/write_file.h"

#include <fmt/format.h>

#include <cctype>

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

}  // namespace

void writeWholeFile(const std::filesystem::path& file, std::string_view text) {
    checkPlace(file);
    writeFileAtomically(file, text.data(), text.size());
}

void checkWritable(const std::filesystem::path& file, const std::string& extension) {
    if (file.empty()) return;
    checkExtension(file, extension);
    checkPlace(file);
}

}  // namespace etendue
