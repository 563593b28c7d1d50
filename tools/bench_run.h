// BenchRunner: does what a suite asks for, and keeps what it finds in a folder.
#pragma once

#include <string>

#include "tools/bench_folder.h"
#include "tools/bench_suite.h"

namespace etendue {

struct BenchRunSettings {
    std::string command;  // as it was typed
    int threads = 1;
};

/// Runs what the folder's records do not have yet. False if a signal ended it before all was done.
///
/// Runs of one view are interleaved: every estimator and variant with the first seed, then with the
/// second … so that what the machine does besides meets all of them alike. Only rendering is timed.
/// Throws InputError if the folder holds results of another suite, program or scene, and for a
/// scene that cannot be loaded; a new folder then gets no records. Nobody else may be writing
/// there.
bool runBench(const BenchSuite& suite, const BenchRunSettings& settings, const BenchFolder& folder);

}  // namespace etendue
