// Whether a polynomial or a fit that comes from elsewhere is built as those that are fitted here:
// evaluators rely on it.
#pragma once

#include <optional>
#include <string>

#include "lens/lens_fit.h"

namespace etendue {

/// What is wrong: each output must be in one group, grouped as candidateTerms() groups them, with a
/// finite coefficient for each term, and exponents must be those of the basis.
std::optional<std::string> findFault(const SparsePolynomial& polynomial);

/// Also where a polynomial lacks outputs that its fit is asked for, or has others, or the domain is
/// empty.
std::optional<std::string> findFault(const LensFit& fit);

}  // namespace etendue
