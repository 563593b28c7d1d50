#include "renderer/sample_ranges.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace etendue {

std::string textOf(SampleRange range) { return fmt::format("{}:{}", range.begin, range.end); }

std::optional<SampleRange> parseSampleRange(std::string_view text) {
    constexpr std::uint32_t most = 1u << 30;
    SampleRange range;
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, range.begin);
    if (first.ec != std::errc() || first.ptr == end || *first.ptr != ':') return std::nullopt;
    const auto second = std::from_chars(first.ptr + 1, end, range.end);
    if (second.ec != std::errc() || second.ptr != end) return std::nullopt;
    if (range.begin >= range.end || range.end > most) return std::nullopt;
    return range;
}

std::optional<SampleRange> SampleRanges::overlap(SampleRange range) const {
    for (const SampleRange& r : ranges_) {
        const SampleRange both{std::max(r.begin, range.begin), std::min(r.end, range.end)};
        if (both.begin < both.end) return both;
    }
    return std::nullopt;
}

void SampleRanges::add(SampleRange range) {
    if (range.begin >= range.end) throw std::invalid_argument("sample range: is empty");
    if (overlap(range)) throw std::invalid_argument("sample range: is there already");
    const auto place = std::ranges::lower_bound(ranges_, range.begin, {},
                                                [](const SampleRange& r) { return r.begin; });
    auto at = ranges_.insert(place, range);
    if (const auto next = at + 1; next != ranges_.end() && next->begin == at->end) {
        at->end = next->end;
        at = ranges_.erase(next) - 1;
    }
    if (at != ranges_.begin() && (at - 1)->end == at->begin) {
        (at - 1)->end = at->end;
        ranges_.erase(at);
    }
}

std::vector<SampleRange> SampleRanges::holes(SampleRange whole) const {
    std::vector<SampleRange> result;
    std::uint32_t from = whole.begin;
    for (const SampleRange& r : ranges_) {
        if (r.begin >= whole.end) break;
        if (r.begin > from) result.push_back({from, r.begin});
        from = std::max(from, r.end);
    }
    if (from < whole.end) result.push_back({from, whole.end});
    return result;
}

std::uint64_t SampleRanges::count() const {
    std::uint64_t count = 0;
    for (const SampleRange& r : ranges_) count += r.size();
    return count;
}

std::string SampleRanges::text() const {
    if (ranges_.empty()) return "none";
    std::string text;
    for (const SampleRange& r : ranges_) text += (text.empty() ? "" : ",") + textOf(r);
    return text;
}

}  // namespace etendue
