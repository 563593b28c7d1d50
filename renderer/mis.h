// Multiple importance sampling over the techniques of bidirectional path tracing (Veach 1997,
// chapter 10). Pure: knows no scene and no camera. docs/bidirectional.md derives it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// How a path was made: its first `t` vertices, the aperture point among them, by a walk from the
/// camera, the other `s` by a walk from a light.
struct Technique {
    int s = 0, t = 0;
    friend auto operator<=>(const Technique&, const Technique&) = default;
};

/// "s2t1".
std::string nameOf(Technique technique);
/// Of the paths that it makes.
constexpr std::int64_t edgesOf(Technique technique) {
    return std::int64_t{technique.s} + technique.t - 1;
}

/// One of a list of techniques: "s2t1", "t1" or "s0".
struct TechniqueName {
    std::string text;
    std::int64_t fewestEdges;  // of the paths that its techniques make
};

/// Which techniques an estimator may use.
class TechniqueSet {
public:
    /// All of them.
    TechniqueSet() = default;
    /// Connections of light paths to the lens alone.
    static TechniqueSet lightTracing();
    /// Names as of nameOf, separated by commas; "t1" and "s0" stand for all with that count. Empty
    /// when the text is something else.
    static std::optional<TechniqueSet> parse(std::string_view text);

    bool contains(Technique technique) const {
        return isAll_ ||
               (isCharted(technique)
                    ? (chart_[static_cast<std::size_t>(technique.t)] >> technique.s & 1) != 0
                    : isListed(technique));
    }
    bool isAll() const { return isAll_; }
    /// Those that were parsed, each once.
    std::vector<TechniqueName> names() const;
    /// Any technique with t ≥ 2, up to paths of `maxDepth` edges.
    bool needsCameraWalk(int maxDepth) const;
    /// Any technique with s ≥ 2, or with t = 1.
    bool needsLightWalk(int maxDepth) const;

private:
    template <class Predicate>
    bool any(int maxDepth, const Predicate& predicate) const;

    /// Fills the chart from the sets.
    void chart();
    static bool isCharted(Technique technique) {
        return technique.s >= 0 && technique.s < chartSize && technique.t >= 0 &&
               technique.t < chartSize;
    }
    bool isListed(Technique technique) const;

    static constexpr int chartSize = 32;  // of longer paths nearly none are made

    bool isAll_ = true;
    std::set<int> allWithS_, allWithT_;
    std::set<Technique> single_;
    std::array<std::uint32_t, chartSize> chart_{};  // [t], a bit for each s
};

/// What the weights must know of a vertex. The two densities share one measure, whichever it is:
/// only their quotient counts.
struct VertexDensity {
    float fromCamera = 0.0f, fromLight = 0.0f;
    /// False for a Dirac bounce, and for the aperture point when the lens would not find it.
    bool isConnectable = false;
};

/// How many samples the techniques take together for one camera sample of every pixel.
struct SampleCounts {
    const TechniqueSet& techniques;
    /// Light paths, each of them connected to the lens: it may fall on any pixel. All other
    /// techniques take one sample.
    double lightPaths = 1.0;

    double operator()(Technique technique) const {
        if (!techniques.contains(technique)) return 0.0;
        return technique.t == 1 ? lightPaths : 1.0;
    }
};

/// A quotient of densities, each times its technique's count and over the density of the technique
/// itself.
struct PathWeight {
    double own = 0.0, byLens = 0.0;  // of the technique, and of those with t = 1
    double byOthers = 1.0;           // of all but t = 1

    /// Where those with t = 1 are denser by `lensFactor`; 0: they cannot make the path.
    float value(double lensFactor = 1.0) const {
        return static_cast<float>(own / (byLens > 0.0 ? byOthers + lensFactor * byLens : byOthers));
    }
};

/// The balance heuristic (Veach 1997, §10.2) for a path sampled by `technique`. `path`[0] is the
/// aperture point, the last vertex lies on the light; path.size() = s + t. The weights of all
/// techniques that can make the path sum to one.
PathWeight balanceWeight(std::span<const VertexDensity> path, Technique technique,
                         const SampleCounts& counts);

}  // namespace etendue
