#include "tools/write_file.h"

#include <fmt/format.h>

#include "config/config.h"
#include "renderer/atomic_file.h"

namespace etendue {

void writeWholeFile(const std::filesystem::path& file, std::string_view text) {
    std::error_code error;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (!std::filesystem::is_directory(folder, error))
        throw InputError(fmt::format("{}: no such folder", folder.string()), ExitCode::missingFile);
    if (std::filesystem::is_directory(file, error))
        throw InputError(fmt::format("{}: is a folder, not a file to write", file.string()));
    writeFileAtomically(file, text.data(), text.size());
}

}  // namespace etendue
