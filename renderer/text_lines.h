// TextLines: the lines and words of the plain-text formats OBJ and MTL, and what their words may
// be.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "config/config.h"

namespace etendue {

/// The bytes of a text file without a UTF-8 byte-order mark. Throws InputError if it is missing or
/// is no text: UTF-16, or a byte 0 somewhere.
std::string readText(const std::filesystem::path& file);

/// A decimal number in full: "-1", ".5", "+2.e-1". Nothing for anything else ("nan", "1,5", "0x1",
/// "1e") or for what a double cannot hold.
std::optional<double> parseNumber(std::string_view word);

/// In quotes, with control characters escaped, cut where it gets long.
std::string quoteForMessage(std::string_view text);

/// Walks through a text. A line ends with LF, CRLF or CR; a backslash before the end joins it to
/// the next one, unless it ends a comment; words stand between blanks and tabs.
class TextLines {
public:
    static constexpr std::size_t longestLine = 1'000'000;

    /// Both must outlive this. `file` is for messages. Joints and trailing comments are overwritten
    /// with blanks, so that simpler readers see the same words in the text as this one.
    TextLines(std::string& text, const std::filesystem::path& file);

    /// Moves to the next line; false after the last. Throws InputError beyond longestLine bytes.
    bool next();

    /// Nothing but blanks or a comment is left of the line. A word that starts with '#' begins a
    /// comment.
    bool atEnd() {
        while (at_ != lineEnd_ && isBlank(*at_)) ++at_;
        if (at_ != lineEnd_ && *at_ == '#') blankRest();
        return at_ == lineEnd_;
    }

    /// The next word of the line; empty when there is none.
    std::string_view word() {
        if (atEnd()) return {};
        const char* const begin = at_;
        while (at_ != lineEnd_ && !isBlank(*at_)) ++at_;
        return {begin, static_cast<std::size_t>(at_ - begin)};
    }

    /// What is left of the line, '#' included, without blanks at its ends: a name.
    std::string_view takeRest();

    /// Of the line, from 1; of the first one where several are joined.
    std::size_t number() const { return number_; }

    [[noreturn]] void fail(const std::string& message) const;
    [[noreturn]] void failAtLine(std::size_t line, const std::string& message) const;

private:
    static bool isBlank(char c) { return c == ' ' || c == '\t'; }
    void findLineEnd();
    void blankRest();

    const std::filesystem::path& file_;
    char* at_;       // in the line
    char* lineEnd_;  // behind its last character
    char* nextLine_;
    char* textEnd_;
    char* nextLineFeed_;  // the first at or after nextLine_, or textEnd_
    std::size_t number_ = 0;
    std::size_t nextNumber_ = 1;
};

}  // namespace etendue
