#include "tools/write_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "config/config.h"

namespace etendue {

void writeWholeFile(const std::filesystem::path& file, std::string_view text) {
    std::error_code error;
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    if (!std::filesystem::is_directory(folder, error))
        throw InputError(fmt::format("{}: no such folder", folder.string()), ExitCode::missingFile);
    if (std::filesystem::is_directory(file, error))
        throw InputError(fmt::format("{}: is a folder, not a file to write", file.string()));
    const std::filesystem::path temporary = fmt::format("{}.{}.part", file.string(), getpid());
    const auto fail = [&] {
        const int reason = errno;
        std::filesystem::remove(temporary, error);
        throw std::runtime_error(fmt::format("{}: {}", file.string(), std::strerror(reason)));
    };
    {
        std::ofstream stream(temporary, std::ios::binary);
        stream.write(text.data(), static_cast<std::streamsize>(text.size()));
        stream.close();
        if (!stream) fail();
    }
    if (std::rename(temporary.c_str(), file.c_str()) != 0) fail();
}

}  // namespace etendue
