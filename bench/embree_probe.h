// What a render asks of Embree, seen from outside: the linker puts wrappers in the place of
// Embree's two queries (--wrap, bench/CMakeLists.txt), so that the renderer itself carries no
// measuring code.
#pragma once

#include <cstdint>

#include "lens/thread_time.h"

namespace etendue {

enum class EmbreeProbe {
    off,
    timing,     // of every query; one thread renders then, as in the others below
    counting,   // of queries and of what they meet
    recording,  // of the queries themselves, to ask them again
};

struct EmbreeUse {
    std::int64_t closestHits = 0, occlusions = 0;  // queries
    std::int64_t met = 0;                          // closest hits that met something
    // Timing only, of the queries that nothing interrupted.
    std::int64_t timed = 0;
    double nanosecondsInside = 0.0;
};

/// Begins anew.
void probeEmbree(EmbreeProbe probe);
EmbreeUse embreeUse();

/// What timing adds to one query: to the whole, and to what counts as inside of it.
struct TimingCost {
    double wholeNanoseconds, insideNanoseconds;
};
TimingCost embreeTimingCost();

/// Asks Embree the recorded queries again, in their order and nothing between them: what rays cost
/// if a renderer were nothing else. Nanoseconds of this thread's processor time per query.
double replayNanosecondsPerQuery();

}  // namespace etendue
