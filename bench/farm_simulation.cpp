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
    double left = 0.0;  // s, or bytes

    explicit Running(const FarmJob& started) : job(&started), left(started.front().seconds) {}
    void goOn() {
        isTransferring = !isTransferring;
        if (!isTransferring) ++phase;
        isDone = phase == job->size();
        if (!isDone) left = isTransferring ? (*job)[phase].bytes : (*job)[phase].seconds;
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
        const double share = bytesPerSecond / static_cast<double>(std::max(transfers, {1}));
        const auto secondsLeft = [&](const Running& r) {
            return r.isTransferring ? r.left / share : r.left;
        };
        double step = std::numeric_limits<double>::infinity();
        for (const Running& r : running) step = std::min(step, secondsLeft(r));
        run.wallSeconds += step;
        run.nodeSeconds += step * static_cast<double>(running.size());
        constexpr double together = 1e-9;  // s: what rounding parts
        for (Running& r : running) {
            const bool goesOn = secondsLeft(r) - step < together;
            r.left -= r.isTransferring ? step * share : step;
            if (goesOn) r.goOn();
        }
        std::erase_if(running, [](const Running& r) { return r.isDone; });
    }
}

}  // namespace etendue
