// LensFit: a lens as polynomials, fitted to its exact trace (docs/fitting).
#pragma once

#include <functional>
#include <string_view>

#include "lens/fit_rays.h"
#include "lens/lens_clip.h"
#include "lens/polynomial_basis.h"
#include "lens/sensor_fits.h"

namespace etendue {

/// twoPoint: (s, a, λ) → pupil position, pupil direction; throughput J τ.
/// sensorState: (s, q, λ) → the same with τ for J τ, and, by a polynomial of its own, → aperture
/// point and slope. The published form.
enum class FitForm { twoPoint, sensorState };

/// All terms of a basis up to a degree instead of a choice: with the axial or two-plane parity what
/// a Taylor expansion would have ("Taylor"), with the basis none all there are ("complete").
constexpr int allTerms = 1 << 20;

struct FitSettings {
    FitForm form = FitForm::twoPoint;
    PolynomialBasis basis = PolynomialBasis::axial;
    int terms = 40;  // per support
    int degree = 11;
    int raysPerCandidate = 10;
    int refinements = 3;  // SparseFitOptions
    ClipSettings clip;

    bool operator==(const FitSettings&) const = default;
};

struct ErrorSummary {
    double rms = 0.0, percentile999 = 0.0, most = 0.0;
};

/// On rays drawn anew. Given (s, a, λ), so that in the sensor-state form the slope is solved for.
struct FitErrors {
    ErrorSummary pupilMm;             // of the point on the pupil sphere, projected
    ErrorSummary directionMrad;       // of the outgoing direction in space
    ErrorSummary sensorMicrometres;   // how far on the sensor that moves the picture
    ErrorSummary throughputRelative;  // of J τ, to the mean over the domain
    ErrorSummary etendue;             // |det| of the fitted map − 1, see etendueDeterminant()
    std::int64_t rays = 0, unsolved = 0;
};

/// To be raised whenever the same prescription, domain and settings come to be fitted otherwise.
constexpr int fitAlgorithmVersion = 6;

/// Of the polynomials of a LensFit, as far as it has them.
constexpr OutputCount exitOutputs{2, 1}, apertureOutputs{2, 0};
constexpr OutputCount startOutputs{2, 0}, slopeOutputs{1, 0};

struct LensFit {
    int algorithm = fitAlgorithmVersion;
    FitSettings settings;
    FitDomain domain;
    std::uint64_t prescriptionHash = 0;
    SparsePolynomial exit;      // vectors: pupil position (mm) and direction; scalar
    SparsePolynomial aperture;  // sensorState only; vectors: aperture point (mm), slope
    ClipFit clip;               // in either form of (s, a, λ)
    ConnectStart start;         // likewise
    SparsePolynomial slope;     // at the sensor, of (s, a, λ); in a domain with a focus range only
    RayCounts training;
    FitErrors errors;
    ClipErrors clipErrors;
};

/// Hears which share of a fit is done, in 0–1, and what is being done; on the calling thread.
using FitProgress = std::function<void(double share, std::string_view stage)>;

/// `settings.raysPerCandidate` rays per candidate monomial, at least 4000 and at most 100,000.
/// Deterministic. Throws std::invalid_argument where no ray passes, and where a steep aspheric
/// front surface sends rays past the pupil sphere.
LensFit fitLens(const Prescription& prescription, const FitDomain& domain,
                const FitSettings& settings, const FitProgress& progress = {});

FitErrors measureErrors(const LensFit& fit, const TracedLens& lens, std::size_t rays,
                        std::uint64_t seed);

}  // namespace etendue
