#include "renderer/technique_images.h"

namespace etendue {

TechniqueImages::Sums& TechniqueImages::sumsOf(Technique technique) {
    const std::lock_guard lock(mutex_);
    std::unique_ptr<Sums>& sums = images_[technique];
    if (!sums) sums = std::make_unique<Sums>(noSums());
    return *sums;
}

TechniqueImages::Sums TechniqueImages::noSums() const {
    return Sums(6 * static_cast<std::size_t>(window_.width) *
                static_cast<std::size_t>(window_.height));
}

void TechniqueImages::add(int x, int y, Technique technique, Vec3 value, float weight) {
    Sums& sums = sumsOf(technique);
    const auto pixel =
        static_cast<std::size_t>(y - window_.y) * static_cast<std::size_t>(window_.width) +
        static_cast<std::size_t>(x - window_.x);
    for (std::size_t i = 0; i < 3; ++i) {
        const double lane = value[static_cast<int>(i)];
        sums[6 * pixel + i] += lane * weight;
        sums[6 * pixel + 3 + i] += lane;
    }
}

std::vector<ExrChannels> TechniqueImages::channels(std::uint64_t samples) const {
    const auto count = static_cast<double>(samples);
    std::vector<ExrChannels> result;
    const auto addImages = [&](Technique technique, const Sums& sums) {
        for (const bool isWeighted : {true, false}) {
            const std::string name = nameOf(technique) + (isWeighted ? "." : ".unweighted.");
            ExrChannels image{{name + "R", name + "G", name + "B"}, {}};
            for (std::size_t p = isWeighted ? 0 : 3; p < sums.size(); p += 6) {
                const Vec3d sum{sums[p], sums[p + 1], sums[p + 2]};
                const Vec3 rgb = toFloat(rgbOf(color_, sum) / count);
                image.pixels.insert(image.pixels.end(), {rgb.x, rgb.y, rgb.z});
            }
            result.push_back(std::move(image));
        }
    };
    for (const auto& [technique, sums] : images_) addImages(technique, *sums);
    // A file has to have some.
    if (images_.empty()) addImages({0, 2}, noSums());
    return result;
}

}  // namespace etendue
