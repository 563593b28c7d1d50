#include "config/wording.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace etendue {
namespace {

/// The shortest text that reads back as the same number.
std::string numberText(double number) {
    std::array<char, 32> buffer;
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
    return {buffer.data(), end};
}

std::string escaped(char c) {
    constexpr std::string_view hex = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7f) return {c};
    if (c == '\n') return "\\n";
    if (c == '\t') return "\\t";
    return {'\\', 'x', hex[byte >> 4], hex[byte & 15]};
}

bool isBareKey(std::string_view key) {
    return !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
        return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || ('0' <= c && c <= '9') ||
               c == '_' || c == '-';
    });
}

/// A finite number, and so large or small that only an unsaid end of a range can refuse it.
bool isExtreme(const ConfigNode& node) {
    const double* number = std::get_if<double>(&node.value);
    if (!number || !std::isfinite(*number) || *number == 0.0) return false;
    const double size = std::abs(*number);
    return size > Range::positive().highest || size < Range::positive().lowest;
}

}  // namespace

std::string printable(std::string_view text, std::size_t mostBytes) {
    std::size_t end = std::min(text.size(), mostBytes);
    const auto continuesCharacter = [text](std::size_t at) {
        return (static_cast<unsigned char>(text[at]) & 0xC0) == 0x80;
    };
    if (end < text.size())
        while (end > 0 && continuesCharacter(end)) --end;
    std::string result;
    for (const char c : text.substr(0, end)) result += escaped(c);
    if (end < text.size()) result += "...";
    return result;
}

std::string inQuotes(std::string_view text) { return '"' + printable(text, 60) + '"'; }

std::string joinPath(std::string_view path, std::string_view key) {
    std::string result(path);
    if (!path.empty()) result += '.';
    return result + (isBareKey(key) ? printable(key, 60) : inQuotes(key));
}

std::string indexPath(std::string_view path, std::size_t index) {
    return std::string(path) + '[' + std::to_string(index) + ']';
}

std::string listNames(const std::vector<std::string>& names) {
    constexpr std::size_t most = 20;
    std::string result;
    for (std::size_t i = 0; i < std::min(names.size(), most); ++i)
        result += (i > 0 ? ", '" : "'") + printable(names[i], 60) + '\'';
    return names.size() > most ? result + ", ..." : result;
}

std::string suggestion(std::string_view name, const std::vector<std::string>& candidates) {
    const auto nearest = nearestName(name, candidates);
    return nearest ? "; did you mean '" + printable(*nearest, 60) + "'?" : "";
}

std::string describe(const ConfigNode& node) {
    struct Describer {
        std::string operator()(const ConfigNode::Table&) const { return "a table"; }
        std::string operator()(const ConfigNode::Array& array) const {
            if (array.empty()) return "an empty array";
            return array.size() == 1 ? "an array of 1 value"
                                     : "an array of " + std::to_string(array.size()) + " values";
        }
        std::string operator()(const std::string& text) const { return inQuotes(text); }
        std::string operator()(std::int64_t integer) const { return std::to_string(integer); }
        std::string operator()(double number) const {
            const std::string text = numberText(number);
            // 2.0 must not look like the integer 2.
            return text.find_first_not_of("-0123456789") == std::string::npos ? text + ".0" : text;
        }
        std::string operator()(bool boolean) const { return boolean ? "true" : "false"; }
        std::string operator()(ConfigNode::DateOrTime) const { return "a date or time"; }
    };
    return std::visit(Describer{}, node.value);
}

std::string describe(NumberKind kind, Range range, const ConfigNode* found) {
    const bool sayAll = found && isExtreme(*found);
    const bool hasHighest = range.highest < Range::any().highest || sayAll;
    const bool hasLowest = range.lowest > Range::any().lowest || sayAll;
    const bool isPositive =
        0.0 < range.lowest && range.lowest <= Range::positive().lowest && !sayAll;

    const std::string noun = kind == NumberKind::integer ? "integer" : "number";
    const std::string article = kind == NumberKind::integer ? "an " : "a ";
    std::string result = isPositive ? "a positive " + noun : article + noun;
    if (hasLowest && !isPositive && hasHighest)
        result += " from " + numberText(range.lowest) + " to " + numberText(range.highest);
    else if (hasLowest && !isPositive)
        result += " of at least " + numberText(range.lowest);
    else if (hasHighest)
        result += " of at most " + numberText(range.highest);
    return range.highest == Range::infinity && !sayAll ? result + " or inf" : result;
}

}  // namespace etendue
