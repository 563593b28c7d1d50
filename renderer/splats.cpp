#include "renderer/splats.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderer/parallel.h"

namespace etendue {

namespace {

/// Enough rows that most splats touch one band alone, few enough to keep all threads busy.
constexpr int bandRows = 16;

/// The pixels of an axis whose filter reaches `film`, between `from` and `to` (exclusive).
struct Reach {
    Reach(float film, float radius, int from, int to)
        : first(std::max(from, static_cast<int>(std::ceil(film - radius - 0.5f)))),
          last(std::min(to - 1, static_cast<int>(std::floor(film + radius - 0.5f)))) {}
    int first, last;
};

/// The rows of one band of the film's window.
class Band {
public:
    Band(int index, const Filter& filter, Film& film, TechniqueImages* images)
        : filter_(filter),
          film_(film),
          images_(images),
          firstRow_(film.window().y + index * bandRows),
          endRow_(std::min(firstRow_ + bandRows, film.window().y + film.window().height)) {}

    // Not inlined, lest its variables leave the registers.
    [[gnu::noinline]] void add(const SplatList::Splat& splat) {
        const Reach columns = columnsOf(splat), rows = rowsOf(splat);
        columnDensities_.clear();
        for (int x = columns.first; x <= columns.last; ++x)
            columnDensities_.push_back(
                filter_.pdfAxis(splat.film.x - (static_cast<float>(x) + 0.5f)));
        for (int y = rows.first; y <= rows.last; ++y) {
            const double rowDensity =
                filter_.pdfAxis(splat.film.y - (static_cast<float>(y) + 0.5f));
            for (int x = columns.first; x <= columns.last; ++x) {
                const auto share = static_cast<float>(
                    columnDensities_[static_cast<std::size_t>(x - columns.first)] * rowDensity);
                if (share == 0.0f) continue;
                if (splat.t == 1)
                    film_.addSplat(x, y, splat.value * (splat.weight * share));
                else if (splat.t == 0)
                    film_.addCameraSplat(x, y, splat.value * (splat.weight * share));
                if (images_ && splat.t >= 1)
                    images_->add(x, y, {splat.s, splat.t}, splat.value * share, splat.weight);
            }
        }
    }

    /// That it will be added soon.
    [[gnu::always_inline]] void expect(const SplatList::Splat& splat) const {
        const Reach columns = columnsOf(splat), rows = rowsOf(splat);
        for (int y = rows.first; y <= rows.last; ++y)
            film_.expectSplat(columns.first, columns.last, y, splat.t == 1);
    }

private:
    Reach columnsOf(const SplatList::Splat& splat) const {
        const FrameWindow& window = film_.window();
        return {splat.film.x, filter_.radius(), window.x, window.x + window.width};
    }
    Reach rowsOf(const SplatList::Splat& splat) const {
        return {splat.film.y, filter_.radius(), firstRow_, endRow_};
    }

    const Filter& filter_;
    Film& film_;
    TechniqueImages* images_;
    int firstRow_, endRow_;
    std::vector<double> columnDensities_;  // of the splat at hand, 1/pixel
};

}  // namespace

template <class Visit>
void SplatList::forEachBand(int firstRow, int lastRow, const Visit& visit) const {
    const int last = (lastRow - window_.y) / bandRows;
    for (int b = (firstRow - window_.y) / bandRows; b <= last; ++b)
        visit(static_cast<std::size_t>(b));
}

SplatList::SplatList(const FrameWindow& window, const Filter& filter)
    : window_(window),
      radius_(filter.radius()),
      bandEnds_(static_cast<std::size_t>((window.height + bandRows - 1) / bandRows) + 1) {}

void SplatList::clear() {
    splats_.clear();
    std::fill(bandEnds_.begin(), bandEnds_.end(), 0);
}

void SplatList::add(const Contribution& splat) {
    const Reach columns(splat.film.x, radius_, window_.x, window_.x + window_.width);
    const Reach rows(splat.film.y, radius_, window_.y, window_.y + window_.height);
    if (columns.first > columns.last || rows.first > rows.last) return;
    splats_.push_back({splat.value, splat.film, splat.weight,
                       static_cast<std::uint16_t>(splat.technique.s),
                       static_cast<std::uint16_t>(splat.technique.t)});
    forEachBand(rows.first, rows.last, [&](std::size_t b) { ++bandEnds_[b + 1]; });
}

void SplatList::sortByBand() {
    // A counting sort: first [b + 1] becomes where band b begins, then it moves to its end.
    std::uint32_t begin = 0;
    for (std::size_t b = 1; b < bandEnds_.size(); ++b) begin += std::exchange(bandEnds_[b], begin);
    numbers_.resize(begin);
    for (std::uint32_t i = 0; i < splats_.size(); ++i) {
        const Reach rows(splats_[i].film.y, radius_, window_.y, window_.y + window_.height);
        forEachBand(rows.first, rows.last,
                    [&](std::size_t b) { numbers_[bandEnds_[b + 1]++] = i; });
    }
}

void addSplats(std::span<const SplatList> lists, const Filter& filter, int threads, Film& film,
               TechniqueImages* images) {
    if (lists.empty()) return;
    const auto bands = static_cast<std::size_t>(lists.front().bandCount());
    parallelFor(bands, threads, [&](std::size_t b) {
        const int index = static_cast<int>(b);
        Band band(index, filter, film, images);
        std::vector<const SplatList::Splat*> splats;
        for (const SplatList& list : lists)
            for (const std::uint32_t number : list.band(index)) splats.push_back(&list[number]);
        // A splat takes some time to come from memory, and then its pixel, as long as it takes to
        // add several.
        constexpr std::size_t ahead = 16;
        for (std::size_t i = 0; i < splats.size(); ++i) {
            if (i + 2 * ahead < splats.size()) __builtin_prefetch(splats[i + 2 * ahead]);
            if (i + ahead < splats.size()) band.expect(*splats[i + ahead]);
            band.add(*splats[i]);
        }
    });
}

}  // namespace etendue
