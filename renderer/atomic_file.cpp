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

int syncRetrying(int fd) {
    int result = 0;
    do result = ::fsync(fd);
    while (result != 0 && errno == EINTR);
    return result;
}

/// Makes a rename in the folder durable. A folder that may not be read, or a file system without
/// such a call (EINVAL), is no failure: the file itself is whole and in place.
void syncFolder(const fs::path& folder, const fs::path& file) {
    const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0 && errno == EACCES) return;
    if (fd < 0) fail(file);
    const int error = syncRetrying(fd) != 0 ? errno : 0;
    ::close(fd);
    if (error != 0 && error != EINVAL) fail(file, error);
}

fs::path folderOf(const fs::path& file) {
    return file.has_parent_path() ? file.parent_path() : ".";
}

/// What the names of a file's temporaries begin with.
std::string temporaryPrefix(const fs::path& target) {
    return "." + target.filename().string() + ".tmp-";
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& file) : file_(file) {
    struct stat old {};
    const bool exists = ::stat(file.c_str(), &old) == 0;
    if (!exists && errno != ENOENT) fail(file);
    if (exists && !S_ISREG(old.st_mode)) {
        descriptor_ = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
        if (descriptor_ < 0) fail(file);
        return;
    }
    // A rename would replace a read-only file without a word.
    if (exists && ::access(file.c_str(), W_OK) != 0) fail(file);

    target_ = followLinks(file);
    const fs::path temporary =
        folderOf(target_) / (temporaryPrefix(target_) + std::to_string(::getpid()));
    // Only a dead process can have left this name, since ours is the one with this id.
    if (::unlink(temporary.c_str()) != 0 && errno != ENOENT) fail(file);
    descriptor_ = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode_t{0666});
    if (descriptor_ < 0) fail(file);
    temporary_ = temporary;
    if (exists && ::fchmod(descriptor_, old.st_mode & mode_t{0777}) != 0) {
        const int error = errno;
        ::close(descriptor_);
        ::unlink(temporary_.c_str());
        fail(file, error);
    }
}

AtomicFile::~AtomicFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(const void* data, std::size_t size) {
    const char* bytes = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t written = ::write(descriptor_, bytes, size);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(file_);
        if (written == 0) fail(file_, EIO);
        bytes += written;
        size -= static_cast<std::size_t>(written);
    }
}

void AtomicFile::commit() { commitKeeping({}); }

void AtomicFile::commitKeeping(const fs::path& previous) {
    if (!temporary_.empty() && syncRetrying(descriptor_) != 0) fail(file_);
    if (::close(std::exchange(descriptor_, -1)) != 0) fail(file_);
    if (temporary_.empty()) return;
    if (!previous.empty() && fs::exists(target_)) {
        ::unlink(previous.c_str());
        // A file system without links loses the moment between two renames, not the file.
        if (::link(target_.c_str(), previous.c_str()) != 0 &&
            ::rename(target_.c_str(), previous.c_str()) != 0)
            fail(previous);
    }
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail(file_);
    temporary_.clear();
    syncFolder(folderOf(target_), file_);
}

bool isWrittenDirectly(const fs::path& file) {
    std::error_code error;
    return fs::exists(file, error) && !fs::is_regular_file(file, error);
}

void writeFileAtomically(const fs::path& file, const void* data, std::size_t size) {
    AtomicFile atomic(file);
    atomic.write(data, size);
    atomic.commit();
}

void sweepTemporaries(const fs::path& file) {
    const fs::path target = followLinks(file);
    const std::string prefix = temporaryPrefix(target);
    std::error_code ignored;  // what cannot be read or removed can stay
    for (const fs::directory_entry& entry : fs::directory_iterator(folderOf(target), ignored))
        if (entry.path().filename().string().starts_with(prefix)) fs::remove(entry.path(), ignored);
}

}  // namespace etendue
