// ExactSums: sums that are the same bits in whatever order their terms come, so that the parts of a
// render, made anywhere, add up to what one render would have made.
#pragma once

#include <cstddef>
#include <vector>

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
        const Pair high = twoSum(sums[i], term);
        const Pair low = twoSum(double{rests[i]}, high.error);
        const Pair whole = twoSum(high.sum, low.sum);
        sums[i] = whole.sum;
        rests[i] = static_cast<float>(whole.error);
        return low.error == 0.0 && double{rests[i]} == whole.error;
    }
    /// Adds another sum, without error where that is possible.
    bool add(std::size_t i, double sum, float rest) {
        const bool isExact = add(i, sum);
        return add(i, double{rest}) && isExact;
    }

    friend bool operator==(const ExactSums&, const ExactSums&) = default;

private:
    struct Pair {
        double sum, error;  // together exactly a + b
    };
    static Pair twoSum(double a, double b) {
        const double sum = a + b;
        const double bOfSum = sum - a;
        return {sum, (a - (sum - bOfSum)) + (b - bOfSum)};
    }
};

}  // namespace etendue
