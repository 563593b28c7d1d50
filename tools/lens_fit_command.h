// etendue lens fit: polynomials for a lens, and how far off they are.
#pragma once

#include "config/config.h"
#include "lens/lens_fit.h"
#include "tools/json.h"
#include "tools/lens_choice.h"

namespace etendue {

struct FitOptions {
    std::optional<PolynomialBasis> basis;  // empty: by the lens' own symmetry
    FitForm form = FitForm::twoPoint;
    int terms = 40;
    int degree = 11;
    std::vector<double> wavelengthsNm = {400.0, 700.0};  // the shortest and the longest
};

struct LensFitCommand {
    LensChoice choice;
    FitOptions options;
    std::filesystem::path output;  // empty: the cache alone
    bool asJson = false;
};

/// As --form names it.
const char* formName(FitForm form);

/// The basis that is wanted, or that of the lens' symmetry. Throws InputError (usage) where the one
/// wanted does not suit the lens.
PolynomialBasis basisFor(const Prescription& prescription, std::optional<PolynomialBasis> wanted);

/// A fit, and how it was come by.
struct ObtainedFit {
    LensFit fit;
    double seconds;
    bool isFromCache;
    std::filesystem::path cacheFile;  // empty without a cache
};
/// From the cache, or made and kept there; what takes time is told on standard error. Throws
/// InputError (usage) where the basis does not suit the lens.
ObtainedFit obtainFit(const Prescription& prescription, const LensChoice& choice,
                      const FitOptions& options);

/// One row of the error report: the summary in `unit`.
struct FitErrorRow {
    std::string label, unit, key;
    ErrorSummary summary;
};
std::vector<FitErrorRow> errorRows(const FitErrors& errors);

/// "two-point, axial basis, 40 terms of degree 11 at most".
std::string describe(const FitSettings& settings);
std::string describe(const FitDomain& domain);
/// "240 multiply-adds for the ray, 190 for the rims".
std::string describeCost(const LensFit& fit);

Json jsonOf(const LensFit& fit);

ExitCode runLensFit(const LensFitCommand& command);

}  // namespace etendue
