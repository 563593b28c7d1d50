// ConfigTable: the getters.
#include <set>

#include "config/config.h"
#include "config/config_node.h"
#include "config/wording.h"

namespace etendue {

struct ConfigTable::Known {
    std::set<std::string, std::less<>> keys;  // that a getter has asked for
    std::string entry;  // the innermost enclosing array entry's `name`, for messages
};

struct ConfigTable::Item {
    const ConfigNode& node;
    std::string path;
};

namespace {

const ConfigNode::Table& tableOf(const ConfigNode& node) {
    return std::get<ConfigNode::Table>(node.value);
}

std::optional<double> numberIn(const ConfigNode& node, Range range) {
    const auto* integer = std::get_if<std::int64_t>(&node.value);
    const auto* number = std::get_if<double>(&node.value);
    if (!integer && !number) return std::nullopt;
    const double value = integer ? static_cast<double>(*integer) : *number;
    // False for NaN.
    const bool isInside = range.lowest <= value && value <= range.highest;
    return isInside ? std::optional(value) : std::nullopt;
}

std::string numbersText(std::size_t count, Range range) {
    const std::string each = "each " + describe(NumberKind::number, range);
    return count == 0 ? "an array, " + each : "an array of " + std::to_string(count) + ", " + each;
}

std::string choiceText(const std::vector<std::string>& names) {
    if (names.empty()) return "one of the names defined here (there are none)";
    std::string result = "one of ";
    for (const std::string& name : names)
        result += (&name == names.data() ? "" : ", ") + inQuotes(name);
    return result;
}

}  // namespace

ConfigTable::ConfigTable(std::shared_ptr<const ConfigNode> node, std::string path)
    : node_(std::move(node)), path_(std::move(path)), known_(std::make_shared<Known>()) {}

const ConfigNode* ConfigTable::find(std::string_view key) const {
    known_->keys.emplace(key);
    return tableOf(*node_).find(key);
}

const ConfigNode& ConfigTable::require(std::string_view key, const std::string& expected) const {
    if (const ConfigNode* node = find(key)) return *node;
    std::vector<std::string> unread;
    for (std::string& name : keys())
        if (!known_->keys.contains(name)) unread.push_back(std::move(name));
    std::string message = "missing, expected " + expected;
    if (const auto slip = nearestName(key, unread))
        message += "; is it '" + printable(*slip, 60) + "' at " +
                   tableOf(*node_).find(*slip)->where() + "?";
    failAt(*node_, joinPath(path_, key), message);
}

void ConfigTable::failAt(const ConfigNode& node, const std::string& path,
                         const std::string& message, ExitCode code) const {
    std::string place = node.where() + ": ";
    if (!path.empty()) place += path;
    if (!known_->entry.empty()) place += " (" + inQuotes(known_->entry) + ")";
    throw InputError(place + (path.empty() ? "" : ": ") + message, code);
}

void ConfigTable::failType(const ConfigNode& node, const std::string& path,
                           const std::string& expected) const {
    failAt(node, path, "expected " + expected + ", got " + describe(node));
}

bool ConfigTable::has(std::string_view key) const { return find(key) != nullptr; }

std::vector<std::string> ConfigTable::keys() const {
    std::vector<std::string> result;
    for (const auto& [key, value] : tableOf(*node_).entries) result.push_back(key);
    return result;
}

double ConfigTable::number(std::string_view key, Range range) const {
    const ConfigNode& node = require(key, describe(NumberKind::number, range));
    if (const auto value = numberIn(node, range)) return *value;
    failType(node, joinPath(path_, key), describe(NumberKind::number, range, &node));
}

double ConfigTable::number(std::string_view key, Range range, double fallback) const {
    return has(key) ? number(key, range) : fallback;
}

std::int64_t ConfigTable::integer(std::string_view key, Range range) const {
    const ConfigNode& node = require(key, describe(NumberKind::integer, range));
    // Extended precision holds every 64-bit integer and every double.
    if (const auto* value = std::get_if<std::int64_t>(&node.value))
        if (const auto exact = static_cast<long double>(*value);
            range.lowest <= exact && exact <= range.highest)
            return *value;
    failType(node, joinPath(path_, key), describe(NumberKind::integer, range));
}

std::int64_t ConfigTable::integer(std::string_view key, Range range, std::int64_t fallback) const {
    return has(key) ? integer(key, range) : fallback;
}

bool ConfigTable::boolean(std::string_view key, bool fallback) const {
    const ConfigNode* node = find(key);
    if (!node) return fallback;
    if (const auto* value = std::get_if<bool>(&node->value)) return *value;
    failType(*node, joinPath(path_, key), "true or false");
}

std::string ConfigTable::text(std::string_view key) const {
    const ConfigNode& node = require(key, "a string");
    if (const auto* value = std::get_if<std::string>(&node.value)) return *value;
    failType(node, joinPath(path_, key), "a string");
}

std::string ConfigTable::text(std::string_view key, std::string_view fallback) const {
    return has(key) ? text(key) : std::string(fallback);
}

std::string ConfigTable::choice(std::string_view key, const std::vector<std::string>& names) const {
    const ConfigNode& node = require(key, choiceText(names));
    const auto* value = std::get_if<std::string>(&node.value);
    if (!value) failType(node, joinPath(path_, key), choiceText(names));
    for (const std::string& name : names)
        if (name == *value) return name;
    failAt(
        node, joinPath(path_, key),
        "expected " + choiceText(names) + ", got " + inQuotes(*value) + suggestion(*value, names));
}

std::string ConfigTable::choice(std::string_view key, const std::vector<std::string>& names,
                                std::string_view fallback) const {
    return has(key) ? choice(key, names) : std::string(fallback);
}

std::vector<double> ConfigTable::numbersIn(const ConfigNode& node, const std::string& path,
                                           std::size_t count, Range range) const {
    const auto* array = std::get_if<ConfigNode::Array>(&node.value);
    if (!array || (count != 0 && array->size() != count))
        failType(node, path, numbersText(count, range));
    std::vector<double> result;
    for (const ConfigNode& element : *array) {
        const auto value = numberIn(element, range);
        if (!value)
            failType(element, indexPath(path, result.size()),
                     describe(NumberKind::number, range, &element));
        result.push_back(*value);
    }
    return result;
}

std::vector<double> ConfigTable::numbers(std::string_view key, std::size_t count,
                                         Range range) const {
    return numbersIn(require(key, numbersText(count, range)), joinPath(path_, key), count, range);
}

std::vector<std::vector<double>> ConfigTable::rows(std::string_view key, std::size_t columns,
                                                   Range range) const {
    const std::string expected = "an array of rows, each " + numbersText(columns, range);
    const ConfigNode& node = require(key, expected);
    const std::string path = joinPath(path_, key);
    const auto* array = std::get_if<ConfigNode::Array>(&node.value);
    if (!array) failType(node, path, expected);
    std::vector<std::vector<double>> result;
    for (const ConfigNode& row : *array)
        result.push_back(numbersIn(row, indexPath(path, result.size()), columns, range));
    return result;
}

std::vector<ConfigTable::Item> ConfigTable::textItems(std::string_view key) const {
    std::vector<Item> result;
    const ConfigNode* node = find(key);
    if (!node) return result;
    const std::string path = joinPath(path_, key);
    const auto* array = std::get_if<ConfigNode::Array>(&node->value);
    if (!array) {
        result.push_back({*node, path});
    } else {
        for (const ConfigNode& element : *array)
            result.push_back({element, indexPath(path, result.size())});
    }
    for (const Item& item : result)
        if (!std::holds_alternative<std::string>(item.node.value))
            failType(item.node, item.path, array ? "a string" : "a string or an array of them");
    return result;
}

std::vector<std::string> ConfigTable::texts(std::string_view key) const {
    std::vector<std::string> result;
    for (const Item& item : textItems(key))
        result.push_back(std::get<std::string>(item.node.value));
    return result;
}

std::filesystem::path ConfigTable::existingFile(const Item& item) const {
    const auto* name = std::get_if<std::string>(&item.node.value);
    // A zero byte would end the name for the system, and another file be opened.
    if (!name || name->empty() || name->find('\0') != std::string::npos)
        failType(item.node, item.path, "a file name in quotes");
    const std::filesystem::path file = (item.node.source->folder / *name).lexically_normal();
    std::error_code ignored;  // any failure to look is told by missingFileError
    const auto status = std::filesystem::status(file, ignored);
    if (!std::filesystem::exists(status) || std::filesystem::is_directory(status))
        failAt(item.node, item.path, missingFileError(file).what(), ExitCode::missingFile);
    return file;
}

std::filesystem::path ConfigTable::file(std::string_view key) const {
    return existingFile({require(key, "a file name"), joinPath(path_, key)});
}

std::vector<std::filesystem::path> ConfigTable::files(std::string_view key) const {
    std::vector<std::filesystem::path> result;
    for (const Item& item : textItems(key)) result.push_back(existingFile(item));
    return result;
}

bool ConfigTable::isArray(std::string_view key) const {
    const ConfigNode* node = find(key);
    const auto* array = node ? std::get_if<ConfigNode::Array>(&node->value) : nullptr;
    if (!array) return false;
    for (const ConfigNode& element : *array)
        if (!std::holds_alternative<double>(element.value) &&
            !std::holds_alternative<std::int64_t>(element.value))
            return false;
    return true;
}

bool ConfigTable::isText(std::string_view key) const {
    const ConfigNode* node = find(key);
    return node && std::holds_alternative<std::string>(node->value);
}

ConfigTable ConfigTable::table(std::string_view key) const {
    const ConfigNode* node = find(key);
    const std::string path = joinPath(path_, key);
    if (node && !std::holds_alternative<ConfigNode::Table>(node->value))
        failType(*node, path, "a table");
    const auto shared = node ? std::shared_ptr<const ConfigNode>(node_, node)
                             : std::make_shared<const ConfigNode>(
                                   ConfigNode{ConfigNode::Table{}, node_->source, node_->line});
    ConfigTable result(shared, path);
    result.known_->entry = known_->entry;
    return result;
}

std::vector<ConfigTable> ConfigTable::tables(std::string_view key) const {
    std::vector<ConfigTable> result;
    const ConfigNode* node = find(key);
    if (!node) return result;
    const std::string path = joinPath(path_, key);
    const auto* array = std::get_if<ConfigNode::Array>(&node->value);
    if (!array) failType(*node, path, "an array of tables, [[" + path + "]]");
    for (const ConfigNode& element : *array) {
        const std::string entryPath = indexPath(path, result.size());
        const auto* table = std::get_if<ConfigNode::Table>(&element.value);
        if (!table) failType(element, entryPath, "a table");
        ConfigTable entry(std::shared_ptr<const ConfigNode>(node_, &element), entryPath);
        const ConfigNode* name = table->find("name");
        const auto* text = name ? std::get_if<std::string>(&name->value) : nullptr;
        entry.known_->entry = text ? *text : known_->entry;
        result.push_back(std::move(entry));
    }
    return result;
}

void ConfigTable::finish() const {
    for (const auto& [key, value] : tableOf(*node_).entries) {
        if (known_->keys.contains(key)) continue;
        const std::vector<std::string> names(known_->keys.begin(), known_->keys.end());
        std::string hint = suggestion(key, names);
        if (hint.empty())
            hint = names.empty() ? "; none is known here" : "; known are " + listNames(names);
        failAt(value, joinPath(path_, key), "unknown key" + hint);
    }
}

void ConfigTable::fail(std::string_view key, const std::string& message, ExitCode code) const {
    const ConfigNode* node = key.empty() ? nullptr : tableOf(*node_).find(key);
    failAt(node ? *node : *node_, key.empty() ? path_ : joinPath(path_, key), message, code);
}

void ConfigTable::failEntry(std::string_view key, std::size_t index, const std::string& message,
                            ExitCode code) const {
    const Item item = textItems(key).at(index);
    failAt(item.node, item.path, message, code);
}

void ConfigTable::failNamedFile(std::string_view key, const InputError& error) const {
    const ConfigNode* node = find(key);
    throw InputError(std::string(error.what()) + " (named by " + (node ? *node : *node_).where() +
                         ", " + joinPath(path_, key) + ")",
                     error.code());
}

std::string ConfigTable::where() const { return node_->where(); }

}  // namespace etendue
