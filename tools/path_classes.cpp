#include "tools/path_classes.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>

#include "tools/sample_path.h"

namespace etendue {

namespace {

struct ClassRow {
    const char* description;
    std::vector<std::string> blindEstimators;
};

const ClassRow& rowOf(PathClass pathClass) {
    static const std::array<ClassRow, pathClassCount> rows{{
        {"what is seen first in a mirror, in smooth glass or in a smooth coat", {"lt"}},
        {"points, spots and suns, seen directly or with a mirror or smooth glass next to them",
         {"pt"}},
        {"where connecting to the lens finds another film point, or none", {"lt"}},
    }};
    return rows[static_cast<std::size_t>(pathClass)];
}

/// The camera's walk scattered at its first vertex as a mirror does. A connection there (t = 2)
/// takes part with the continuous lobes.
bool isMirrorFirst(Technique technique, const CameraSubpath& path) {
    return technique.t >= 3 && !path.vertices[1].density.isConnectable;
}

/// The light's walk began at a light without extent, and went to the lens at once or scattered at
/// its first vertex as a mirror does.
bool isMirroredPoint(Technique technique, const SamplePath& path) {
    if (technique.s == 0 || path.lightPaths.empty() || !path.lightPaths.front().isDirac)
        return false;
    if (technique == Technique{1, 1}) return true;
    return technique.s >= 3 && !path.lightPaths.front().vertices[1].density.isConnectable;
}

bool isLostByLens(Technique technique, const CameraSubpath& path) {
    return technique.t >= 2 && !path.vertices.front().density.isConnectable;
}

/// A path may belong to several classes.
bool belongsTo(PathClass pathClass, Technique technique, const SamplePath& path) {
    switch (pathClass) {
        case PathClass::mirrorFirst:
            return isMirrorFirst(technique, path.cameraPath);
        case PathClass::mirroredPoint:
            return isMirroredPoint(technique, path);
        case PathClass::lostByLens:
            return isLostByLens(technique, path.cameraPath);
    }
    return false;
}

bool hasLightWithoutExtent(const Scene& scene) {
    for (int i = 0; i < static_cast<int>(scene.lights().size()); ++i) {
        const auto ray = scene.lights()[i].emit({0.5f, 0.5f}, {0.5f, 0.5f});
        if (!ray || ray->isDiracPosition || ray->isDiracDirection) return true;
    }
    return false;
}

/// Not whether it has: samples are not traced twice where there is nothing to look for.
bool mayHave(const Scene& scene, PathClass pathClass) {
    return pathClass != PathClass::mirroredPoint || hasLightWithoutExtent(scene);
}

class CommonPathsOf final : public CommonPaths {
public:
    CommonPathsOf(const Scene& scene, const EstimatorSettings& settings, const std::string& other)
        : settings_(withOneLightPath(settings)), estimator_(makeEstimator(settings_)) {
        for (std::size_t i = 0; i < pathClassCount; ++i) {
            const auto pathClass = static_cast<PathClass>(i);
            isLeftOut_[i] = mayHave(scene, pathClass) && canMake(settings.kind, pathClass) &&
                            !canMake(other, pathClass);
            leavesOut_ |= isLeftOut_[i];
        }
    }

    int lightPathsPerSample() const override { return estimator_->lightPathsPerSample(); }

    void takeSample(const View& view, SampleId id, SampleRequest request,
                    Sample& result) const override {
        if (!leavesOut_) {
            estimator_->takeSample(view, id, request, result);
            return;
        }
        static thread_local SamplePath path;
        retraceSample(view, *estimator_, settings_, id, path);
        if (isLeftOut_[static_cast<std::size_t>(PathClass::lostByLens)])
            markReachability(view, path);
        if (id.sample == 0 && settings_.kind == "pt") holdAgainstEstimator(view, id, path);
        result.contributions.clear();
        result.firstHit.reset();
        for (const Contribution& c : path.contributions) {
            const auto pathClass = classToLeaveOut(c.technique, path);
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
                // A light path may fall on any pixel, a camera path on its own.
                return own_[i][c] + splatted_[i][c] / static_cast<double>(pixels);
            };
            const Vec3d rgb = rgbOf(color, {sum(0), sum(1), sum(2)});
            means[i] = (rgb.x + rgb.y + rgb.z) / (3.0 * count);
        }
        return means;
    }

private:
    using Sums = std::array<std::atomic<double>, 3>;

    static EstimatorSettings withOneLightPath(EstimatorSettings settings) {
        settings.lightPaths = 1;
        return settings;
    }

    void holdAgainstEstimator(const View& view, SampleId id, const SamplePath& path) const {
        Sample sample;
        estimator_->takeSample(view, id, {}, sample);
        Spectrum sum;
        for (const Contribution& c : sample.contributions) sum += c.value * c.weight;
        if (isFinite(sum) && sum != path.ownPixel)
            throw std::logic_error(fmt::format(
                "seed {} pixel {},{} sample {}: a path traced again is not the estimator's",
                id.seed, id.x, id.y, id.sample));
    }

    /// The first that is to be left out and that the path belongs to.
    std::optional<std::size_t> classToLeaveOut(Technique technique, const SamplePath& path) const {
        for (std::size_t i = 0; i < pathClassCount; ++i)
            if (isLeftOut_[i] && belongsTo(static_cast<PathClass>(i), technique, path)) return i;
        return {};
    }

    void count(std::size_t pathClass, const Contribution& c) const {
        const Spectrum value = c.value * c.weight;
        Sums& sums = (c.isSplat ? splatted_ : own_)[pathClass];
        for (std::size_t i = 0; i < 3; ++i) sums[i] += double{value[static_cast<int>(i)]};
    }

    EstimatorSettings settings_;
    std::unique_ptr<Estimator> estimator_;
    std::array<bool, pathClassCount> isLeftOut_{};
    bool leavesOut_ = false;
    mutable std::array<Sums, pathClassCount> own_{}, splatted_{};
};

}  // namespace

std::string describe(PathClass pathClass) { return rowOf(pathClass).description; }

bool canMake(const std::string& estimatorKind, PathClass pathClass) {
    const auto& blind = rowOf(pathClass).blindEstimators;
    return std::find(blind.begin(), blind.end(), estimatorKind) == blind.end();
}

std::unique_ptr<CommonPaths> makeCommonPaths(const Scene& scene, const EstimatorSettings& settings,
                                             const std::string& other) {
    return std::make_unique<CommonPathsOf>(scene, settings, other);
}

}  // namespace etendue
