// A parallel loop for fitting. TBB is known to parallel.cpp alone.
#pragma once

#include <cstddef>
#include <functional>

namespace etendue {

/// `body(i)` once for every i < count, in any order and on any thread.
void parallelFor(std::size_t count, const std::function<void(std::size_t)>& body);

}  // namespace etendue
