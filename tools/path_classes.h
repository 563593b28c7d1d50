// The kinds of path that not every estimator can make, told apart sample by sample, so that two
// estimators can be compared on what both see. docs/agreement.md explains them.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "renderer/estimator.h"
#include "renderer/film.h"

namespace etendue {

/// A path may belong to several of them, or to none: then every estimator can make it.
enum class PathClass {
    /// The first thing after the lens is a mirror, smooth glass or the coat of smooth plastic, and
    /// scatters as such.
    mirrorFirst,
    /// A light without extent seen directly, or the last bounce before it is such a mirror's.
    mirroredPoint,
    /// Connecting the first vertex to the lens finds another film point, or none.
    lostByLens,
};
inline constexpr std::size_t pathClassCount = 3;

/// "what is seen first in a mirror or in smooth glass".
std::string describe(PathClass pathClass);

/// Whether an estimator of that kind, all techniques allowed, makes such paths.
bool canMake(const std::string& estimatorKind, PathClass pathClass);

/// The light that was left out of a picture: the mean of its pixels, by class, each path in one.
using LeftOutMeans = std::array<double, pathClassCount>;

/// An estimator of what two kinds of estimator can both make.
class CommonPaths : public Estimator {
public:
    /// What was left out of a picture of `samples` per pixel and the frame's pixels.
    virtual LeftOutMeans leftOut(std::uint32_t samples, std::size_t pixels,
                                 FilmColor color) const = 0;
};

/// The estimator of `settings` without the paths that one of the kind `other` cannot make. Keeps
/// count of what it leaves out: one object for each picture. One light path per sample. The first
/// sample of each pixel is held against the estimator's own; throws std::logic_error if they
/// differ.
std::unique_ptr<CommonPaths> makeCommonPaths(const Scene& scene, const EstimatorSettings& settings,
                                             const std::string& other);

}  // namespace etendue
