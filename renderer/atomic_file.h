// Files that are written whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>

namespace etendue {

/// A file that takes its place only when it is whole.
///
/// What is written goes to ".NAME.tmp-PID" in the folder of `file`; commit() syncs that, renames it
/// to `file` and syncs the folder, so that whatever happens `file` is either the old one or the
/// whole new one. Without commit() the temporary is removed. A symbolic link is written through to
/// its destination; what is not a regular file (a pipe, /dev/stdout) is written directly. A file
/// that exists keeps its permissions, a new one gets 0666 less the umask.
///
/// All throw std::system_error, "FILE: cannot write: " and the system's reason. That needs SIGXFSZ
/// and SIGPIPE to be ignored if their conditions are to become such an error. One writer per file
/// at a time; what killed processes leave, sweepTemporaries() removes.
class AtomicFile {
public:
    explicit AtomicFile(const std::filesystem::path& file);
    ~AtomicFile();
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;

    void write(const void* data, std::size_t size);
    void commit();
    /// The same, and the file that was there until now stays under the other name, in the same
    /// folder. At no time is there none under its own.
    void commitKeeping(const std::filesystem::path& previous);

private:
    std::filesystem::path file_, target_, temporary_;  // no temporary: written directly
    int descriptor_ = -1;
};

/// Whether there is something that is no regular file, which is written directly.
bool isWrittenDirectly(const std::filesystem::path& file);

/// In one go.
void writeFileAtomically(const std::filesystem::path& file, const void* data, std::size_t size);

/// Removes the temporaries that killed writers of `file` have left. Nobody may be writing it.
void sweepTemporaries(const std::filesystem::path& file);

}  // namespace etendue
