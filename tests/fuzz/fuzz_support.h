// What the fuzz targets share. docs/fuzzing.md says what each of them holds the program to.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

namespace etendue {

/// A finding, unless `holds`: libFuzzer keeps the input of a program that aborts.
inline void require(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "FINDING: %s\n", what);
    std::abort();
}

inline std::string_view textOf(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// A folder of this process' own for the files that a target reads. tools/fuzz.sh, which gives the
/// place by TMPDIR, removes it: a program that is aborted cannot.
class FuzzFolder {
public:
    FuzzFolder()
        : path_(std::filesystem::temp_directory_path() /
                ("etendue-fuzz-" + std::to_string(::getpid()))) {
        std::filesystem::create_directories(path_);
    }

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

    std::filesystem::path write(const std::string& name, std::string_view bytes) const {
        const std::filesystem::path file = path_ / name;
        std::ofstream(file, std::ios::binary) << bytes;
        return file;
    }

private:
    std::filesystem::path path_;
};

/// Number `index` of a sequence that fills [0, 1) evenly along `dimension` (0 to 4); the same in
/// every run.
inline double evenly(int index, int dimension) {
    constexpr double steps[]{0.8566748838545029, 0.733891856627126, 0.6287067210378087,
                             0.5385972572236101, 0.4614019460013397};
    const double value = 0.5 + steps[dimension] * index;
    return value - static_cast<double>(static_cast<std::int64_t>(value));
}

}  // namespace etendue
