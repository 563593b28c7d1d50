// SampleRanges: which samples of a picture are there. Samples have global numbers, so that ranges
// rendered anywhere add up to the render of their union.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// begin, begin + 1, … end − 1.
struct SampleRange {
    std::uint32_t begin = 0, end = 0;

    std::uint32_t size() const { return end - begin; }
    friend bool operator==(const SampleRange&, const SampleRange&) = default;
};

/// "64:128".
std::string textOf(SampleRange range);
/// None unless the text is two whole numbers, the first one below the second, up to 2³⁰.
std::optional<SampleRange> parseSampleRange(std::string_view text);

/// Ranges that do not overlap, rising, as few as can be.
class SampleRanges {
public:
    /// The first samples of the range that are there already, if any is.
    std::optional<SampleRange> overlap(SampleRange range) const;
    /// Throws std::invalid_argument if it overlaps one that is there, or is empty.
    void add(SampleRange range);
    /// What of `whole` is missing.
    std::vector<SampleRange> holes(SampleRange whole) const;
    std::uint64_t count() const;
    bool empty() const { return ranges_.empty(); }

    const std::vector<SampleRange>& ranges() const { return ranges_; }
    /// "0:64,128:192"; "none" if there are none.
    std::string text() const;

    friend bool operator==(const SampleRanges&, const SampleRanges&) = default;

private:
    std::vector<SampleRange> ranges_;
};

}  // namespace etendue
