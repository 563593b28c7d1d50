#include "bench/farm_simulation.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace etendue {
namespace {

/// A job on a node.
struct Running {
    const FarmJob* job = nullptr;
    std::size_t phase = 0;
    bool isTransferring = false, isDone = false;
    double secondsLeft = 0.0, bytesLeft = 0.0;  // of what it is at

    explicit Running(const FarmJob& started)
        : job(&started), secondsLeft(started.front().seconds) {}
    void goOn() {
        isTransferring = !isTransferring;
        if (!isTransferring) ++phase;
        isDone = phase == job->size();
        if (isDone) return;
        if (isTransferring)
            bytesLeft = (*job)[phase].bytes;
        else
            secondsLeft = (*job)[phase].seconds;
    }
};

}  // namespace

FarmRun simulateFarm(const std::vector<FarmJob>& jobs, int nodes, double bytesPerSecond) {
    FarmRun run;
    std::vector<Running> running;
    for (auto next = jobs.begin();;) {
        while (running.size() < static_cast<std::size_t>(nodes) && next != jobs.end())
            running.emplace_back(*next++);
        if (running.empty()) return run;
        const auto transfers = std::ranges::count_if(running, &Running::isTransferring);
        const double bytesPerSecondEach =
            bytesPerSecond / static_cast<double>(std::max(transfers, {1}));
        const auto secondsToGoOn = [&](const Running& r) {
            return r.isTransferring ? r.bytesLeft / bytesPerSecondEach : r.secondsLeft;
        };
        double step = std::numeric_limits<double>::infinity();
        for (const Running& r : running) step = std::min(step, secondsToGoOn(r));
        run.wallSeconds += step;
        run.nodeSeconds += step * static_cast<double>(running.size());
        constexpr double sameMomentSeconds = 1e-9;  // apart only by rounding
        for (Running& r : running) {
            const bool goesOn = secondsToGoOn(r) - step < sameMomentSeconds;
            if (r.isTransferring)
                r.bytesLeft -= step * bytesPerSecondEach;
            else
                r.secondsLeft -= step;
            if (goesOn) r.goOn();
        }
        std::erase_if(running, [](const Running& r) { return r.isDone; });
    }
}

}  // namespace etendue
