#include "tools/stop_request.h"

#include <atomic>
#include <csignal>

namespace etendue {

namespace {

std::atomic<int> stopRequests{0};
static_assert(std::atomic<int>::is_always_lock_free);  // a signal handler may touch nothing else

extern "C" void requestStop(int signal) {
    if (++stopRequests > 1) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

}  // namespace

void heedStopRequests() {
    std::signal(SIGINT, requestStop);
    std::signal(SIGTERM, requestStop);
}

bool isStopRequested() { return stopRequests > 0; }

}  // namespace etendue
