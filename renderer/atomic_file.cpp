#include "renderer/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

namespace etendue {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, int error = errno) {
    throw std::system_error(error, std::generic_category(), file.string() + ": cannot write");
}

class Descriptor {
public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (isOpen()) ::close(fd_);
    }

    bool isOpen() const { return fd_ >= 0; }
    int get() const { return fd_; }
    /// As ::close, for those who want to know whether it worked.
    int close() { return ::close(std::exchange(fd_, -1)); }

private:
    int fd_;
};

/// Removes what lies under a name in the end; after a rename that is nothing.
class RemovalAtEnd {
public:
    explicit RemovalAtEnd(fs::path path) : path_(std::move(path)) {}
    RemovalAtEnd(const RemovalAtEnd&) = delete;
    RemovalAtEnd& operator=(const RemovalAtEnd&) = delete;
    ~RemovalAtEnd() { ::unlink(path_.c_str()); }

private:
    fs::path path_;
};

/// Where a chain of symbolic links leads, whether or not anything is there yet. The caller knows
/// that it is no loop.
fs::path followLinks(const fs::path& file) {
    fs::path target = file;
    std::error_code error;
    while (fs::is_symlink(target, error)) {
        target = target.parent_path() / fs::read_symlink(target, error);
        if (error) fail(file, error.value());
    }
    return target;
}

void writeAll(int fd, const void* data, std::size_t size, const fs::path& file) {
    const char* bytes = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t written = ::write(fd, bytes, size);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(file);
        if (written == 0) fail(file, EIO);
        bytes += written;
        size -= static_cast<std::size_t>(written);
    }
}

int syncRetrying(int fd) {
    int result = 0;
    do result = ::fsync(fd);
    while (result != 0 && errno == EINTR);
    return result;
}

/// Makes a rename in the folder durable. A folder that may not be read, or a file system without
/// such a call (EINVAL), is no failure: the file itself is whole and in place.
void syncFolder(const fs::path& folder, const fs::path& file) {
    Descriptor fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!fd.isOpen() && errno == EACCES) return;
    if (!fd.isOpen()) fail(file);
    if (syncRetrying(fd.get()) != 0 && errno != EINVAL) fail(file);
}

void writeInPlace(const fs::path& file, const void* data, std::size_t size) {
    Descriptor fd(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
    if (!fd.isOpen()) fail(file);
    writeAll(fd.get(), data, size, file);
    if (fd.close() != 0) fail(file);
}

}  // namespace

void writeFileAtomically(const fs::path& file, const void* data, std::size_t size) {
    struct stat old {};
    const bool exists = ::stat(file.c_str(), &old) == 0;
    if (!exists && errno != ENOENT) fail(file);
    if (exists && !S_ISREG(old.st_mode)) return writeInPlace(file, data, size);
    // A rename would replace a read-only file without a word.
    if (exists && ::access(file.c_str(), W_OK) != 0) fail(file);

    const fs::path target = followLinks(file);
    const fs::path folder = target.has_parent_path() ? target.parent_path() : ".";
    const fs::path temporary =
        folder / ("." + target.filename().string() + ".tmp-" + std::to_string(::getpid()));
    // Only a dead process can have left this name, since ours is the one with this id.
    if (::unlink(temporary.c_str()) != 0 && errno != ENOENT) fail(file);
    Descriptor fd(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode_t{0666}));
    if (!fd.isOpen()) fail(file);
    const RemovalAtEnd removal(temporary);

    if (exists && ::fchmod(fd.get(), old.st_mode & mode_t{0777}) != 0) fail(file);
    writeAll(fd.get(), data, size, file);
    if (syncRetrying(fd.get()) != 0) fail(file);
    if (fd.close() != 0) fail(file);
    if (::rename(temporary.c_str(), target.c_str()) != 0) fail(file);
    syncFolder(folder, file);
}

}  // namespace etendue
