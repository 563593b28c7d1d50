// A farm by discrete events: nodes that work at the same time, and one file system between them.
#pragma once

#include <vector>

namespace etendue {

/// Work on a node alone, then bytes through the file system that all nodes share.
struct FarmPhase {
    double seconds = 0.0, bytes = 0.0;
};
using FarmJob = std::vector<FarmPhase>;

struct FarmRun {
    double wallSeconds = 0.0;
    double nodeSeconds = 0.0;  // of all jobs, waiting for the file system included
};

/// Jobs begin in their order, each as soon as a node is free. Those that read or write at a time
/// have equal shares of the bandwidth.
FarmRun simulateFarm(const std::vector<FarmJob>& jobs, int nodes, double bytesPerSecond);

}  // namespace etendue
