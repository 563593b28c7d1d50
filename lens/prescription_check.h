// What makes a table a lens, and whether it is the lens that its header states.
#pragma once

#include <optional>
#include <string>

#include "lens/prescription.h"

namespace etendue {

struct PrescriptionFault {
    std::optional<std::size_t> surface;  // empty: the lens as a whole
    std::string key;  // as in the file; "nd" stands for whatever names the medium
    std::string message;
};

/// A lens has one stop, refracting surfaces with positive semi-apertures that their conics reach,
/// numbers that are finite, plausible glass, coatings no rarer than what they separate, and
/// surfaces that do not cross within their semi-apertures.
std::optional<PrescriptionFault> findFault(const Prescription& prescription);

/// Relative tolerances to which a table must give what its header states.
constexpr double statedLengthTolerance = 2e-3;   // both lengths, of the focal length
constexpr double statedFNumberTolerance = 2e-2;  // most rims of published tables are estimates

/// For a lens without faults. The message names the numbers, and for a wrong length the single
/// numbers of the table that would put it right.
std::optional<PrescriptionFault> findContradiction(const Prescription& prescription);

}  // namespace etendue
