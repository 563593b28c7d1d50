#include "tools/path_classes.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>

#include "tools/path_shape.h"

namespace etendue {

namespace {

const char* descriptionOf(PathClass pathClass) {
    static const std::array<const char*, pathClassCount> descriptions{{
        "what is seen first in a mirror, in smooth glass or in a smooth coat",
        "points, spots and suns, seen directly or with a mirror or smooth glass next to them",
        "where connecting to the lens finds another film point, or none",
        "met only by chance: caustics of lamps, by mirrors, smooth glass or smooth coats",
        "met only by chance: small lamps, seen directly or in mirrors and smooth glass alone",
        "a mirror, smooth glass or a smooth coat where the technique joins its walks",
    }};
    return descriptions[static_cast<std::size_t>(pathClass)];
}

/// Of the light at index, from where the camera stands: the mean of 1 / density over its samples.
double solidAngleOf(const Light& light, Vec3 from) {
    constexpr int across = 16;
    double sum = 0.0;
    for (int i = 0; i < across * across; ++i) {
        const float u = (static_cast<float>(i % across) + 0.5f) / across;
        const float v = (static_cast<float>(i / across) + 0.5f) / across;
        const auto sample = light.sample(from, {u, v});
        if (sample && sample->pdfSolidAngle > 0.0f)
            sum += 1.0 / static_cast<double>(sample->pdfSolidAngle);
    }
    return sum / (across * across);
}

/// What the classes ask of the scene.
struct SceneLights {
    SceneLights(const Scene& scene, const Camera& camera) : hasDirac(hasLightWithoutExtent(scene)) {
        for (int i = 0; i < static_cast<int>(scene.lights().size()); ++i) {
            const Light& light = scene.lights()[i];
            isLamp.push_back(!light.isInfinite());
            isSmallLamp.push_back(isLamp.back() &&
                                  solidAngleOf(light, camera.position()) < smallLampSolidAngle);
        }
    }

    static bool any(const std::vector<bool>& of) {
        return std::find(of.begin(), of.end(), true) != of.end();
    }
    /// `of` the light that the path ends on, if it has extent.
    static bool isEnd(const std::vector<bool>& of, const PathShape& path) {
        const auto light = path.light();
        return light && !light->isDirac && light->index >= 0 &&
               of[static_cast<std::size_t>(light->index)];
    }

    bool hasDirac;
    std::vector<bool> isLamp, isSmallLamp;
};

/// A path may belong to several classes.
bool belongsTo(PathClass pathClass, const PathShape& path, const SceneLights& lights,
               const std::vector<Technique>& alone) {
    const int last = path.edges() - 1;  // the vertex before the light
    switch (pathClass) {
        case PathClass::mirrorFirst:
            return path.isMirrorIfAny(1);
        case PathClass::mirroredPoint:
            return (last == 0 || path.isMirror(last)) && path.light() && path.light()->isDirac;
        case PathClass::lostByLens:
            return !path.isFoundByLens();
        case PathClass::caustic:
            return path.isMirrorIfAny(last) && !path.isMirrorsAlone() &&
                   SceneLights::isEnd(lights.isLamp, path);
        case PathClass::smallLamp:
            return path.isMirrorsAlone() && SceneLights::isEnd(lights.isSmallLamp, path);
        case PathClass::notJoined:
            return std::any_of(alone.begin(), alone.end(), [&](Technique joined) {
                return joined.s > 0 &&
                       (path.isMirrorIfAny(joined.t - 1) || path.isMirrorIfAny(joined.t));
            });
    }
    return false;
}

/// Not whether it has: samples are not traced twice where there is nothing to look for.
bool mayHave(const SceneLights& lights, PathClass pathClass) {
    switch (pathClass) {
        case PathClass::mirroredPoint:
            return lights.hasDirac;
        case PathClass::caustic:
            return SceneLights::any(lights.isLamp);
        case PathClass::smallLamp:
            return SceneLights::any(lights.isSmallLamp);
        default:
            return true;
    }
}

/// Paths of one technique's length, of that technique alone if it is the contender's own.
EstimatorSettings settingsOf(const CommonPathsSettings& s) {
    EstimatorSettings result = withKind(s.estimator, s.self.kind);
    result.lightPaths = 1;
    for (const Contender* contender : {&s.self, &s.other})
        if (const auto& technique = contender->technique)
            result.maxDepth =
                static_cast<int>(std::min<std::int64_t>(result.maxDepth, edgesOf(*technique)));
    if (s.self.technique) result.techniques = *TechniqueSet::parse(nameOf(*s.self.technique));
    return result;
}

class CommonPathsOf final : public CommonPaths {
public:
    CommonPathsOf(const Scene& scene, const Camera& camera, const CommonPathsSettings& settings)
        : lights_(scene, camera),
          settings_(settingsOf(settings)),
          estimator_(makeEstimator(settings_)) {
        for (const Contender* contender : {&settings.self, &settings.other})
            if (contender->technique) alone_.push_back(*contender->technique);
        for (std::size_t i = 0; i < pathClassCount; ++i) {
            const auto pathClass = static_cast<PathClass>(i);
            const bool isByChance =
                !settings.keepsByChance && (makesByChance(settings.self, pathClass) ||
                                            makesByChance(settings.other, pathClass));
            isLeftOut_[i] = mayHave(lights_, pathClass) && canMake(settings.self, pathClass) &&
                            (isByChance || !canMake(settings.other, pathClass));
            looksAtPaths_ |= isLeftOut_[i];
        }
        looksAtPaths_ |= !alone_.empty();
    }

