// etendue lens codegen: a fit as source text for other programs.
#pragma once

#include "lens/code_generation.h"
#include "tools/lens_fit_command.h"

namespace etendue {

struct LensCodegenCommand {
    LensChoice choice;
    FitOptions options;
    CodeLanguage language = CodeLanguage::cPlusPlus;
    std::filesystem::path output;  // empty: standard output
    std::string name;              // in the code; empty: the lens file's
};

ExitCode runLensCodegen(const LensCodegenCommand& command);

}  // namespace etendue
