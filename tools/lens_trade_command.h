// etendue lens trade: what fits of lenses cost against what they are worth.
#pragma once

#include "config/config.h"
#include "lens/lens_trade.h"
#include "tools/lens_choice.h"

namespace etendue {

struct LensTradeCommand {
    std::vector<std::string> lenses;
    LensChoice choice;  // how each of them is set
    std::vector<int> terms = {4, 8, 16, 28, 40, 64};
    std::vector<int> degrees = {7, 11};
    std::vector<PolynomialBasis> bases;  // empty: the lens' own symmetry, and the published one
    std::vector<FitForm> forms = {FitForm::twoPoint, FitForm::sensorState};
    bool slides = false;  // the published table instead
    std::filesystem::path csv, plot;
    bool asJson = false;
};

ExitCode runLensTrade(const LensTradeCommand& command);

}  // namespace etendue
