#include "tools/stop_request.h"

#include <atomic>
#include <csignal>

namespace etendue {

namespace {

std::atomic<int> stopRequests{0}, writeRequests{0};
static_assert(std::atomic<int>::is_always_lock_free);  // a signal handler may touch nothing else

extern "C" void requestStop(int signal) {
    if (++stopRequests > 1) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

extern "C" void requestWrite(int) { ++writeRequests; }

}  // namespace

void heedStopRequests() {
    std::signal(SIGINT, requestStop);
    std::signal(SIGTERM, requestStop);
}

bool isStopRequested() { return stopRequests > 0; }

void heedWriteRequests() { std::signal(SIGUSR1, requestWrite); }

bool takeWriteRequest() { return writeRequests.exchange(0) > 0; }

}  // namespace etendue
