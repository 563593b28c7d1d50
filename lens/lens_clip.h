// Clipping: which rays a lens' rims block and which are totally reflected, as polynomials of where
// a ray starts and where it crosses the stop, so that it is known without tracing.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "lens/fit_rays.h"
#include "lens/polynomial_basis.h"

namespace etendue {

/// A ray passes if on each of `surfaces` its squared height, in units of the squared semi-aperture,
/// is at most 1, and behind each of `reflecting` the squared sine of refraction. The stop is not
/// among them: the aperture point is known.
struct ClipFit {
    std::vector<std::size_t> surfaces, reflecting;  // of the prescription, ascending
    SparsePolynomial squares;  // of (s, a, λ): a scalar for each surface, then for each reflecting

    std::size_t count() const { return surfaces.size() + reflecting.size(); }
};

struct ClipErrors {
    double wronglyAccepted = 0.0;  // share of the accepted that the exact trace blocks
    double wronglyBlocked = 0.0;   // share, of those that it lets through, of the not accepted
};

struct ClipSettings {
    int terms = 32;
    int degree = 11;
    std::size_t rays = 6000;

    bool operator==(const ClipSettings&) const = default;
};

/// The outermost and the rear surface, and as many others, for their rims or for total reflection,
/// as it takes for the rays that these accept and another ends to be one in 2000. At most
/// mostOutputs (polynomial.h).
ClipFit fitClip(const TracedLens& lens, const FitDomain& domain, PolynomialBasis basis,
                const ClipSettings& settings = {});

/// Of the polynomial's values `squares` the largest, or NaN if one is.
inline double highestSquare(std::span<const double> squares) {
    double highest = 0.0;
    for (const double squared : squares) {
        if (std::isnan(squared)) return squared;
        highest = std::max(highest, squared);
    }
    return highest;
}
inline bool passesRims(std::span<const double> squares) { return highestSquare(squares) <= 1.0; }

/// On `rays` queries drawn anew.
ClipErrors measureClip(const ClipFit& clip, const TracedLens& lens, const FitDomain& domain,
                       std::size_t rays, std::uint64_t seed);

}  // namespace etendue
