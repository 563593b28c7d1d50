// Fit files: what loads is written again as it was, and as a lens gives rays or none.
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "lens/fit_file.h"
#include "lens/hash.h"
#include "lens/polynomial_lens.h"
#include "tests/fuzz/lens_checks.h"

using namespace etendue;

namespace {

/// The file with the checksum that its content has, or as it is where it has none to speak of:
/// behind the checksum is where the reader's work begins.
std::string withChecksum(std::string_view text) {
    using Json = nlohmann::json;
    try {
        const auto isShallow = [](int depth, Json::parse_event_t, Json&) {
            if (depth > 12) throw std::runtime_error("deep");
            return true;
        };
        Json json = Json::parse(text, isShallow);
        std::ostringstream checksum;
        checksum << std::hex << fnv1a(json.at("fit").dump());
        json["checksum"] = checksum.str();
        return json.dump();
    } catch (const std::exception&) {
        return std::string(text);
    }
}

Prescription tessar() {
    const std::filesystem::path here = std::filesystem::path(__FILE__).parent_path();
    return loadPrescription(here / "../../scenes/lenses/tessar-100mm.toml");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const FuzzFolder folder;
    static const Prescription prescription = tessar();
    FitFileContent content =
        readFitFile(folder.write("fit.json", withChecksum(textOf(data, size))));
    require(content.fit.has_value() != !content.refusal.empty(), "a fit and a refusal, or neither");
    if (!content.fit) return 0;
    LensFit& fit = *content.fit;
    const std::string written = fitFileText(fit);
    const FitFileContent again = readFitFile(folder.write("again.json", written));
    require(again.fit && fitFileText(*again.fit) == written, "a fit that was read is not written");

    fit.prescriptionHash = contentHash(prescription);
    const Aperture aperture(fit.domain.apertureRadiusMm);
    const PolynomialLens lens(prescription, fit, aperture);
    checkRays(lens, fit.domain.sensorHalfSizeMm, fit.domain.shortestWavelengthNm,
              fit.domain.longestWavelengthNm);
    return 0;
}
