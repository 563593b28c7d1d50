#include "tools/json.h"

#include <doctest/doctest.h>

#include <limits>

using namespace etendue;

TEST_CASE("Json: members keep their order, and arrays of plain values their line") {
    Json json = Json::object({{"b", 1}, {"a", Json::numbers({0.5, 2.0})}});
    json.add("c", Json::array({Json::object({{"d", true}})}));
    CHECK(
        json.text() ==
        "{\n  \"b\": 1,\n  \"a\": [0.5, 2],\n  \"c\": [\n    {\n      \"d\": true\n    }\n  ]\n}");
    CHECK(Json::object().text() == "{}");
    CHECK(Json::array().text() == "[]");
}

TEST_CASE("Json: what JSON cannot say is null, and texts are escaped") {
    CHECK(Json(std::numeric_limits<double>::infinity()).text() == "null");
    CHECK(Json(std::numeric_limits<double>::quiet_NaN()).text() == "null");
    CHECK(Json("a \"b\" \\ \n\t").text() == "\"a \\\"b\\\" \\\\ \\n\\u0009\"");
}

TEST_CASE("Json: numbers come back as they were") {
    const double number = 0.1 + 0.2;
    CHECK(std::stod(Json(number).text()) == number);
}

TEST_CASE("Json: a line holds all of it") {
    const Json json = Json::object({{"a", Json::numbers({1.0, 2.0})},
                                    {"b", Json::object({{"c", nullptr}, {"d", "x\ny"}})},
                                    {"e", std::optional<double>()}});
    CHECK(json.line() == R"({"a": [1, 2], "b": {"c": null, "d": "x\ny"}, "e": null})");
}
