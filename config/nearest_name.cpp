#include <algorithm>

#include "config/config.h"

namespace etendue {
namespace {

/// Insertions, deletions, substitutions and swaps of neighbours that turn a into b: the "optimal
/// string alignment" form of Damerau's distance, three rows of its table at a time.
std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> beforePrevious(b.size() + 1);
    std::vector<std::size_t> previous(b.size() + 1);
    std::vector<std::size_t> current(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) current[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        beforePrevious.swap(previous);
        previous.swap(current);
        current[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substitution = a[i - 1] == b[j - 1] ? 0 : 1;
            current[j] =
                std::min({previous[j] + 1, current[j - 1] + 1, previous[j - 1] + substitution});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                current[j] = std::min(current[j], beforePrevious[j - 2] + 1);
        }
    }
    return current[b.size()];
}

}  // namespace

std::optional<std::string> nearestName(std::string_view name,
                                       const std::vector<std::string>& candidates) {
    std::optional<std::string> nearest;
    std::size_t nearestDistance = 0;
    for (const std::string& candidate : candidates) {
        const auto [shorter, longer] = std::minmax({name.size(), candidate.size()});
        // One letter in three may be wrong, but not all of them.
        const std::size_t allowed = std::max<std::size_t>(longer / 3, 1);
        if (longer - shorter > allowed) continue;  // and spares the work for a very long name
        const std::size_t distance = editDistance(name, candidate);
        if (distance > allowed || distance >= longer) continue;
        if (!nearest || distance < nearestDistance) {
            nearest = candidate;
            nearestDistance = distance;
        }
    }
    return nearest;
}

}  // namespace etendue
