#include "tools/lens_codegen_command.h"

#include <fmt/format.h>

#include "tools/write_file.h"

namespace etendue {

ExitCode runLensCodegen(const LensCodegenCommand& command) {
    checkWritable(command.output);
    checkDistinct({{"-o", command.output}}, {{"the lens", findLensFile(command.choice.lens)}});
    const Prescription prescription = loadPrescription(command.choice);
    const ObtainedFit obtained = obtainFit(prescription, command.choice, command.options);
    const std::string name =
        command.name.empty() ? findLensFile(command.choice.lens).stem().string() : command.name;
    const std::string code = generateCode(obtained.fit, prescription, command.language, name);
    if (command.output.empty())
        fmt::print("{}", code);
    else
        writeWholeFile(command.output, code);
    return ExitCode::success;
}

}  // namespace etendue
