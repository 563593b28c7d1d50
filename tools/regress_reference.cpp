#include "tools/regress_reference.h"

#include <algorithm>
#include <utility>

#include "statistics/image_error.h"
#include "tools/regress_pictures.h"

namespace etendue {

namespace {

bool isAnyLeftOut(const LeftOutMeans& leftOut) {
    return std::ranges::any_of(leftOut, [](double mean) { return mean != 0.0; });
}

ReferencePicture pictureOf(const SeedPictures& rendered, const std::string& by,
                           const RegressReferenceSettings& settings, const FilmSettings& film) {
    const PictureRegions regions{film.width, film.height, settings.tileSize};
    ReferencePicture result;
    result.by = by;
    result.samples = settings.samples;
    result.largest = rendered.largest;
    for (const Picture& batch : rendered.pictures.back())
        result.means.push_back(regions.meansOf(batch));
    MeanPicture mean = meanPicture(rendered.pictures.back());
    result.pixels = std::move(mean.pixels);
    result.noise = mean.relMse;
    return result;
}

/// Renders pictures for references, each with seeds of its own.
class ReferenceMaker {
public:
    ReferenceMaker(const LoadedScene& loaded, const RegressReferenceSettings& settings,
                   const std::function<bool()>& goOn)
        : loaded_(loaded), settings_(settings), goOn_(goOn), nextSeed_(settings.firstSeed) {}

    std::optional<RegressReference> make() {
        RegressReference result{{}, {}, loaded_.hash, loaded_.film.width, loaded_.film.height, {}};
        const auto pt = render("pt", "bdpt");
        const auto bdptOfPt = pt ? render("bdpt", "pt") : std::nullopt;
        const auto bdptOfLt = bdptOfPt ? render("bdpt", "lt") : std::nullopt;
        if (!bdptOfLt) return {};
        const auto byBdpt = [&](const SeedPictures& rendered) {
            return pictureOf(rendered, "bdpt", settings_, loaded_.film);
        };
        add(result, "pt", byBdpt(*bdptOfPt), isAnyLeftOut(pt->leftOut));
        const bool isAllOfPt = !isAnyLeftOut(bdptOfPt->leftOut);
        const bool isAllOfLt = !isAnyLeftOut(bdptOfLt->leftOut);
        add(result, "lt", byBdpt(isAllOfLt && isAllOfPt ? *bdptOfPt : *bdptOfLt), false);
        auto whole = isAllOfPt ? bdptOfPt : isAllOfLt ? bdptOfLt : render("bdpt", "bdpt");
        if (!whole) return {};
        // Better by another estimator that makes all of the light, if that is not by far noisier.
        const bool isPtWhole = isAllOfPt && !isAnyLeftOut(pt->leftOut);
        if (const std::string other = isPtWhole ? "pt" : isAllOfLt ? "lt" : ""; !other.empty()) {
            RegressReferenceSettings more = settings_;
            more.samples *= otherSamples;
            const auto rendered = render(other, other, more.samples);
            if (!rendered) return {};
            const ReferencePicture picture = pictureOf(*rendered, other, more, loaded_.film);
            if (picture.noise < mostNoise * noiseOf(*whole)) {
                add(result, "bdpt", picture, false);
                return result;
            }
        }
        add(result, "bdpt", byBdpt(*whole), false);
        return result;
    }

private:
    /// Beside that of bdpt's own pictures.
    static constexpr double mostNoise = 2.0;
    /// Of pt and lt for each of bdpt's: theirs are cheaper and noisier.
    static constexpr std::uint32_t otherSamples = 4;

    std::optional<SeedPictures> render(const std::string& self, const std::string& other) {
        return render(self, other, settings_.samples);
    }

    std::optional<SeedPictures> render(const std::string& self, const std::string& other,
                                       std::uint32_t samples) {
        SeedSettings seeds;
        seeds.checkpoints = {samples};
        seeds.seeds = settings_.batches;
        seeds.firstSeed = nextSeed_;
        seeds.sampler = Sampler::sobol;
        seeds.threads = settings_.threads;
        nextSeed_ += static_cast<std::uint64_t>(settings_.batches);
        // What an estimator meets by chance is left out where it is held against another.
        return renderSeeds(loaded_, {loaded_.estimator, {self, {}}, {other, {}}, self == other},
                           seeds, goOn_);
    }

    double noiseOf(const SeedPictures& rendered) const {
        return pictureOf(rendered, "", settings_, loaded_.film).noise;
    }

    static void add(RegressReference& result, const std::string& estimator,
                    ReferencePicture picture, bool leavesOut) {
        picture.estimator = estimator;
        picture.leavesOut = leavesOut;
        result.pictures.push_back(std::move(picture));
    }

    const LoadedScene& loaded_;
    RegressReferenceSettings settings_;
    const std::function<bool()>& goOn_;
    std::uint64_t nextSeed_;
};

}  // namespace

const ReferencePicture* RegressReference::of(std::string_view estimator) const {
    const auto found = std::ranges::find(pictures, estimator, &ReferencePicture::estimator);
    return found == pictures.end() ? nullptr : &*found;
}

std::optional<RegressReference> makeReference(const LoadedScene& loaded,
                                              const RegressReferenceSettings& settings,
                                              const std::function<bool()>& goOn) {
    return ReferenceMaker(loaded, settings, goOn).make();
}

CommonPathsSettings testedPaths(const EstimatorSettings& scene, const std::string& estimator,
                                bool leavesOut) {
    CommonPathsSettings result{scene, {estimator, {}}, {estimator, {}}, true};
    if (!leavesOut) return result;
    result.other.kind = "bdpt";
    result.keepsByChance = false;
    return result;
}

}  // namespace etendue
