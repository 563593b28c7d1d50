// PathShape: what the kinds of path are told apart by, whichever technique made it.
#pragma once

#include "tools/sample_path.h"

namespace etendue {

/// The path x₀ … x_k that a technique made of a sample: x₀ on the aperture, x_k on a light.
class PathShape {
public:
    PathShape(Technique technique, const SamplePath& path) : technique_(technique), path_(path) {}

    /// k.
    int edges() const { return technique_.s + technique_.t - 1; }
    /// Whether x_i scattered as a mirror does, 1 ≤ i < k. A vertex that is joined to another one
    /// takes part with its continuous lobes.
    bool isMirror(int i) const;
    /// Whether x_i did, if there is such a vertex between lens and light.
    bool isMirrorIfAny(int i) const { return i >= 1 && i < edges() && isMirror(i); }
    /// All between lens and light.
    bool isMirrorsAlone() const;
    /// False if connecting x₁ to the lens finds another film point, or none; as markReachability
    /// says.
    bool isFoundByLens() const;

    /// What light it ends on is known if x_{k−1} is the lens or scattered as a mirror: no kind of
    /// path asks for it elsewhere.
    struct LightEnd {
        bool isDirac = false;  // no ray meets it
        int index = -1;        // −1: any of those at infinity
    };
    std::optional<LightEnd> light() const;

private:
    Technique technique_;
    const SamplePath& path_;
};

}  // namespace etendue
