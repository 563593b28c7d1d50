#include "tools/contender.h"

#include <algorithm>
#include <charconv>

namespace etendue {

std::string nameOf(const Contender& contender) {
    return contender.technique ? contender.kind + ":" + nameOf(*contender.technique)
                               : contender.kind;
}

std::optional<Contender> parseContender(std::string_view text) {
    const std::size_t colon = text.find(':');
    Contender result{std::string(text.substr(0, colon)), {}};
    const std::vector<std::string>& kinds = estimatorKinds();
    if (std::find(kinds.begin(), kinds.end(), result.kind) == kinds.end()) return {};
    if (colon == std::string_view::npos) return result;
    const std::string_view name = text.substr(colon + 1);
    const std::size_t t = name.find('t');
    if (result.kind != "bdpt" || t == std::string_view::npos || !TechniqueSet::parse(name))
        return {};
    Technique technique;
    std::from_chars(name.data() + 1, name.data() + t, technique.s);
    std::from_chars(name.data() + t + 1, name.data() + name.size(), technique.t);
    // No other spelling, and not "t2", which is many.
    if (nameOf(technique) != name) return {};
    result.technique = technique;
    return result;
}

}  // namespace etendue
