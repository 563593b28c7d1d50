// The matrix of agreement, as text and as JSON.
#pragma once

#include "config/config.h"
#include "tools/agreement.h"
#include "tools/json.h"

namespace etendue {

/// One comparison, or why there is none.
struct AgreementRow {
    std::string scene, camera, estimator, reference;  // both as nameOf(Contender)
    std::optional<Agreement> result{};
    std::string failure{};      // why it was not done; empty: it was, or it was not reached
    bool isIncomplete = false;  // a technique that does not make all of the light here
};

/// "cornell-box, thin-lens, lt against pt".
std::string titleOf(const AgreementRow& row);
/// "agree, +0.012 ± 0.150 %".
std::string outcomeOf(const AgreementRow& row);

/// The table, what was left out of which comparison, and what the words mean.
std::string agreementText(const std::vector<AgreementRow>& rows, const AgreementSettings& settings);
Json agreementJson(const std::vector<AgreementRow>& rows, const AgreementSettings& settings);

/// Failure if any row differs or fewer than `mustAgree` agree, else bad input if any was not done,
/// else stopped early if some are missing.
ExitCode exitCodeOf(const std::vector<AgreementRow>& rows, int mustAgree = 0);

}  // namespace etendue
