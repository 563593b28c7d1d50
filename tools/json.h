// Json: a value to print for machines, its objects in the order in which they were made.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace etendue {

class Json {
public:
    using Member = std::pair<std::string, Json>;

    Json(std::nullptr_t) : value_(std::numeric_limits<double>::quiet_NaN()) {}
    Json(bool value) : value_(value) {}
    Json(double value) : value_(value) {}  // null unless finite: JSON knows no other
    Json(std::optional<double> value)
        : value_(value.value_or(std::numeric_limits<double>::quiet_NaN())) {}
    Json(std::integral auto value) : value_(static_cast<std::int64_t>(value)) {}
    Json(std::string value) : value_(std::move(value)) {}
    Json(const char* value) : value_(std::string(value)) {}

    static Json object(std::initializer_list<Member> members = {});
    static Json array(std::vector<Json> items = {});
    static Json numbers(const std::vector<double>& numbers);

    /// Of an object.
    void add(std::string key, Json value);
    /// Of an array.
    void add(Json value);

    /// Indented; arrays of plain values on one line. No final newline.
    std::string text() const { return text(0); }
    /// All of it on one line, as JSON Lines has it. No final newline.
    std::string line() const;

private:
    using Array = std::vector<Json>;
    using Object = std::vector<Member>;
    explicit Json(Array items) : value_(std::move(items)) {}
    explicit Json(Object members) : value_(std::move(members)) {}
    std::string text(int depth) const;
    std::string plainText() const;
    bool isPlain() const;

    std::variant<bool, double, std::int64_t, std::string, Array, Object> value_;
};

}  // namespace etendue
