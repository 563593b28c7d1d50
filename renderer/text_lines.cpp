#include "renderer/text_lines.h"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <fstream>
#include <utility>

namespace etendue {
namespace {

bool isDigit(char c) { return '0' <= c && c <= '9'; }

/// The first `c` in [begin, end), or end.
char* findByte(char c, char* begin, char* end) {
    void* const found = std::memchr(begin, c, static_cast<std::size_t>(end - begin));
    return found ? static_cast<char*>(found) : end;
}

bool isBlank(char c) { return c == ' ' || c == '\t'; }

bool holdsComment(std::string_view line) {
    for (std::size_t i = line.find('#'); i != line.npos; i = line.find('#', i + 1))
        if (i == 0 || isBlank(line[i - 1])) return true;
    return false;
}

}  // namespace

std::string readText(const std::filesystem::path& file) {
    std::error_code unknown;  // a device or a pipe: no size, refused below
    const std::uintmax_t size = std::filesystem::file_size(file, unknown);
    std::ifstream stream(file, std::ios::binary);
    if (!stream || unknown) throw missingFileError(file);
    std::string text(size, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(stream.gcount()) != size) throw missingFileError(file);

    if (text.starts_with("\xFE\xFF") || text.starts_with("\xFF\xFE"))
        throw InputError(file.string() + ": UTF-16 text, expected UTF-8");
    if (const std::size_t zero = text.find('\0'); zero != std::string::npos)
        throw InputError(file.string() + ": not a text file, byte " + std::to_string(zero) +
                         " is 0");
    if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
    return text;
}

std::optional<double> parseNumber(std::string_view word) {
    const std::string_view digits = word.substr(word.starts_with('-') || word.starts_with('+'));
    if (digits.empty() || !(isDigit(digits[0]) || digits[0] == '.')) return {};
    if (word[0] == '+') word = digits;
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || error != std::errc{}) return {};
    return value;
}

std::string quoteForMessage(std::string_view text) {
    constexpr std::size_t mostBytes = 60;
    constexpr std::string_view hex = "0123456789abcdef";
    std::string result = "\"";
    for (const char c : text.substr(0, mostBytes)) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f)
            result += {'\\', 'x', hex[byte >> 4], hex[byte & 15]};
        else
            result += c;
    }
    return result + (text.size() > mostBytes ? "...\"" : "\"");
}

TextLines::TextLines(std::string& text, const std::filesystem::path& file)
    : file_(file),
      at_(text.data()),
      lineEnd_(at_),
      nextLine_(at_),
      textEnd_(text.data() + text.size()),
      nextLineFeed_(findByte('\n', at_, textEnd_)) {}

bool TextLines::next() {
    if (nextLine_ == textEnd_) return false;
    at_ = nextLine_;
    number_ = nextNumber_;
    const char* part = at_;  // of a line that is joined
    findLineEnd();
    while (lineEnd_ != part && lineEnd_[-1] == '\\' && nextLine_ != textEnd_ &&
           !holdsComment({part, static_cast<std::size_t>(lineEnd_ - part)})) {
        std::fill(lineEnd_ - 1, nextLine_, ' ');
        part = nextLine_;
        findLineEnd();
    }
    return true;
}

void TextLines::findLineEnd() {
    // Remembered, or a file of CR alone would be searched to its end for every line.
    if (nextLineFeed_ < nextLine_) nextLineFeed_ = findByte('\n', nextLine_, textEnd_);
    lineEnd_ = findByte('\r', nextLine_, nextLineFeed_);
    if (static_cast<std::size_t>(lineEnd_ - at_) > longestLine)
        fail("a line longer than " + std::to_string(longestLine) + " bytes");
    nextLine_ = lineEnd_;
    if (nextLine_ != textEnd_ && *nextLine_ == '\r') ++nextLine_;
    if (nextLine_ != textEnd_ && *nextLine_ == '\n') ++nextLine_;
    ++nextNumber_;
}

void TextLines::blankRest() {
    std::fill(at_, lineEnd_, ' ');
    at_ = lineEnd_;
}

std::string_view TextLines::takeRest() {
    const char* begin = std::exchange(at_, lineEnd_);
    const char* end = lineEnd_;
    while (begin != end && isBlank(*begin)) ++begin;
    while (begin != end && isBlank(end[-1])) --end;
    return {begin, static_cast<std::size_t>(end - begin)};
}

void TextLines::fail(const std::string& message) const { failAtLine(number_, message); }

void TextLines::failAtLine(std::size_t line, const std::string& message) const {
    throw InputError(file_.string() + ":" + std::to_string(line) + ": " + message);
}

}  // namespace etendue
