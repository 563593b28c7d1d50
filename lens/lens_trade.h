// The trade: what a fit of a lens costs, and what it is worth.
#pragma once

#include "lens/lens_fit.h"

namespace etendue {

struct TradeRow {
    FitSettings settings;
    int multiplyAdds = 0;  // of the ray's polynomials, in the sensor-state form of both
    int rimMultiplyAdds = 0;
    FitErrors errors;  // held out
    ClipErrors clipErrors;
    double fitSeconds = 0.0;
    // One ray at a time in double, medians over several runs.
    double evaluationNs = 0.0;  // s, a (or q) and λ → pupil state and its derivatives by s
    double traceNs = 0.0;       // PolynomialLens::trace: domain, rims and, where needed, the slope
    double connectNs = 0.0;     // PolynomialLens::connect, of rays that it finds
    // Rays that the fitted lens' own trace produced, their targets from 10 cm to 1 km away.
    int connectRays = 0;
    int connectFailures = 0;  // connect() found none, or another sensor point
    int twoStepFailures = 0;  // the same of the published search
};

/// Fits the lens and measures the fit. All but the times is deterministic.
TradeRow measureTrade(const Prescription& prescription, const FitDomain& domain,
                      const FitSettings& settings, const FitProgress& progress = {});

/// Of a ray, both polynomials of the sensor-state form.
int rayMultiplyAdds(const LensFit& fit);

}  // namespace etendue
