// A machine that fails at a chosen moment: tests load it in front of the C library (LD_PRELOAD).
//   UNKIND_KILL=n     the nth write, fsync, link, unlink or rename kills the process, and a write
//                     has half of its bytes done then
//   UNKIND_CLOCK=1    the time of day jumps by a year at every look, back and forth
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <atomic>

namespace {

long numberOf(const char* name) {
    const char* value = getenv(name);
    return value ? strtol(value, nullptr, 10) : 0;
}

void die() { kill(getpid(), SIGKILL); }

bool isLastCall() {
    static const long last = numberOf("UNKIND_KILL");
    static std::atomic<long> calls{0};
    return last > 0 && ++calls >= last;
}

}  // namespace

// The C library's own declarations; what they do is left to the kernel.
extern "C" {

ssize_t write(int file, const void* data, size_t size) {
    const bool isLast = isLastCall();
    const ssize_t written = syscall(SYS_write, file, data, isLast ? size / 2 : size);
    if (isLast) die();
    return written;
}

int fsync(int file) {
    if (isLastCall()) die();
    return static_cast<int>(syscall(SYS_fsync, file));
}

int link(const char* from, const char* to) noexcept {
    if (isLastCall()) die();
    return static_cast<int>(syscall(SYS_linkat, AT_FDCWD, from, AT_FDCWD, to, 0));
}

int unlink(const char* file) noexcept {
    if (isLastCall()) die();
    return static_cast<int>(syscall(SYS_unlinkat, AT_FDCWD, file, 0));
}

int remove(const char* path) noexcept {
    const int result = unlink(path);
    return result != 0 && errno == EISDIR
               ? static_cast<int>(syscall(SYS_unlinkat, AT_FDCWD, path, AT_REMOVEDIR))
               : result;
}

int rename(const char* from, const char* to) noexcept {
    if (isLastCall()) die();
    return static_cast<int>(syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

int clock_gettime(clockid_t clock, timespec* now) noexcept {
    static const bool jumps = numberOf("UNKIND_CLOCK") > 0;
    static std::atomic<long> looks{0};
    const int result = static_cast<int>(syscall(SYS_clock_gettime, clock, now));
    constexpr long yearSeconds = 31'557'600;
    if (jumps && clock == CLOCK_REALTIME) now->tv_sec += ++looks % 2 ? yearSeconds : -yearSeconds;
    return result;
}

time_t time(time_t* when) noexcept {
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    if (when) *when = now.tv_sec;
    return now.tv_sec;
}

}  // extern "C"
