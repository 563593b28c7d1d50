// ExactSums: sums that are the same bits in whatever order their terms come, so that the parts of a
// render, made anywhere, add up to what one render would have made.
#pragma once

#include <cstddef>
#include <vector>

#include "renderer/lanes.h"

namespace etendue {

/// Many sums, each kept as its nearest double and a rest, 77 bits together. A term is added without
/// error (Knuth 1998, "The Art of Computer Programming" vol. 2, §4.2.2, theorem B) as long as its
/// last bit lies within those: a float that is not below 2⁻⁵⁴ of the sum always does.
struct ExactSums {
    std::vector<double> sums;
    std::vector<float> rests;  // sum − the exact sum is −rest: at most half a unit of its last bit

    void resize(std::size_t count) {
        sums.resize(count);
        rests.resize(count);
    }
    std::size_t size() const { return sums.size(); }
    bool empty() const { return sums.empty(); }
    double operator[](std::size_t i) const { return sums[i]; }

    /// False if the term was too small beside the sum and had to be rounded.
    bool add(std::size_t i, double term) {
        const Sum<double> total = sumOf(sums[i], double{rests[i]}, term);
        sums[i] = total.sum;
        rests[i] = static_cast<float>(total.rest);
        return total.lost == 0.0 && double{rests[i]} == total.rest;
    }
    /// The same of three sums, `i` and those behind it, side by side.
    bool addThree(std::size_t i, double x, double y, double z) {
        const DoubleLanes sum{sums[i], sums[i + 1], sums[i + 2], 0.0};
        const FloatLanes rest{rests[i], rests[i + 1], rests[i + 2], 0.0f};
        const Sum<DoubleLanes> total = sumOf(sum, toDouble(rest), DoubleLanes{x, y, z, 0.0});
        const FloatLanes newRest = toFloat(total.rest);
        for (int k = 0; k < 3; ++k) {
            sums[i + static_cast<std::size_t>(k)] = total.sum[k];
            rests[i + static_cast<std::size_t>(k)] = newRest[k];
        }
        const auto lost = (total.lost != 0.0) | (toDouble(newRest) != total.rest);
        const bool isExact = (lost[0] | lost[1] | lost[2]) == 0;
        return isExact;
    }
    /// Adds another sum, without error where that is possible.
    bool add(std::size_t i, double sum, float rest) {
        const bool isExact = add(i, sum);
        return add(i, double{rest}) && isExact;
    }

    friend bool operator==(const ExactSums&, const ExactSums&) = default;

private:
    template <class T>
    struct Pair {
        T sum, error;  // together exactly a + b
    };
    template <class T>
    static Pair<T> twoSum(T a, T b) {
        const T sum = a + b;
        const T bOfSum = sum - a;
        return {sum, (a - (sum - bOfSum)) + (b - bOfSum)};
    }

    template <class T>
    struct Sum {
        T sum, rest, lost;
    };
    template <class T>
    static Sum<T> sumOf(T sum, T rest, T term) {
        const Pair<T> high = twoSum(sum, term);
        const Pair<T> low = twoSum(rest, high.error);
        const Pair<T> whole = twoSum(high.sum, low.sum);
        return {whole.sum, whole.error, low.error};
    }
};

}  // namespace etendue
