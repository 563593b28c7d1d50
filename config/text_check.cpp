// What a document's bytes must satisfy before toml++, which is recursive, may see them. The scan
// knows just enough TOML to tell brackets and dots from text. Where it and the parser could
// disagree the text is malformed, and the parser stops there.
#include <algorithm>

#include "config/config.h"
#include "config/config_node.h"

namespace etendue {
namespace {

/// Zero beyond the end.
unsigned byteAt(std::string_view bytes, std::size_t at) {
    return at < bytes.size() ? static_cast<unsigned char>(bytes[at]) : 0u;
}

struct Text {
    std::string_view bytes;
    const ConfigSource& source;

    bool isAscii(std::size_t at) const { return byteAt(bytes, at) < 0x80; }
    [[noreturn]] void fail(std::size_t at, const std::string& message) const {
        throw InputError(whereInText(source, bytes, at) + ": " + message);
    }
};

/// Bytes of the well-formed UTF-8 sequence at `at`, 0 if there is none. The Unicode Standard,
/// table 3-7.
std::size_t utf8Length(std::string_view bytes, std::size_t at) {
    const auto isBetween = [](unsigned value, unsigned low, unsigned high) {
        return low <= value && value <= high;
    };
    const unsigned first = byteAt(bytes, at);
    if (first < 0x80) return 1;
    const std::size_t length = isBetween(first, 0xC2, 0xDF)   ? 2
                               : isBetween(first, 0xE0, 0xEF) ? 3
                               : isBetween(first, 0xF0, 0xF4) ? 4
                                                              : 0;
    // The second byte excludes overlong forms, surrogates and what lies beyond U+10FFFF.
    const unsigned secondLow = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
    const unsigned secondHigh = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
    if (length == 0 || !isBetween(byteAt(bytes, at + 1), secondLow, secondHigh)) return 0;
    for (std::size_t i = 2; i < length; ++i)
        if (!isBetween(byteAt(bytes, at + i), 0x80, 0xBF)) return 0;
    return length;
}

void checkUtf8(const Text& text) {
    for (std::size_t at = 0; at < text.bytes.size();) {
        const std::size_t length = utf8Length(text.bytes, at);
        if (length == 0) text.fail(at, "not valid UTF-8");
        at += length;
    }
}

/// In a multi-line string, behind the backslash at `at` and the blanks and line breaks that it
/// takes away: toml++ 3.3 asks of what stands there whether it is a blank, too, and of some
/// characters beyond ASCII does so with undefined behaviour.
void checkBehindBackslash(const Text& text, std::size_t at) {
    const std::size_t next = text.bytes.find_first_not_of(" \t\n\v\f\r", at + 1);
    if (next != std::string_view::npos && !text.isAscii(next))
        text.fail(next, "a character beyond ASCII right behind a backslash");
}

/// Past the string whose opening quote is at `at`; where it is not closed, its line's end or the
/// text's.
std::size_t skipString(const Text& text, std::size_t at) {
    const std::string_view bytes = text.bytes;
    const char quote = bytes[at];
    const std::string threeQuotes(3, quote);
    const bool isMultiLine = bytes.substr(at, 3) == threeQuotes;
    at += isMultiLine ? 3 : 1;
    while (at < bytes.size()) {
        if (bytes[at] == '\\' && quote == '"') {
            if (isMultiLine) checkBehindBackslash(text, at);
            at += 2;
        } else if (isMultiLine && bytes.substr(at, 3) == threeQuotes) {
            // One or two quotes more belong to the string: """a"""""
            const std::size_t end = bytes.find_first_not_of(quote, at);
            return std::min({end, at + 5, bytes.size()});
        } else if (!isMultiLine && bytes[at] == quote) {
            return at + 1;
        } else if (!isMultiLine && bytes[at] == '\n') {
            return at;
        } else {
            ++at;
        }
    }
    return bytes.size();
}

/// Whether a quote at `at` opens a string. In the middle of a word, as in 2"é", it does not: there
/// the text is malformed, and toml++ takes what follows for more of the word.
bool opensString(std::string_view bytes, std::size_t at) {
    constexpr std::string_view before = " \t\r\n=,.[{";
    return at == 0 || before.find(bytes[at - 1]) != std::string_view::npos;
}

/// Brackets and dotted keys against `maxConfigDepth`, and nothing beyond ASCII but in strings and
/// comments (TOML has none there; toml++ 3.3 meets it with undefined behaviour).
void checkStructure(const Text& text) {
    std::size_t brackets = 0;
    std::size_t keys = 1;  // of the dotted key so far
    for (std::size_t at = 0; at < text.bytes.size();) {
        switch (text.bytes[at]) {
            case '"':
            case '\'':
                if (!opensString(text.bytes, at)) break;
                at = skipString(text, at);
                continue;
            case '#':
                at = std::min(text.bytes.find('\n', at), text.bytes.size());
                continue;
            case '[':
            case '{':
                ++brackets;
                keys = 1;
                break;
            case ']':
            case '}':
                brackets -= brackets > 0 ? 1 : 0;
                keys = 1;
                break;
            case '\n':
            case '=':
            case ',':
                keys = 1;
                break;
            case '.':
                ++keys;
                break;
            default:
                if (!text.isAscii(at)) text.fail(at, "a character that only quotes may hold");
        }
        if (brackets > maxConfigDepth || keys > maxConfigDepth) text.fail(at, tooDeepMessage());
        ++at;
    }
}

}  // namespace

std::string asUtf8(std::string_view bytes) {
    std::string text;
    for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t length = utf8Length(bytes, at);
        text += length > 0 ? bytes.substr(at, length) : "\uFFFD";
        at += std::max<std::size_t>(length, 1);
    }
    return text;
}

std::string tooDeepMessage() {
    return "nested deeper than " + std::to_string(maxConfigDepth) + " levels";
}

void checkConfigText(std::string_view text, const ConfigSource& source) {
    if (text.size() > maxConfigBytes) throw InputError(source.name + ": larger than 16 MB");
    checkUtf8({text, source});
    checkStructure({text, source});
}

}  // namespace etendue
