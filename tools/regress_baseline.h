// The baseline of regression tests: what each estimator's noise was when it was last agreed to, and
// how sharply each is judged. docs/regression.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "statistics/bootstrap.h"

namespace etendue {

/// One estimator in one scene through one camera.
struct RegressCell {
    std::string scene, camera, estimator;
    friend auto operator<=>(const RegressCell&, const RegressCell&) = default;
};
/// "cornell-box, thin-lens, lt".
std::string titleOf(const RegressCell& cell);

struct BaselineRow {
    RegressCell cell;
    // Decided by people, or when the row was made:
    std::uint32_t samples = 16;       // per pixel of each picture
    std::optional<double> biasBound;  // of the relative bias; none: noise hides too much
    bool judgesRate = true;           // false: the samples cannot tell the slope
    // Measured:
    double noise = 0.0;  // relMSE × samples
    Interval interval;   // 99 %
};

struct Baseline {
    std::vector<BaselineRow> rows;  // sorted by cell

    const BaselineRow* of(const RegressCell& cell) const;
    /// Adds the row or replaces the cell's.
    void put(const BaselineRow& row);
};

/// Throws InputError: not there, not TOML, of other keys.
Baseline readBaseline(const std::filesystem::path& file);
std::string baselineText(const Baseline& baseline);

}  // namespace etendue
