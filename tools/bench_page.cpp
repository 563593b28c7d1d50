#include "tools/bench_page.h"

#include <array>
#include <stdexcept>
#include <string_view>

namespace etendue {

// From the files in tools/report, by tools/embed_files.cmake.
extern const std::string_view reportPage, reportStyle, reportTheme, reportLibrary, reportScripts;

namespace {

/// JSON has "<" in strings only, where an escape means the same: then no "</script>" and no "<!--",
/// after which HTML would read on differently.
std::string escapedForScript(const std::string& json) {
    std::string escaped;
    escaped.reserve(json.size() + json.size() / 64);
    for (const char c : json)
        if (c == '<')
            escaped += "\\u003c";
        else
            escaped += c;
    return escaped;
}

}  // namespace

std::string benchPage(const std::string& reportDataJson) {
    const std::string data = escapedForScript(reportDataJson);
    struct Part {
        std::string_view mark, text;
    };
    const std::array<Part, 5> parts{{{"{{style}}", reportStyle},
                                     {"{{theme}}", reportTheme},
                                     {"{{data}}", data},
                                     {"{{library}}", reportLibrary},
                                     {"{{scripts}}", reportScripts}}};
    std::string page;
    page.reserve(data.size() + 300000);
    // From front to back through the frame alone: marks that the data hold mean nothing.
    std::string_view rest = reportPage;
    for (const Part& part : parts) {
        const std::size_t at = rest.find(part.mark);
        if (at == std::string_view::npos)
            throw std::logic_error("report.html lacks " + std::string(part.mark));
        page += rest.substr(0, at);
        page += part.text;
        rest.remove_prefix(at + part.mark.size());
    }
    page += rest;
    return page;
}

}  // namespace etendue
