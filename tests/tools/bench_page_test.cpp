#include "tools/bench_page.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <string_view>

using namespace etendue;

namespace {

std::size_t countOf(std::string_view text, std::string_view part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string_view::npos;
         at = text.find(part, at + part.size()))
        ++count;
    return count;
}

std::string_view dataOf(std::string_view page) {
    const std::string_view start = "id=\"report-data\">\n";
    const std::size_t from = page.find(start) + start.size();
    return page.substr(from, page.find("</script>", from) - from);
}

}  // namespace

TEST_CASE("benchPage: data cannot end their script, nor open a comment in it") {
    const std::string hostile =
        R"({"title": "</script><!-- <script>alert(1)</script> {{scripts}} {{library}} & \"' -->"})";
    const std::string page = benchPage(hostile);
    const std::string plain = benchPage("{}");
    for (const char* part : {"<script", "</script", "<!--"}) {
        CAPTURE(part);
        CHECK(countOf(page, part) == countOf(plain, part));
    }
    CHECK(dataOf(page) ==
          "{\"title\": \"\\u003c/script>\\u003c!-- \\u003cscript>alert(1)\\u003c/script> "
          "{{scripts}} {{library}} & \\\"' -->\"}\n");
    CHECK(page.size() - plain.size() == hostile.size() - 2 + 5 * countOf(hostile, "<"));
}

TEST_CASE("benchPage: one page with everything in it, and no address to load from") {
    const std::string page = benchPage("{}");
    CHECK(page.starts_with("<!doctype html>"));
    CHECK(page.ends_with("</html>\n"));
    CHECK(countOf(page, "default-src 'none'") == 1);
    for (const char* part : {"scaleLog", "class ConvergenceFigure", "function drawReport",
                             "Redistribution and use in source and binary forms"}) {
        CAPTURE(part);
        CHECK(countOf(page, part) >= 1);
    }
    // The frame's five marks are all filled in.
    for (const char* mark : {"{{style}}", "{{theme}}", "{{data}}", "{{library}}", "{{scripts}}"})
        CHECK(countOf(page, mark) == 0);
    for (const char* part : {"<script src", "<link rel=\"stylesheet\"", "@import", "url(http"})
        CHECK(countOf(page, part) == 0);
    CHECK(page.size() < 300000);
}
