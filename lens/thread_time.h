// The processor time of a thread, which others on the machine do not add to.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <ctime>
#include <vector>

namespace etendue {

inline double threadSeconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Of one call of `body`, which is called for every query and returns a number: the median over
/// several runs; 0 without a query.
template <class Query, class Body>
double nanosecondsPer(const std::vector<Query>& queries, const Body& body) {
    constexpr std::size_t runs = 9;
    if (queries.empty()) return 0.0;
    std::array<double, runs> times;
    [[maybe_unused]] volatile double sink = 0.0;  // lest the calls be left out
    for (double& time : times) {
        double sum = 0.0;
        const double start = threadSeconds();
        for (const Query& query : queries) sum += static_cast<double>(body(query));
        time = threadSeconds() - start;
        sink = sum;
    }
    std::nth_element(times.begin(), times.begin() + runs / 2, times.end());
    return 1e9 * times[runs / 2] / static_cast<double>(queries.size());
}

}  // namespace etendue
