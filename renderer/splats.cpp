#include "renderer/splats.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
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

/// Whether splats reach one pixel, that around them: they mostly do, and that is soon done.
bool isOnePixel(const Filter& filter) {
    return filter.kind() == FilterKind::box && filter.radius() == 0.5f;
}

/// The rows of one band of the film's window.
class Band {
public:
    Band(int index, const Filter& filter, Film& film, TechniqueImages* images)
        : filter_(filter),
          film_(film),
          images_(images),
          isOnePixel_(isOnePixel(filter)),
          pixelDensity_(filter.pdfFilm({0.0f, 0.0f})),
          firstRow_(film.window().y + index * bandRows),
          endRow_(std::min(firstRow_ + bandRows, film.window().y + film.window().height)) {}

    void add(const SplatList::Splat& splat) {
        if (splat.isOfPixel())
            film_.addToSample(columnOf(splat), rowOf(splat), splat.value);
        else if (isOnePixel_)
            addShare(columnOf(splat), rowOf(splat), splat, pixelDensity_);
        else
            spread(splat);
    }

    /// That it will be added soon.
    [[gnu::always_inline]] void expect(const SplatList::Splat& splat) const {
        if (isOnePixel_ || splat.isOfPixel()) {
            film_.expectSplat(columnOf(splat), columnOf(splat), rowOf(splat));
            return;
        }
        const Reach columns = columnsOf(splat), rows = rowsOf(splat);
        for (int y = rows.first; y <= rows.last; ++y)
            film_.expectSplat(columns.first, columns.last, y);
    }

private:
    // Not inlined, lest its variables leave the registers.
    [[gnu::noinline]] void spread(const SplatList::Splat& splat) {
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
                if (share > 0.0f) addShare(x, y, splat, share);
            }
        }
    }

    void addShare(int x, int y, const SplatList::Splat& splat, float share) {
        if (splat.t <= 1) film_.addToSample(x, y, splat.value * (splat.weight * share));
        if (images_ && splat.t >= 1)
            images_->add(x, y, {splat.s, splat.t}, splat.value * share, splat.weight);
    }

    int columnOf(const SplatList::Splat& splat) const { return film_.window().x + splat.column; }
    int rowOf(const SplatList::Splat& splat) const { return film_.window().y + splat.row; }
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
    bool isOnePixel_;
    float pixelDensity_;  // of a filter that is one, 1/pixel²
    int firstRow_, endRow_;
    std::vector<double> columnDensities_;  // of the splat at hand, 1/pixel
};

}  // namespace

template <class Visit>
void SplatList::forEachBand(const Splat& splat, const Visit& visit) const {
    const int first = splat.row / bandRows;
    int last = first;
    if (!isOnePixel_ && !splat.isOfPixel()) {
        const Reach rows(splat.film.y, radius_, window_.y, window_.y + window_.height);
        last = (rows.last - window_.y) / bandRows;
    }
    for (int b = first; b <= last; ++b) visit(static_cast<std::size_t>(b));
}

SplatList::SplatList(const FrameWindow& window, const Filter& filter)
    : window_(window),
      radius_(filter.radius()),
      isOnePixel_(isOnePixel(filter)),
      bandEnds_(static_cast<std::size_t>((window.height + bandRows - 1) / bandRows) + 1) {
    constexpr int most = std::numeric_limits<std::uint16_t>::max();
    if (window.width > most || window.height > most)
        throw std::invalid_argument("splats: the window has more than 65535 columns or rows");
}

void SplatList::clear() {
    splats_.clear();
    std::fill(bandEnds_.begin(), bandEnds_.end(), 0);
}

void SplatList::add(const Contribution& splat, float samples) {
    keep(toVec3(splat.value) * samples, splat.weight, splat.film,
         static_cast<std::uint16_t>(splat.technique.s),
         static_cast<std::uint16_t>(splat.technique.t));
}

void SplatList::addToPixel(int x, int y, const Spectrum& value) {
    const Vec2 center{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
    keep(toVec3(value), 1.0f, center, Splat::pixelS, 0);
}

void SplatList::keep(Vec3 value, float weight, Vec2 film, std::uint16_t s, std::uint16_t t) {
    int column, row;
    if (isOnePixel_ || Splat::isOfPixel(s, t)) {
        column = static_cast<int>(std::floor(film.x)) - window_.x;
        row = static_cast<int>(std::floor(film.y)) - window_.y;
        if (column < 0 || column >= window_.width || row < 0 || row >= window_.height) return;
    } else {
        const Reach columns(film.x, radius_, window_.x, window_.x + window_.width),
            rows(film.y, radius_, window_.y, window_.y + window_.height);
        if (columns.first > columns.last || rows.first > rows.last) return;
        column = columns.first - window_.x;
        row = rows.first - window_.y;
    }
    // Member by member: what is put together elsewhere and then copied waits for its own stores.
    Splat& kept = splats_.emplace_back();
    kept.value = value;
    kept.weight = weight;
    kept.film = film;
    kept.column = static_cast<std::uint16_t>(column);
    kept.row = static_cast<std::uint16_t>(row);
    kept.s = s;
    kept.t = t;
    forEachBand(kept, [&](std::size_t b) { ++bandEnds_[b + 1]; });
}

void SplatList::sortByBand() {
    // A counting sort: first [b + 1] becomes where band b begins, then it moves to its end.
    std::uint32_t begin = 0;
    for (std::size_t b = 1; b < bandEnds_.size(); ++b) begin += std::exchange(bandEnds_[b], begin);
    sorted_.resize(begin);
    for (const Splat& splat : splats_)
        forEachBand(splat, [&](std::size_t b) { sorted_[bandEnds_[b + 1]++] = splat; });
}

void addSplats(std::span<const SplatList> lists, const Filter& filter, int threads, Film& film,
               TechniqueImages* images) {
    if (lists.empty()) return;
    const auto bands = static_cast<std::size_t>(lists.front().bandCount());
    parallelFor(bands, threads, [&](std::size_t b) {
        const int index = static_cast<int>(b);
        Band band(index, filter, film, images);
        // Splats take some time to come from memory, and then their pixels, as long as it takes to
        // add those of several lists.
        constexpr std::size_t ahead = 6;
        for (std::size_t i = 0; i < lists.size() + ahead; ++i) {
            if (i + ahead < lists.size()) __builtin_prefetch(lists[i + ahead].band(index).data());
            if (i < lists.size())
                for (const SplatList::Splat& splat : lists[i].band(index)) band.expect(splat);
            if (i >= ahead)
                for (const SplatList::Splat& splat : lists[i - ahead].band(index)) band.add(splat);
        }
    });
}

}  // namespace etendue
