// Config::set: "camera.f_number=2.8" on the command line.
#include <algorithm>
#include <charconv>

#include "config/config.h"
#include "config/config_node.h"
#include "config/wording.h"

namespace etendue {
namespace {

using Source = std::shared_ptr<const ConfigSource>;

[[noreturn]] void fail(const Source& source, const std::string& message) {
    throw InputError(source->name + ": " + message);
}

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
    const std::size_t end = text.find_last_not_of(" \t") + 1;  // npos + 1 is 0
    return text.substr(begin, std::max(begin, end) - begin);
}

/// The first of `stops` outside quotes, or the text's end.
std::size_t findUnquoted(std::string_view text, std::string_view stops) {
    char openQuote = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (openQuote) {
            if (text[at] == openQuote) openQuote = 0;
        } else if (text[at] == '"' || text[at] == '\'') {
            openQuote = text[at];
        } else if (stops.find(text[at]) != std::string_view::npos) {
            return at;
        }
    }
    return text.size();
}

/// material."red.glass".ior: three keys. What stands between quotes is taken as it is, and so is a
/// key that TOML would want in quotes.
std::vector<std::string> splitKey(std::string_view dotted, const Source& source) {
    std::vector<std::string> keys;
    for (bool isLast = false; !isLast;) {
        const std::size_t dot = findUnquoted(dotted, ".");
        std::string_view key = trimmed(dotted.substr(0, dot));
        if (key.empty()) fail(source, "expected key=value, with no empty part in the dotted key");
        const bool isQuoted = key.size() >= 2 && key.front() == key.back() &&
                              (key.front() == '"' || key.front() == '\'');
        keys.emplace_back(isQuoted ? key.substr(1, key.size() - 2) : key);
        isLast = dot == dotted.size();
        if (!isLast) dotted.remove_prefix(dot + 1);
    }
    if (keys.size() > maxConfigDepth)
        fail(source, "a key of more than " + std::to_string(maxConfigDepth) + " parts");
    return keys;
}

/// Not begun as a quoted string, an array or a table, so that a slip in one of those is told.
bool isBareWord(std::string_view text) {
    constexpr std::string_view openings = "\"'[{";
    return openings.find(text.front()) == std::string_view::npos &&
           std::all_of(text.begin(), text.end(), [](char c) {
               const auto byte = static_cast<unsigned char>(c);
               return byte >= 0x20 && byte != 0x7f;
           });
}

ConfigNode parseValue(std::string_view text, const Source& source, std::size_t depth) {
    if (text.empty()) fail(source, "expected a value after '=' (\"\" for an empty string)");
    try {
        const ConfigNode document =
            parseToml("value = " + std::string(text), source, depth > 0 ? depth - 1 : 0);
        const auto& table = std::get<ConfigNode::Table>(document.value);
        if (table.entries.size() != 1) fail(source, "expected one value after '='");
        return table.entries.front().second;
    } catch (const InputError&) {
        if (!isBareWord(text)) throw;
        return ConfigNode{std::string(text), source, 1};
    }
}

std::string nameOf(const ConfigNode& entry) {
    const auto* table = std::get_if<ConfigNode::Table>(&entry.value);
    const ConfigNode* name = table ? table->find("name") : nullptr;
    const auto* text = name ? std::get_if<std::string>(&name->value) : nullptr;
    return text ? *text : "";
}

/// The array's only entry of that name, else the one with that index.
ConfigNode& entryOf(ConfigNode::Array& array, const std::string& key, const std::string& path,
                    const Source& source) {
    ConfigNode* found = nullptr;
    std::vector<std::string> names;
    for (ConfigNode& entry : array) {
        names.push_back(nameOf(entry));
        if (names.back() != key) continue;
        if (found) fail(source, path + ": more than one entry is named " + inQuotes(key));
        found = &entry;
    }
    if (found) return *found;

    std::size_t index = array.size();
    const auto parsed = std::from_chars(key.data(), key.data() + key.size(), index);
    if (parsed.ec == std::errc() && parsed.ptr == key.data() + key.size() && index < array.size())
        return array[index];

    std::erase(names, "");
    const std::string nearest = suggestion(key, names);
    std::string message = path + ": no entry " + inQuotes(key) + nearest;
    if (array.empty()) fail(source, message + "; it is empty");
    message += "; entries are 0 to " + std::to_string(array.size() - 1);
    if (nearest.empty() && !names.empty()) message += " or " + listNames(names);
    fail(source, message);
}

/// The value under `key`; in a table an empty one is made where there is none.
ConfigNode& childOf(ConfigNode& parent, const std::string& key, const std::string& path,
                    const Source& source) {
    if (auto* array = std::get_if<ConfigNode::Array>(&parent.value))
        return entryOf(*array, key, path, source);
    if (auto* table = std::get_if<ConfigNode::Table>(&parent.value)) {
        ConfigNode* child = table->find(key);
        return child ? *child : table->add(key, ConfigNode{ConfigNode::Table{}, source, 1});
    }
    fail(source, path + ": has no key " + inQuotes(key) + ": it is " + describe(parent) +
                     ", set at " + parent.where());
}

}  // namespace

std::string overrideName(std::string_view assignment) { return "-s " + printable(assignment, 200); }

void Config::set(std::string_view assignment) {
    std::error_code ignored;  // without a current folder relative names stay as they are
    const Source source = std::make_shared<const ConfigSource>(
        ConfigSource{overrideName(assignment), std::filesystem::current_path(ignored), true});
    const std::size_t equals = findUnquoted(assignment, "=");
    if (equals == assignment.size()) fail(source, "expected key=value");
    const std::vector<std::string> keys = splitKey(assignment.substr(0, equals), source);

    ConfigNode changed = *root_;
    ConfigNode* target = &changed;
    std::string path;
    for (const std::string& key : keys) {
        target = &childOf(*target, key, path, source);
        path = joinPath(path, key);
    }
    *target = parseValue(trimmed(assignment.substr(equals + 1)), source, keys.size());
    root_ = std::make_shared<const ConfigNode>(std::move(changed));
}

}  // namespace etendue
