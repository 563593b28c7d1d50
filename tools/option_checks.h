// Checks of options that are numbers.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <string>

namespace etendue {

/// Accepts what the C++ library reads as a `T` from first to last character, and `isGood` likes;
/// CLI11's own checks let pass what is not a number ("nan"). `expected` is for the message.
template <class T, class IsGood>
CLI::Validator numberThat(IsGood isGood, const std::string& expected) {
    return CLI::Validator(
        [=](const std::string& text) {
            T value{};
            const char* end = text.data() + text.size();
            const auto [rest, error] = std::from_chars(text.data(), end, value);
            const bool isNumber = error == std::errc() && rest == end;
            return isNumber && isGood(value)
                       ? std::string()
                       : fmt::format("expected {}, got \"{}\"", expected, text);
        },
        "");
}

/// Bounds included.
inline CLI::Validator numberBetween(double lowest, double highest) {
    return numberThat<double>([=](double v) { return v >= lowest && v <= highest; },
                              fmt::format("a number from {:g} to {:g}", lowest, highest));
}

/// Infinity ("inf") too.
inline CLI::Validator positiveNumber() {
    return numberThat<double>([](double v) { return v > 0.0; }, "a number above 0");
}

}  // namespace etendue
