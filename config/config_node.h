// ConfigNode: one value of a document, with the place it was written at. Private to config/.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace etendue {

/// Where values come from: a file, or one override of the command line.
struct ConfigSource {
    std::string name;              // as messages give it
    std::filesystem::path folder;  // relative file names start here
    bool isOverride = false;       // an override has no lines
};

struct ConfigNode {
    struct DateOrTime {};
    using Array = std::vector<ConfigNode>;
    /// Keys in file order, found by name in logarithmic time.
    struct Table {
        // Out of line, where ConfigNode is complete.
        Table();
        Table(const Table&);
        Table(Table&&) noexcept;
        Table& operator=(const Table&);
        Table& operator=(Table&&) noexcept;
        ~Table();

        std::vector<std::pair<std::string, ConfigNode>> entries;
        std::map<std::string, std::size_t, std::less<>> indexOf;

        const ConfigNode* find(std::string_view key) const;
        ConfigNode* find(std::string_view key);
        /// The key must be new.
        ConfigNode& add(std::string_view key, ConfigNode node);
    };

    std::variant<Table, Array, std::string, std::int64_t, double, bool, DateOrTime> value;
    std::shared_ptr<const ConfigSource> source;
    std::size_t line = 1;

    std::string where() const;  // "file:line" or "-s key=value"
    /// True for an empty array too.
    bool isArrayOfTables() const;
};

/// Tables, arrays and dotted keys may be nested this deep: far more than any scene needs, far less
/// than any stack holds.
inline constexpr std::size_t maxConfigDepth = 64;
inline constexpr std::size_t maxConfigBytes = std::size_t{16} << 20;

/// Throws InputError for text that toml++ should not see: too long, not UTF-8, beyond ASCII outside
/// strings and comments, or with brackets or dotted keys deeper than `maxConfigDepth`.
void checkConfigText(std::string_view text, const ConfigSource& source);
std::string tooDeepMessage();

/// The document's root table, itself `depth` levels deep. Throws InputError.
ConfigNode parseToml(std::string_view text, const std::shared_ptr<const ConfigSource>& source,
                     std::size_t depth = 0);

/// "file:line" of a byte of the text.
std::string whereInText(const ConfigSource& source, std::string_view text, std::size_t byte);
std::string whereOnLine(const ConfigSource& source, std::size_t line);

}  // namespace etendue
