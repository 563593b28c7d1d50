#include "tools/json.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etendue {

namespace {

std::string quoted(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            result += {'\\', c};
        else if (c == '\n')
            result += "\\n";
        else if (static_cast<unsigned char>(c) < 0x20)
            result += fmt::format("\\u{:04x}", static_cast<int>(c));
        else
            result += c;
    }
    return result + '"';
}

std::string indent(int depth) {
    return "\n" + std::string(2 * static_cast<std::size_t>(depth), ' ');
}

}  // namespace

Json Json::object(std::initializer_list<Member> members) { return Json(Object(members)); }
Json Json::array(std::vector<Json> items) { return Json(std::move(items)); }

Json Json::numbers(const std::vector<double>& numbers) {
    return Json(Array(numbers.begin(), numbers.end()));
}

void Json::add(std::string key, Json value) {
    std::get<Object>(value_).emplace_back(std::move(key), std::move(value));
}

void Json::add(Json value) { std::get<Array>(value_).push_back(std::move(value)); }

bool Json::isPlain() const {
    return !std::holds_alternative<Array>(value_) && !std::holds_alternative<Object>(value_);
}

std::string Json::plainText() const {
    if (const auto* flag = std::get_if<bool>(&value_)) return *flag ? "true" : "false";
    if (const auto* number = std::get_if<double>(&value_))
        return std::isfinite(*number) ? fmt::format("{}", *number) : "null";
    if (const auto* whole = std::get_if<std::int64_t>(&value_)) return fmt::format("{}", *whole);
    return quoted(std::get<std::string>(value_));
}

std::string Json::line() const {
    if (isPlain()) return plainText();
    std::string result;
    if (const auto* items = std::get_if<Array>(&value_)) {
        for (const Json& item : *items) result += (result.empty() ? "" : ", ") + item.line();
        return "[" + result + "]";
    }
    for (const auto& [key, value] : std::get<Object>(value_))
        result += (result.empty() ? "" : ", ") + quoted(key) + ": " + value.line();
    return "{" + result + "}";
}

std::string Json::text(int depth) const {
    if (isPlain()) return plainText();
    std::string result;
    if (const auto* items = std::get_if<Array>(&value_)) {
        const bool onOneLine = std::ranges::all_of(*items, &Json::isPlain);
        for (const Json& item : *items) {
            if (!result.empty()) result += onOneLine ? ", " : ",";
            result += (onOneLine ? "" : indent(depth + 1)) + item.text(depth + 1);
        }
        return "[" + result + (onOneLine ? "]" : indent(depth) + "]");
    }
    for (const auto& [key, value] : std::get<Object>(value_)) {
        if (!result.empty()) result += ",";
        result += indent(depth + 1) + quoted(key) + ": " + value.text(depth + 1);
    }
    return result.empty() ? "{}" : "{" + result + indent(depth) + "}";
}

}  // namespace etendue
