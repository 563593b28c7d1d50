// Parallel loops. TBB is known to parallel.cpp alone.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace etendue {

/// The words of an error; where they are but the system's of a thread that cannot be started, which
/// TBB and Embree pass on, words that say so.
std::string inPlainWords(const std::string& error);

/// How many threads to use when nobody says.
int hardwareThreads();

/// Calls body(0) … body(count − 1), each once, on at most `threads` threads, in no particular
/// order. Every call runs with denormals flushed to zero, as Embree wants it, so that a number does
/// not depend on the thread that computed it. The first exception that a call throws is rethrown
/// here.
void parallelFor(std::size_t count, int threads, const std::function<void(std::size_t)>& body);

/// Denormals flushed to zero on this thread while it lives.
class FlushDenormals {
public:
    FlushDenormals();
    ~FlushDenormals();
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
    unsigned saved_;
};

}  // namespace etendue
