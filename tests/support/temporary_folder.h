// TemporaryFolder: a place for a test's files.
#pragma once

#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace etendue {

/// An empty folder, removed with everything in it. In memory where the system offers that: on a
/// busy disk the tests would wait for fsync most of their time.
class TemporaryFolder {
public:
    TemporaryFolder() {
        const std::filesystem::path memory = "/dev/shm";
        const bool hasMemory = ::access(memory.c_str(), W_OK | X_OK) == 0;
        const auto parent = hasMemory ? memory : std::filesystem::temp_directory_path();
        std::string name = (parent / "etendue-XXXXXX").string();
        if (!::mkdtemp(name.data())) throw std::runtime_error("cannot make " + name);
        path_ = name;
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

    /// Writes a file into it and returns the file's path.
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        const std::filesystem::path file = path_ / name;
        std::filesystem::remove(file);  // ext4 syncs a file that is truncated and written anew
        std::ofstream(file, std::ios::binary) << bytes;
        return file;
    }

    /// What lies in it, sorted.
    std::vector<std::string> names() const {
        std::vector<std::string> names;
        for (const auto& entry : std::filesystem::directory_iterator(path_))
            names.push_back(entry.path().filename().string());
        std::ranges::sort(names);
        return names;
    }

private:
    std::filesystem::path path_;
};

inline std::string readFile(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline void writeFile(const std::filesystem::path& file, const std::string& bytes) {
    std::filesystem::remove(file);  // ext4 syncs a file that is truncated and written anew
    std::ofstream(file, std::ios::binary) << bytes;
}

}  // namespace etendue
