#include "renderer/output_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>

#include "config/config.h"
#include "renderer/atomic_file.h"

namespace etendue {

namespace {

namespace fs = std::filesystem;

std::string thisProcess() {
    std::array<char, 256> host{};
    if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
    return fmt::format("process {} on {}", ::getpid(), host.data());
}

/// What the holder has written, or less if it has only begun to.
std::string holderOf(int descriptor) {
    std::array<char, 320> text{};
    const ssize_t size = ::pread(descriptor, text.data(), text.size() - 1, 0);
    return size > 0 ? std::string(text.data(), static_cast<std::size_t>(size)) : "another process";
}

/// False if the file was removed by its last holder between our opening and locking it.
bool isStill(int descriptor, const fs::path& file) {
    struct stat opened {
    }, named{};
    return ::fstat(descriptor, &opened) == 0 && ::stat(file.c_str(), &named) == 0 &&
           opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

}  // namespace

OutputLock::OutputLock(const fs::path& file) {
    if (isWrittenDirectly(file)) return;
    lock_ = file.parent_path() / ("." + file.filename().string() + ".lock");
    while (descriptor_ < 0) {
        const int fd = ::open(lock_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, mode_t{0666});
        if (fd < 0)
            throw std::system_error(errno, std::generic_category(),
                                    file.string() + ": cannot be locked");
        if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
            const int reason = errno;
            const std::string holder = holderOf(fd);
            ::close(fd);
            if (reason != EWOULDBLOCK)
                throw std::system_error(reason, std::generic_category(),
                                        file.string() + ": cannot be locked");
            throw InputError(
                fmt::format("{}: {} is writing it; two would lose each other's samples",
                            file.string(), holder),
                ExitCode::failure);
        }
        if (isStill(fd, lock_))
            descriptor_ = fd;
        else
            ::close(fd);
    }
    const std::string holder = thisProcess();
    // Who cannot write this (a full disk) holds the lock nevertheless.
    if (::ftruncate(descriptor_, 0) == 0 &&
        ::pwrite(descriptor_, holder.data(), holder.size(), 0) < 0)
        errno = 0;
}

OutputLock::~OutputLock() {
    if (descriptor_ < 0) return;
    ::unlink(lock_.c_str());
    ::close(descriptor_);
}

}  // namespace etendue
