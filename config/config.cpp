#include "config/config.h"

#include <array>
#include <fstream>

#include "config/config_node.h"
#include "config/wording.h"

namespace etendue {
namespace {

std::shared_ptr<const ConfigSource> fileSource(const std::filesystem::path& name) {
    std::error_code ignored;  // without a current folder the name stays relative
    return std::make_shared<const ConfigSource>(
        ConfigSource{name.string(), std::filesystem::absolute(name, ignored).parent_path(), false});
}

/// At most one byte more than allowed, so that the size check sees it.
std::string readFile(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream || std::filesystem::is_directory(file)) throw missingFileError(file);
    std::string text;
    std::array<char, 65536> block;
    while (stream && text.size() <= maxConfigBytes) {
        stream.read(block.data(), block.size());
        text.append(block.data(), static_cast<std::size_t>(stream.gcount()));
    }
    if (stream.bad()) throw missingFileError(file);
    return text;
}

void mergeInto(ConfigNode::Table& table, const ConfigNode::Table& other, const std::string& path) {
    for (const auto& [key, value] : other.entries) {
        if (path.empty() && key == "include") continue;
        ConfigNode* existing = table.find(key);
        if (!existing) {
            table.add(key, value);
            continue;
        }
        auto* existingTable = std::get_if<ConfigNode::Table>(&existing->value);
        const auto* otherTable = std::get_if<ConfigNode::Table>(&value.value);
        if (existingTable && otherTable) {
            mergeInto(*existingTable, *otherTable, joinPath(path, key));
        } else if (existing->isArrayOfTables() && value.isArrayOfTables()) {
            auto& array = std::get<ConfigNode::Array>(existing->value);
            const auto& more = std::get<ConfigNode::Array>(value.value);
            array.insert(array.end(), more.begin(), more.end());
        } else {
            throw InputError(value.where() + ": " + joinPath(path, key) + ": already set at " +
                             existing->where());
        }
    }
}

}  // namespace

InputError missingFileError(const std::filesystem::path& file) {
    std::error_code ignored;  // any failure to look is "cannot be read"
    const std::filesystem::file_type type = std::filesystem::status(file, ignored).type();
    const std::string problem = type == std::filesystem::file_type::not_found   ? "no such file"
                                : type == std::filesystem::file_type::directory ? "is a directory"
                                                                                : "cannot be read";
    return InputError(file.string() + ": " + problem, ExitCode::missingFile);
}

Config::Config() : Config(parse("", "empty")) {}

Config Config::load(const std::filesystem::path& file) { return parse(readFile(file), file); }

Config Config::parse(std::string_view text, const std::filesystem::path& name) {
    return Config(std::make_shared<ConfigNode>(parseToml(text, fileSource(name))));
}

void Config::merge(const Config& other) {
    ConfigNode merged = *root_;
    mergeInto(std::get<ConfigNode::Table>(merged.value),
              std::get<ConfigNode::Table>(other.root_->value), "");
    root_ = std::make_shared<ConfigNode>(std::move(merged));
}

void Config::replaceTable(std::string_view name, const Config& other,
                          const std::vector<std::string>& kept) {
    const ConfigNode* replacement = std::get<ConfigNode::Table>(other.root_->value).find(name);
    if (!replacement || !std::holds_alternative<ConfigNode::Table>(replacement->value))
        other.root().fail("", "expected a [" + std::string(name) + "] table");
    ConfigNode table = *replacement;
    ConfigNode whole = *root_;
    auto& entries = std::get<ConfigNode::Table>(whole.value);
    if (ConfigNode* old = entries.find(name)) {
        for (const std::string& key : kept) {
            auto& taken = std::get<ConfigNode::Table>(table.value);
            const ConfigNode* value = std::get<ConfigNode::Table>(old->value).find(key);
            if (value && !taken.find(key)) taken.add(key, *value);
        }
        *old = std::move(table);
    } else {
        entries.add(std::string(name), std::move(table));
    }
    root_ = std::make_shared<ConfigNode>(std::move(whole));
}

ConfigTable Config::root() const { return {root_, ""}; }

}  // namespace etendue
