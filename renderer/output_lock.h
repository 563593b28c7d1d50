// OutputLock: one process at a time writes a file, for as long as the process takes.
#pragma once

#include <filesystem>

namespace etendue {

/// Held from construction to destruction, by an advisory lock (flock) on ".NAME.lock" beside the
/// file: it ends with the process, however that ends. Removes the lock's file in the end. Nothing
/// is locked of what is no regular file (a pipe, /dev/stdout).
class OutputLock {
public:
    /// Throws InputError that names the holder if another process holds it, and std::system_error
    /// if the lock's file cannot be made.
    explicit OutputLock(const std::filesystem::path& file);
    ~OutputLock();
    OutputLock(const OutputLock&) = delete;
    OutputLock& operator=(const OutputLock&) = delete;

private:
    std::filesystem::path lock_;
    int descriptor_ = -1;
};

}  // namespace etendue
