// The kinds of path that not every estimator makes, or makes well, told apart sample by sample, so
// that two estimators can be compared on what both see. docs/agreement.md explains them.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "renderer/estimator.h"
#include "renderer/film.h"
#include "tools/contender.h"

namespace etendue {

/// A path may belong to several of them, or to none: then every estimator makes it.
enum class PathClass {
    /// The first thing after the lens is a mirror, smooth glass or the coat of smooth plastic, and
    /// scatters as such.
    mirrorFirst,
    /// A light without extent seen directly, or the last bounce before it is such a mirror's.
    mirroredPoint,
    /// Connecting the first vertex to the lens finds another film point, or none.
    lostByLens,
    /// A lamp of extent throws its light by such mirrors on something that scatters it.
    caustic,
    /// A small lamp is seen directly, or by such mirrors alone.
    smallLamp,
    /// Of a technique alone: one of the vertices that it joins scattered as a mirror.
    notJoined,
};
inline constexpr std::size_t pathClassCount = 6;

/// "what is seen first in a mirror or in smooth glass".
std::string describe(PathClass pathClass);

/// Whether the contender makes such paths of some scene at all.
bool canMake(const Contender& contender, PathClass pathClass);
/// Whether it makes them only by hitting a light that is small from there: its few bright samples
/// have a spread that pictures of few samples do not show.
bool makesByChance(const Contender& contender, PathClass pathClass);

/// A lamp is small if it subtends less than this from where the camera stands.
inline constexpr double smallLampSolidAngle = 0.02;  // sr

/// Whether the scene has a light that no ray meets: what s = 0 alone does not make.
bool hasLightWithoutExtent(const Scene& scene);

/// The light that was left out of a picture: the mean of its pixels, by class, each path in one.
using LeftOutMeans = std::array<double, pathClassCount>;

/// An estimator of what two contenders both make.
class CommonPaths : public Estimator {
public:
    /// What was left out of a picture of `samples` per pixel and the frame's pixels.
    virtual LeftOutMeans leftOut(std::uint32_t samples, std::size_t pixels,
                                 FilmColor color) const = 0;
};

struct CommonPathsSettings {
    EstimatorSettings estimator;  // of the scene: depth and roulette
    Contender self, other;
    bool keepsByChance = false;  // leaves out only what one of them cannot make
};

/// `self` without the paths that `other` does not make, or either makes by chance; of paths of one
/// length, if either is a technique. Keeps count of what it leaves out: one object for each
/// picture. One light path per sample. The first sample of each pixel is held against the
/// estimator's own; throws std::logic_error if they differ.
std::unique_ptr<CommonPaths> makeCommonPaths(const Scene& scene, const Camera& camera,
                                             const CommonPathsSettings& settings);

}  // namespace etendue
