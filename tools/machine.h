// The machine and the build that a measurement belongs to.
#pragma once

#include <string>

namespace etendue {

struct Machine {
    std::string processor;  // "AMD EPYC 9B14"
    int cores = 0;          // that this program may use
    std::string system;     // "Linux 6.1.0 x86_64"
    std::string isa;        // that the program was compiled for, "x86-64-v3"
    std::string compiler, build;
};

Machine thisMachine();

/// Mean number of processes that ran or waited in the last minute; NaN where the system cannot say.
double machineLoad();

/// Now, "2026-11-28T22:50:00Z".
std::string utcNow();

}  // namespace etendue
