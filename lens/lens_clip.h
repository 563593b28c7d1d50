// Clipping: which rays a lens' rims block, as polynomials of where a ray starts and where it
// crosses the stop, so that it is known without tracing.
#pragma once

#include <span>

#include "lens/fit_rays.h"
#include "lens/polynomial_basis.h"

namespace etendue {

/// A ray passes the rims if on each of these surfaces its squared height, in units of the squared
/// semi-aperture, is at most 1. The stop is not among them: the aperture point is known.
struct ClipFit {
    std::vector<std::size_t> surfaces;  // of the prescription, ascending
    SparsePolynomial squaredHeights;    // of (s, a, λ): a scalar for each surface
};

struct ClipErrors {
    double wronglyAccepted = 0.0;  // share of the accepted that the exact trace blocks
    double wronglyBlocked = 0.0;   // share, of those that it lets through, of the not accepted
};

struct ClipSettings {
    int terms = 32;
    int degree = 9;
    std::size_t rays = 6000;

    bool operator==(const ClipSettings&) const = default;
};

/// The outermost and the rear surface, and as many between as it takes for the rays that these
/// accept and another blocks to be one in 2000. At most mostOutputs (polynomial.h).
ClipFit fitClip(const TracedLens& lens, const FitDomain& domain, PolynomialBasis basis,
                const ClipSettings& settings = {});

/// `squaredHeights`: the polynomial's values.
inline bool passesRims(std::span<const double> squaredHeights) {
    for (const double squared : squaredHeights)
        if (!(squared <= 1.0)) return false;
    return true;
}

/// On `rays` queries drawn anew, folded rays left out.
ClipErrors measureClip(const ClipFit& clip, const TracedLens& lens, const FitDomain& domain,
                       std::size_t rays, std::uint64_t seed);

}  // namespace etendue
