// Config: a TOML file with the line of every value kept, read through getters that check type and
// range. toml++ is known to toml_document.cpp alone.
//
//     Config scene = Config::load("scene.toml");
//     ConfigTable film = scene.root().table("film");
//     std::int64_t width = film.integer("width", {1, 65536});
//     film.finish();  // an unknown key is an error that names the nearest known one
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Exit codes of the command, after sysexits.h.
enum class ExitCode : int {
    success = 0,
    failure = 1,
    usage = 64,
    badInput = 65,
    missingFile = 66,
    stoppedEarly = 75
};

/// Input that cannot be used. what() is the whole message: "file:line: key: what is wrong, what was
/// expected".
class InputError : public std::runtime_error {
public:
    explicit InputError(const std::string& message, ExitCode code = ExitCode::badInput)
        : std::runtime_error(message), code_(code) {}
    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

/// "FILE: no such file" (or: is a directory, cannot be read) with exit code missingFile.
InputError missingFileError(const std::filesystem::path& file);

/// Closed interval that a number must lie in. NaN never does.
struct Range {
    double lowest, highest;
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    static constexpr Range any() { return {-1e30, 1e30}; }
    static constexpr Range positive() { return {1e-30, 1e30}; }
    static constexpr Range nonNegative() { return {0.0, 1e30}; }
    static constexpr Range unit() { return {0.0, 1.0}; }
};

struct ConfigNode;  // one TOML value with its file and line

/// A view of one table. Copies share what has been asked for, so finish() may be called on any of
/// them. A getter without fallback throws InputError when the key is missing; every getter throws
/// when the value has the wrong type or is out of range.
class ConfigTable {
public:
    ConfigTable(std::shared_ptr<const ConfigNode> node, std::string path);

    bool has(std::string_view key) const;   // also marks the key as known
    std::vector<std::string> keys() const;  // in file order

    double number(std::string_view key, Range range) const;
    double number(std::string_view key, Range range, double fallback) const;
    std::int64_t integer(std::string_view key, Range range) const;
    std::int64_t integer(std::string_view key, Range range, std::int64_t fallback) const;
    bool boolean(std::string_view key, bool fallback) const;
    std::string text(std::string_view key) const;
    std::string text(std::string_view key, std::string_view fallback) const;
    /// One of `names`; the error lists them and points at the nearest.
    std::string choice(std::string_view key, const std::vector<std::string>& names) const;
    std::string choice(std::string_view key, const std::vector<std::string>& names,
                       std::string_view fallback) const;
    /// An array of exactly `count` numbers (any length if count is 0).
    std::vector<double> numbers(std::string_view key, std::size_t count, Range range) const;
    /// An array of such arrays: [[1, 2], [3, 4]].
    std::vector<std::vector<double>> rows(std::string_view key, std::size_t columns,
                                          Range range) const;
    std::vector<std::string> texts(
        std::string_view key) const;  // empty when missing; a lone string counts as one
    /// A file named by the key: made absolute against the folder of the file that names it. Must
    /// exist.
    std::filesystem::path file(std::string_view key) const;
    std::vector<std::filesystem::path> files(std::string_view key) const;
    /// What `read` makes of file(key). An InputError of it also says who named the file.
    template <class Read>
    auto readFile(std::string_view key, const Read& read) const {
        const std::filesystem::path named = file(key);
        try {
            return read(named);
        } catch (const InputError& error) {
            failNamedFile(key, error);
        }
    }

    /// True when the value is an array of numbers or, respectively, a string: for keys that take
    /// either.
    bool isArray(std::string_view key) const;
    bool isText(std::string_view key) const;

    /// An empty table when the key is missing.
    ConfigTable table(std::string_view key) const;
    /// The tables of an array of tables ([[mesh]]); empty when missing.
    std::vector<ConfigTable> tables(std::string_view key) const;

    /// Throws for the first key that no getter has asked for, with the nearest name that one has.
    void finish() const;

    /// Throws InputError at the key's line (at the table's if the key is missing or empty).
    [[noreturn]] void fail(std::string_view key, const std::string& message,
                           ExitCode code = ExitCode::badInput) const;
    /// The same at an entry of texts(key).
    [[noreturn]] void failEntry(std::string_view key, std::size_t index, const std::string& message,
                                ExitCode code = ExitCode::badInput) const;
    /// Throws the error again, with the key that names the file it is about.
    [[noreturn]] void failNamedFile(std::string_view key, const InputError& error) const;

    std::string where() const;  // "file:line"

private:
    struct Known;
    struct Item;  // an element of an array, with its path
    const ConfigNode* find(std::string_view key) const;
    const ConfigNode& require(std::string_view key, const std::string& expected) const;
    std::vector<double> numbersIn(const ConfigNode& node, const std::string& path,
                                  std::size_t count, Range range) const;
    std::vector<Item> textItems(std::string_view key) const;
    std::filesystem::path existingFile(const Item& item) const;
    [[noreturn]] void failAt(const ConfigNode& node, const std::string& path,
                             const std::string& message, ExitCode code = ExitCode::badInput) const;
    [[noreturn]] void failType(const ConfigNode& node, const std::string& path,
                               const std::string& expected) const;

    std::shared_ptr<const ConfigNode> node_;
    std::string path_;  // "camera", "material[2]": for messages
    std::shared_ptr<Known> known_;
};

/// A document. Copies are independent, and tables taken from one before a change keep what it was.
class Config {
public:
    Config();  // an empty document
    /// Throws InputError: missing file, not TOML (with line), larger than 16 MB, nested or dotted
    /// deeper than 64. Never overflows the stack, whatever the bytes.
    static Config load(const std::filesystem::path& file);
    /// The same from memory; `name` stands for the file in messages and for relative paths.
    static Config parse(std::string_view text, const std::filesystem::path& name);

    /// Overrides or adds a value: dotted key ("camera.f_number", "material.glass.ior" where `glass`
    /// is the entry's name or its index in an array of tables), value in TOML syntax; a bare word
    /// counts as a string. `assignment` is "key=value". Errors name "-s key=value" in place of the
    /// file. Setting a key inside a table that does not exist makes it, but an array's entry must
    /// exist. A relative file name set here is taken from the current folder.
    void set(std::string_view assignment);

    /// Appends the other document's arrays of tables to this one's and adds its tables' keys; a key
    /// that both set to a value is an error that names both lines. Used for `include`, so the other
    /// document's own top-level `include` stays behind: whoever merges has followed it already.
    void merge(const Config& other);

    /// Takes the other document's top-level table `name` in place of this one's, of which the keys
    /// `kept` stay unless the new one has them.
    void replaceTable(std::string_view name, const Config& other,
                      const std::vector<std::string>& kept);

    ConfigTable root() const;

private:
    explicit Config(std::shared_ptr<const ConfigNode> root) : root_(std::move(root)) {}
    std::shared_ptr<const ConfigNode> root_;  // never changed, only replaced
};

/// How messages name an override: "-s key=value", cut if it is long.
std::string overrideName(std::string_view assignment);

/// The text, with U+FFFD for bytes that are no UTF-8, of which a document must be: file names may
/// have such.
std::string asUtf8(std::string_view bytes);

/// The candidate with the smallest edit distance (with transpositions) to `name`, if it is close
/// enough to be a likely slip.
std::optional<std::string> nearestName(std::string_view name,
                                       const std::vector<std::string>& candidates);

}  // namespace etendue