    int lightPathsPerSample() const override { return estimator_->lightPathsPerSample(); }
    bool hasCameraLight() const override { return estimator_->hasCameraLight(); }

    void takeSample(const View& view, SampleId id, SampleRequest request,
                    Sample& result) const override {
        if (!looksAtPaths_) {
            estimator_->takeSample(view, id, request, result);
            return;
        }
        static thread_local SamplePath path;
        retraceSample(view, *estimator_, settings_, id, path);
        // Where light paths are joined to the camera's that has been asked.
        if (isLeftOut_[static_cast<std::size_t>(PathClass::lostByLens)] && settings_.kind == "pt" &&
            !path.contributions.empty())
            markReachability(view, path);
        if (id.sample == 0) holdAgainstEstimator(view, id, path);
        result.contributions.clear();
        result.firstHit.reset();
        for (const Contribution& c : path.contributions) {
            if (!alone_.empty() && !isAsLong(c.technique, alone_.front())) continue;
            const auto pathClass = classToLeaveOut({c.technique, path});
            // What the film refuses is for the render to report.
            if (pathClass && isUsable(c.value * c.weight))
                count(*pathClass, c);
            else
                result.contributions.push_back(c);
        }
    }

    LeftOutMeans leftOut(std::uint32_t samples, std::size_t pixels,
                         FilmColor color) const override {
        LeftOutMeans means{};
        const double count = static_cast<double>(samples) * static_cast<double>(pixels);
        for (std::size_t i = 0; i < pathClassCount; ++i) {
            const auto sum = [&](std::size_t c) {
                // A light path is a sample of all pixels, a camera path of one.
                return byCamera_[i][c] + byLight_[i][c] / static_cast<double>(pixels);
            };
            const Vec3d rgb = rgbOf(color, {sum(0), sum(1), sum(2)});
            means[i] = (rgb.x + rgb.y + rgb.z) / (3.0 * count);
        }
        return means;
    }

private:
    using Sums = std::array<std::atomic<double>, 3>;

    void holdAgainstEstimator(const View& view, SampleId id, const SamplePath& path) const {
        Sample sample;
        estimator_->takeSample(view, id, {}, sample);
        Spectrum own, splatted;
        for (const Contribution& c : sample.contributions)
            (c.isSplat ? splatted : own) += c.value * c.weight;
        if (isFinite(own) && isFinite(splatted) &&
            (own != path.ownPixel || splatted != path.splatted))
            throw std::logic_error(fmt::format(
                "seed {} pixel {},{} sample {}: a path traced again is not the estimator's",
                id.seed, id.x, id.y, id.sample));
    }

    /// The first that is to be left out and that the path belongs to.
    std::optional<std::size_t> classToLeaveOut(const PathShape& path) const {
        for (std::size_t i = 0; i < pathClassCount; ++i)
            if (isLeftOut_[i] && belongsTo(static_cast<PathClass>(i), path, lights_, alone_))
                return i;
        return {};
    }

    void count(std::size_t pathClass, const Contribution& c) const {
        const Spectrum value = c.value * c.weight;
        Sums& sums = (c.technique.t == 1 ? byLight_ : byCamera_)[pathClass];
        for (std::size_t i = 0; i < 3; ++i) sums[i] += double{value[static_cast<int>(i)]};
    }

    SceneLights lights_;
    EstimatorSettings settings_;
    std::unique_ptr<Estimator> estimator_;
    std::vector<Technique> alone_;  // of one length, to which both keep
    std::array<bool, pathClassCount> isLeftOut_{};
    bool looksAtPaths_ = false;
    mutable std::array<Sums, pathClassCount> byCamera_{}, byLight_{};
};

}  // namespace

std::string describe(PathClass pathClass) { return descriptionOf(pathClass); }

bool canMake(const Contender& contender, PathClass pathClass) {
    switch (pathClass) {
        case PathClass::mirrorFirst:
        case PathClass::lostByLens:
            return !contender.isLightTracing();
        case PathClass::mirroredPoint:
            return contender.kind != "pt";
        case PathClass::notJoined:
            return !contender.technique;
        default:
            return true;
    }
}

bool makesByChance(const Contender& contender, PathClass pathClass) {
    return contender.meetsLights() &&
           (pathClass == PathClass::caustic || pathClass == PathClass::smallLamp);
}

bool hasLightWithoutExtent(const Scene& scene) {
    for (int i = 0; i < static_cast<int>(scene.lights().size()); ++i) {
        const auto ray = scene.lights()[i].emit({0.5f, 0.5f}, {0.5f, 0.5f});
        if (!ray || ray->isDiracPosition || ray->isDiracDirection) return true;
    }
    return false;
}

std::unique_ptr<CommonPaths> makeCommonPaths(const Scene& scene, const Camera& camera,
                                             const CommonPathsSettings& settings) {
    return std::make_unique<CommonPathsOf>(scene, camera, settings);
}

}  // namespace etendue
