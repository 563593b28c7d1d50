// Text to ConfigNode: the one file that knows toml++.
#include <algorithm>

#include "config/config.h"
#include "config/config_node.h"

// toml++ 3.3 asserts what malformed text can break ("[}" does), and relies on it in release builds.
// Here such an assertion is an exception in every build.
namespace {
struct BrokenAssertion {};
[[noreturn]] void breakAssertion() { throw BrokenAssertion(); }
}  // namespace
#undef NDEBUG
#define TOML_ASSERT(condition) ((condition) ? void() : breakAssertion())
#define TOML_ENABLE_FORMATTERS 0
#include <toml++/toml.h>

namespace etendue {
namespace {

struct Converter {
    const std::shared_ptr<const ConfigSource>& source;

    ConfigNode convert(const toml::node& node, std::size_t depth) const {
        ConfigNode result{{}, source, node.source().begin.line};
        if (node.is_table())
            result.value = convertTable(*node.as_table(), depth);
        else if (node.is_array())
            result.value = convertArray(*node.as_array(), depth);
        else if (const auto* text = node.as_string())
            result.value = text->get();
        else if (const auto* integer = node.as_integer())
            result.value = integer->get();
        else if (const auto* number = node.as_floating_point())
            result.value = number->get();
        else if (const auto* boolean = node.as_boolean())
            result.value = boolean->get();
        else
            result.value = ConfigNode::DateOrTime{};
        return result;
    }

private:
    ConfigNode::Table convertTable(const toml::table& table, std::size_t depth) const {
        checkDepth(table, depth);
        using Entry = std::pair<const toml::key*, const toml::node*>;
        std::vector<Entry> inFileOrder;
        for (const auto& [key, value] : table) inFileOrder.emplace_back(&key, &value);
        std::sort(inFileOrder.begin(), inFileOrder.end(), [](const Entry& a, const Entry& b) {
            return a.first->source().begin < b.first->source().begin;
        });
        ConfigNode::Table result;
        for (const auto& [key, value] : inFileOrder)
            result.add(key->str(), convert(*value, depth + 1));
        return result;
    }

    ConfigNode::Array convertArray(const toml::array& array, std::size_t depth) const {
        checkDepth(array, depth);
        ConfigNode::Array result;
        for (const toml::node& element : array) result.push_back(convert(element, depth + 1));
        return result;
    }

    // The text was checked key by key and bracket by bracket; here they add up.
    void checkDepth(const toml::node& node, std::size_t depth) const {
        if (depth > maxConfigDepth)
            throw InputError(whereOnLine(*source, node.source().begin.line) + ": " +
                             tooDeepMessage());
    }
};

/// toml++'s "Error while parsing array: ..." becomes "not valid TOML (array): ...".
std::string tomlMessage(std::string_view description) {
    constexpr std::string_view opening = "Error while parsing ";
    const std::size_t colon = description.find(": ");
    if (!description.starts_with(opening) || colon == std::string_view::npos)
        return "not valid TOML: " + std::string(description);
    const std::string_view construct = description.substr(opening.size(), colon - opening.size());
    return "not valid TOML (" + std::string(construct) + ")" +
           std::string(description.substr(colon));
}

bool breaksAssertion(std::string_view text) {
    try {
        static_cast<void>(toml::parse(text));
    } catch (const BrokenAssertion&) {
        return true;
    } catch (const toml::parse_error&) {
    }
    return false;
}

/// The byte at which a text breaks an assertion, by bisection: those before it do not.
std::size_t breakingByte(std::string_view text) {
    std::size_t holds = 0;
    std::size_t breaks = text.size();
    while (breaks - holds > 1) {
        const std::size_t middle = holds + (breaks - holds) / 2;
        (breaksAssertion(text.substr(0, middle)) ? breaks : holds) = middle;
    }
    return holds;
}

}  // namespace

ConfigNode parseToml(std::string_view text, const std::shared_ptr<const ConfigSource>& source,
                     std::size_t depth) {
    constexpr std::string_view byteOrderMark = "\xef\xbb\xbf";
    if (text.starts_with(byteOrderMark)) text.remove_prefix(byteOrderMark.size());
    checkConfigText(text, *source);
    try {
        return Converter{source}.convert(toml::parse(text), depth);
    } catch (const toml::parse_error& error) {
        throw InputError(whereOnLine(*source, error.source().begin.line) + ": " +
                         tomlMessage(error.what()));
    } catch (const BrokenAssertion&) {
        throw InputError(whereInText(*source, text, breakingByte(text)) + ": not valid TOML");
    }
}

}  // namespace etendue
