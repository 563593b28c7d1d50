#include "tools/lens_slides_table.h"

#include <fmt/format.h>

#include <cstdio>

#include "lens/slides_table.h"
#include "tools/json.h"
#include "tools/lens_choice.h"
#include "tools/progress.h"
#include "tools/text_table.h"

namespace etendue {

namespace {

constexpr std::array<const char*, 4> publishedColumns{"fisheye", "aspheric", "anamorphic",
                                                      "double-gauss"};

struct SlidesEntry {
    std::size_t lens;
    SlidesRow row;
    SlidesResult result;
};

std::string methodName(const SlidesRow& row) {
    switch (row.method) {
        case SlidesMethod::taylor:
            return fmt::format("Taylor {}", row.degree);
        case SlidesMethod::complete:
            return fmt::format("complete {}", row.degree);
        case SlidesMethod::sparse:
            return "sparse";
    }
    return "";
}

std::vector<SlidesEntry> measureAll() {
    std::vector<SlidesEntry> entries;
    for (std::size_t lens = 0; lens < slidesLenses.size(); ++lens) {
        const std::string name(slidesLenses[lens]);
        const SlidesMeasurement measurement(loadPrescription(findLensFile(name)));
        for (const SlidesRow& row : slidesRows()) {
            say(fmt::format("{}, {} ({} coefficients)\n", name, methodName(row), row.coefficients));
            entries.push_back({lens, row, measurement.measure(row)});
        }
    }
    return entries;
}

void printTable(const std::vector<SlidesEntry>& entries) {
    std::vector<std::vector<std::string>> rows{{"lens", "method", "coefficients", "published",
                                                "again", "mul-adds", "two-point", "terms",
                                                "mul-adds"}};
    for (const SlidesEntry& entry : entries)
        rows.push_back({publishedColumns[entry.lens], methodName(entry.row),
                        std::to_string(entry.row.coefficients),
                        fmt::format("{:.2e}", entry.row.published[entry.lens]),
                        fmt::format("{:.2e}", entry.result.again),
                        std::to_string(entry.result.multiplyAdds),
                        fmt::format("{:.2e}", entry.result.twoPoint),
                        std::to_string(entry.result.twoPointTerms),
                        std::to_string(entry.result.twoPointMultiplyAdds)});
    fmt::print("{}", alignedTable(rows, "llrrrrrrr"));
    fmt::print(
        "\nMean squared residual, summed over x and y in mm² and both components of the direction "
        "in sine²,\non the 15000 rays fitted to, transmittance left out. published, again: from "
        "the "
        "sensor state;\ntwo-point: from sensor and aperture point, in the basis of the lens' "
        "symmetry, degree 11.\n");
}

Json jsonOf(const std::vector<SlidesEntry>& entries) {
    Json rows = Json::array();
    for (const SlidesEntry& entry : entries)
        rows.add(Json::object({{"lens", std::string(slidesLenses[entry.lens])},
                               {"method", methodName(entry.row)},
                               {"coefficients", entry.row.coefficients},
                               {"published", entry.row.published[entry.lens]},
                               {"again", entry.result.again},
                               {"multiply_adds", entry.result.multiplyAdds},
                               {"two_point", entry.result.twoPoint},
                               {"two_point_terms", entry.result.twoPointTerms},
                               {"two_point_multiply_adds", entry.result.twoPointMultiplyAdds}}));
    return rows;
}

}  // namespace

ExitCode runSlidesTable(bool asJson) {
    const std::vector<SlidesEntry> entries = measureAll();
    if (asJson)
        fmt::print("{}\n", jsonOf(entries).text());
    else
        printTable(entries);
    return ExitCode::success;
}

}  // namespace etendue
