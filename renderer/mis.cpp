#include "renderer/mis.h"

#include <cassert>
#include <charconv>
#include <cmath>

namespace etendue {

namespace {

/// The number after `letter`, if `text` starts with one; both are taken off.
std::optional<int> takeNumber(std::string_view& text, char letter) {
    if (text.empty() || text.front() != letter) return {};
    int value = 0;
    const char* begin = text.data() + 1;
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
    if (error != std::errc() || end == begin || *begin == '-') return {};
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return value;
}

/// Whether a path with these vertices can be made so at all.
bool isPossible(std::span<const VertexDensity> path, Technique technique) {
    if (technique.s == 0) return true;  // a light that no ray meets has fromCamera = 0
    const auto t = static_cast<std::size_t>(technique.t);
    return path[t - 1].isConnectable && path[t].isConnectable;
}

}  // namespace

std::string nameOf(Technique technique) {
    return "s" + std::to_string(technique.s) + "t" + std::to_string(technique.t);
}

TechniqueSet TechniqueSet::lightTracing() {
    TechniqueSet set;
    set.isAll_ = false;
    set.allWithT_.insert(1);
    set.chart();
    return set;
}

std::optional<TechniqueSet> TechniqueSet::parse(std::string_view text) {
    TechniqueSet set;
    set.isAll_ = false;
    while (true) {
        const std::string_view::size_type comma = text.find(',');
        std::string_view name = text.substr(0, comma);
        const std::optional<int> s = takeNumber(name, 's'), t = takeNumber(name, 't');
        const bool isShort = s && t && edgesOf({*s, *t}) < 1;  // a path has two vertices at least
        const bool isKnown = (s || t) && name.empty() && t.value_or(1) >= 1 && !isShort;
        if (!isKnown) return {};
        if (s && t)
            set.single_.insert({*s, *t});
        else if (s)
            set.allWithS_.insert(*s);
        else
            set.allWithT_.insert(*t);
        if (comma == std::string_view::npos) {
            set.chart();
            return set;
        }
        text.remove_prefix(comma + 1);
    }
}

std::vector<TechniqueName> TechniqueSet::names() const {
    std::vector<TechniqueName> result;
    for (const Technique& technique : single_)
        result.push_back({nameOf(technique), edgesOf(technique)});
    // The shortest paths have one vertex of the other kind at most.
    for (const int s : allWithS_)
        result.push_back({"s" + std::to_string(s), edgesOf({s, s == 0 ? 2 : 1})});
    for (const int t : allWithT_)
        result.push_back({"t" + std::to_string(t), edgesOf({t == 1 ? 1 : 0, t})});
    return result;
}

void TechniqueSet::chart() {
    for (int t = 0; t < chartSize; ++t)
        for (int s = 0; s < chartSize; ++s)
            if (isListed({s, t})) chart_[static_cast<std::size_t>(t)] |= std::uint32_t{1} << s;
}

bool TechniqueSet::isListed(Technique technique) const {
    return allWithT_.contains(technique.t) || allWithS_.contains(technique.s) ||
           single_.contains(technique);
}

template <class Predicate>
bool TechniqueSet::any(int maxDepth, const Predicate& predicate) const {
    for (int t = 1; t <= maxDepth + 1; ++t)
        for (int s = 0; s + t <= maxDepth + 1; ++s)
            if (s + t >= 2 && predicate(Technique{s, t}) && contains({s, t})) return true;
    return false;
}

bool TechniqueSet::needsCameraWalk(int maxDepth) const {
    return any(maxDepth, [](Technique technique) { return technique.t >= 2; });
}

bool TechniqueSet::needsLightWalk(int maxDepth) const {
    return any(maxDepth, [](Technique technique) { return technique.s >= 2 || technique.t == 1; });
}

PathWeight balanceWeight(std::span<const VertexDensity> path, Technique technique,
                         const SampleCounts& counts) {
    const int edges = static_cast<int>(path.size()) - 1;
    assert(technique.s + technique.t == edges + 1 && technique.t >= 1);
    const double own = counts(technique);
    // Densities of the other techniques over that of this one, each times its count: from one
    // technique to its neighbour one vertex changes hands.
    const bool isByLens = technique.t == 1;
    PathWeight weight{own, isByLens ? own : 0.0, isByLens ? 0.0 : own};
    const auto add = [&](int t, double ratio) {
        const Technique other{edges + 1 - t, t};
        if (!(ratio > 0.0 && isPossible(path, other))) return;
        (t == 1 ? weight.byLens : weight.byOthers) += counts(other) * ratio;
    };
    double ratio = 1.0;
    for (int i = technique.t; i <= edges && ratio > 0.0; ++i) {
        const VertexDensity& v = path[static_cast<std::size_t>(i)];
        ratio *= static_cast<double>(v.fromCamera) / static_cast<double>(v.fromLight);
        if (std::isinf(ratio)) return {};
        add(i + 1, ratio);
    }
    ratio = 1.0;
    for (int i = technique.t - 1; i >= 1 && ratio > 0.0; --i) {
        const VertexDensity& v = path[static_cast<std::size_t>(i)];
        ratio *= static_cast<double>(v.fromLight) / static_cast<double>(v.fromCamera);
        if (std::isinf(ratio)) return {};
        add(i, ratio);
    }
    return weight;
}

}  // namespace etendue
