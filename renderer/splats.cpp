#include "renderer/splats.h"

#include <algorithm>
#include <cmath>

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

    void add(const SplatList::Splat& splat) {
        const FrameWindow& window = film_.window();
        const float radius = filter_.radius();
        const Reach columns(splat.film.x, radius, window.x, window.x + window.width);
        const Reach rows(splat.film.y, radius, firstRow_, endRow_);
        const Spectrum value = rgb(splat.value.x, splat.value.y, splat.value.z);
        for (int y = rows.first; y <= rows.last; ++y)
            for (int x = columns.first; x <= columns.last; ++x) {
                const Vec2 center{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
                const float share = filter_.pdfFilm(splat.film - center);
                if (share == 0.0f) continue;
                film_.addSplat(x, y, value * (splat.weight * share));
                if (images_) images_->add(x, y, splat.technique, value * share, splat.weight);
            }
    }

private:
    const Filter& filter_;
    Film& film_;
    TechniqueImages* images_;
    int firstRow_, endRow_;
};

}  // namespace

SplatList::SplatList(const FrameWindow& window, const Filter& filter)
    : window_(window),
      radius_(filter.radius()),
      bands_(static_cast<std::size_t>((window.height + bandRows - 1) / bandRows)) {}

void SplatList::add(std::uint32_t sample, const Contribution& splat) {
    const Reach columns(splat.film.x, radius_, window_.x, window_.x + window_.width);
    const Reach rows(splat.film.y, radius_, window_.y, window_.y + window_.height);
    if (columns.first > columns.last || rows.first > rows.last) return;
    const Vec3 value{splat.value[0], splat.value[1], splat.value[2]};
    const int lastBand = (rows.last - window_.y) / bandRows;
    for (int b = (rows.first - window_.y) / bandRows; b <= lastBand; ++b)
        bands_[static_cast<std::size_t>(b)].push_back(
            {splat.film, value, splat.weight, splat.technique, sample});
}

void SplatList::clear() {
    for (auto& band : bands_) band.clear();
}

void addSplats(const std::vector<SplatList>& parts, const Filter& filter, std::uint32_t firstSample,
               std::uint32_t sampleCount, int threads, Film& film, TechniqueImages* images) {
    if (parts.empty()) return;
    const auto bands = static_cast<std::size_t>(parts.front().bandCount());
    parallelFor(bands, threads, [&](std::size_t b) {
        const int index = static_cast<int>(b);
        Band band(index, filter, film, images);
        std::vector<std::size_t> next(parts.size(), 0);
        for (std::uint32_t sample = firstSample; sample < firstSample + sampleCount; ++sample)
            for (std::size_t p = 0; p < parts.size(); ++p) {
                const auto& splats = parts[p].band(index);
                for (std::size_t& i = next[p]; i < splats.size() && splats[i].sample == sample; ++i)
                    band.add(splats[i]);
            }
    });
}

}  // namespace etendue
