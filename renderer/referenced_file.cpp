#include "renderer/referenced_file.h"

#include <algorithm>

namespace etendue {
namespace {

std::filesystem::path pathOf(const std::filesystem::path& folder, std::string name) {
    std::ranges::replace(name, '\\', '/');
    return (folder / name).lexically_normal();
}

bool isFile(const std::filesystem::path& file) {
    std::error_code ignored;  // what cannot be looked at is no file
    return std::filesystem::is_regular_file(file, ignored);
}

}  // namespace

std::optional<std::filesystem::path> findAsWritten(const std::filesystem::path& folder,
                                                   std::string name) {
    const std::filesystem::path file = pathOf(folder, std::move(name));
    return isFile(file) ? std::optional(file) : std::nullopt;
}

std::optional<std::filesystem::path> findReferencedFile(const std::filesystem::path& folder,
                                                        const std::string& name,
                                                        const std::string& where,
                                                        std::vector<std::string>& notes) {
    if (auto file = findAsWritten(folder, name)) return file;
    const std::filesystem::path bareName = pathOf(folder, name).filename();
    auto beside = findAsWritten(folder, bareName.string());
    if (beside) notes.push_back(where + ": no file \"" + name + "\", taking " + beside->string());
    return beside;
}

}  // namespace etendue
