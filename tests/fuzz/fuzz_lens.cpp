// Lens prescriptions: what loads is a lens, and traces.
#include <cmath>
#include <optional>

#include "config/config.h"
#include "lens/paraxial.h"
#include "lens/prescription.h"
#include "lens/prescription_check.h"
#include "lens/traced_lens.h"
#include "tests/fuzz/lens_checks.h"

using namespace etendue;

namespace {

/// A table that contradicts its header is refused, and chance hardly ever makes one that does not.
/// So the header's line is written anew as the message says that the table has it.
std::optional<std::string> withHeaderMended(const std::string& text, const std::string& message,
                                            const std::filesystem::path& file) {
    constexpr std::string_view states = ": the header states ", gives = ", the table gives ";
    const std::size_t statesAt = message.find(states), givesAt = message.find(gives);
    const std::string place = file.string() + ":";
    if (statesAt == std::string::npos || givesAt == std::string::npos ||
        !message.starts_with(place))
        return {};
    const std::string value = message.substr(
        givesAt + gives.size(),
        message.find_first_of(" ,;", givesAt + gives.size()) - givesAt - gives.size());
    const std::size_t keyAt = message.find(": ") + 2;
    const std::string key = message.substr(keyAt, statesAt - keyAt);
    std::size_t begin = 0;
    for (int line = std::atoi(message.c_str() + place.size()); line > 1; --line) {
        begin = text.find('\n', begin);
        if (begin++ == std::string::npos) return {};
    }
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    return text.substr(0, begin) + key + " = " + value + text.substr(end);
}

void checkLens(const Prescription& p) {
    require(!findFault(p) && !findContradiction(p), "a lens that loads has a fault");
    for (const Surface& surface : p.surfaces)
        for (const double nm : {350.0, 589.0, 1100.0}) {
            const double index = refractiveIndex(surface.behind, nm);
            require(std::isfinite(index) && index >= 1.0, "an index is below 1 or not finite");
        }
    require(!findFault(scaled(p, 2.0)), "a lens that loads has a fault at twice the size");
    const auto lens = makeTracedLens(p);
    const double reach = 0.4 * p.stated.focalLengthYMm;
    checkRays(*lens, {reach, reach}, 400.0, 700.0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const FuzzFolder folder;
    std::string text(textOf(data, size));
    constexpr int mostMendings = 6;  // four lengths and the f-number
    for (int i = 0; i <= mostMendings; ++i) {
        const std::filesystem::path file = folder.write("lens.toml", text);
        try {
            const std::vector<Prescription> lenses = loadPrescriptions(file);
            const std::vector<Prescription> again = loadPrescriptions(file);
            require(lenses.size() == again.size(), "a lens loads in two ways");
            for (std::size_t zoom = 0; zoom < lenses.size(); ++zoom) {
                require(contentHash(lenses[zoom]) == contentHash(again[zoom]),
                        "a lens loads in two ways");
                checkLens(lenses[zoom]);
            }
            return 0;
        } catch (const InputError& error) {
            auto mended = withHeaderMended(text, error.what(), file);
            if (!mended) return 0;
            text = *std::move(mended);
        }
    }
    return 0;
}
