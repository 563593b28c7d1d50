// Contender: an estimator that takes part in a comparison, or one of its techniques alone.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "renderer/estimator.h"

namespace etendue {

struct Contender {
    std::string kind = "pt";  // of makeEstimator
    /// Of bdpt, alone and not weighted: an estimate of the light that comes by paths of its length.
    std::optional<Technique> technique;

    /// Whether it has techniques that connect to the lens, and no others.
    bool isLightTracing() const { return kind == "lt" || (technique && technique->t == 1); }
    /// Whether it finds a light of extent behind a mirror by meeting it alone.
    bool meetsLights() const { return kind == "pt" || (technique && technique->s == 0); }
};

/// Whether they make paths of one length.
inline bool isAsLong(Technique a, Technique b) { return a.s + a.t == b.s + b.t; }

/// "lt", "bdpt:s2t1".
std::string nameOf(const Contender& contender);
/// Empty when the text names none.
std::optional<Contender> parseContender(std::string_view text);

}  // namespace etendue
