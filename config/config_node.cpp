#include "config/config_node.h"

#include <algorithm>

namespace etendue {

ConfigNode::Table::Table() = default;
ConfigNode::Table::Table(const Table&) = default;
ConfigNode::Table::Table(Table&&) noexcept = default;
ConfigNode::Table& ConfigNode::Table::operator=(const Table&) = default;
ConfigNode::Table& ConfigNode::Table::operator=(Table&&) noexcept = default;
ConfigNode::Table::~Table() = default;

const ConfigNode* ConfigNode::Table::find(std::string_view key) const {
    const auto found = indexOf.find(key);
    return found == indexOf.end() ? nullptr : &entries[found->second].second;
}

ConfigNode* ConfigNode::Table::find(std::string_view key) {
    return const_cast<ConfigNode*>(std::as_const(*this).find(key));
}

ConfigNode& ConfigNode::Table::add(std::string_view key, ConfigNode node) {
    indexOf.emplace(key, entries.size());
    return entries.emplace_back(key, std::move(node)).second;
}

std::string ConfigNode::where() const { return whereOnLine(*source, line); }

bool ConfigNode::isArrayOfTables() const {
    const Array* array = std::get_if<Array>(&value);
    return array && std::all_of(array->begin(), array->end(), [](const ConfigNode& element) {
               return std::holds_alternative<Table>(element.value);
           });
}

std::string whereOnLine(const ConfigSource& source, std::size_t line) {
    return source.isOverride ? source.name : source.name + ':' + std::to_string(line);
}

std::string whereInText(const ConfigSource& source, std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, byte);
    const auto lineBreaks = std::count(before.begin(), before.end(), '\n');
    return whereOnLine(source, static_cast<std::size_t>(lineBreaks) + 1);
}

}  // namespace etendue
