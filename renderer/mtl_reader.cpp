#include "renderer/mtl_reader.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/referenced_file.h"
#include "renderer/text_lines.h"

namespace etendue {
namespace {

constexpr float largestNumber = 1e18f;
constexpr std::size_t mostListed = 20;  // of what is ignored

struct MapOption {
    std::string_view name;
    int values;
    bool isOptional;  // the values are numbers, and the last ones may be missing
};

constexpr std::array<MapOption, 14> mapOptions = {{{"-blendu", 1, false},
                                                   {"-blendv", 1, false},
                                                   {"-bm", 1, false},
                                                   {"-boost", 1, false},
                                                   {"-cc", 1, false},
                                                   {"-clamp", 1, false},
                                                   {"-colorspace", 1, false},
                                                   {"-imfchan", 1, false},
                                                   {"-mm", 2, false},
                                                   {"-o", 3, true},
                                                   {"-s", 3, true},
                                                   {"-t", 3, true},
                                                   {"-texres", 1, false},
                                                   {"-type", 1, false}}};

std::string_view firstWord(std::string_view text) {
    return text.substr(0, text.find_first_of(" \t"));
}

std::string_view afterFirstWord(std::string_view text) {
    text.remove_prefix(firstWord(text).size());
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    return text;
}

/// The text behind the option's values. The last word is a file name even if it looks like a value.
std::string_view afterOption(std::string_view text, const MapOption& option) {
    text = afterFirstWord(text);
    for (int i = 0; i < option.values; ++i) {
        if (option.isOptional && !parseNumber(firstWord(text))) break;
        if (const std::string_view next = afterFirstWord(text); !next.empty()) text = next;
    }
    return text;
}

class MtlReader {
public:
    MtlReader(const std::filesystem::path& file, const std::set<std::string>& wanted,
              std::vector<std::string>& notes)
        : file_(file), wanted_(wanted), notes_(notes), text_(readText(file)), lines_(text_, file) {}

    std::vector<ObjMaterial> read() {
        while (lines_.next()) {
            keyword_ = lines_.word();
            if (!keyword_.empty()) statement();
        }
        store();
        std::string list;
        for (const std::string& what : ignored_) list += (list.empty() ? "" : ", ") + what;
        if (!list.empty()) notes_.push_back(file_.string() + ": ignored " + list);
        return std::move(materials_);
    }

private:
    struct Map {
        std::string name;
        std::size_t line = 0;
    };
    struct Statement {
        std::string_view keyword;
        void (MtlReader::*read)();
    };
    static const std::array<Statement, 12> statements;

    void statement() {
        if (keyword_ == "newmtl") return begin();
        const auto known = std::ranges::find(statements, keyword_, &Statement::keyword);
        if (known == statements.end()) return ignore(quoteForMessage(keyword_));
        if (!current_) fail("before the first newmtl");
        (this->*known->read)();
        if (!lines_.atEnd()) fail("unexpected " + quoteForMessage(lines_.takeRest()));
    }

    void begin() {
        store();
        current_.emplace();
        current_->name = lines_.takeRest();
        isWanted_ = wanted_.contains(current_->name);
        if (isWanted_ && !begun_.insert(current_->name).second) {
            isWanted_ = false;
            note("an earlier definition of " + quoteForMessage(current_->name) + " holds");
        }
        hasDiffuse_ = hasDissolve_ = false;
        diffuseMap_ = opacityMap_ = {};
    }

    /// Only a wanted material's images must exist.
    void store() {
        if (!isWanted_) return;
        if (!diffuseMap_.name.empty() && !hasDiffuse_) current_->diffuse = {1, 1, 1};
        current_->diffuseMap = find(diffuseMap_);
        current_->opacityMap = find(opacityMap_);
        materials_.push_back(*current_);
    }

    std::filesystem::path find(const Map& map) {
        if (map.name.empty()) return {};
        const std::string where = file_.string() + ":" + std::to_string(map.line);
        const std::filesystem::path folder = file_.parent_path();
        if (const auto found = findReferencedFile(folder, map.name, where, notes_)) return *found;
        throw InputError(where + ": no file " + quoteForMessage(map.name) + " in " +
                             (folder.empty() ? "." : folder.string()),
                         ExitCode::missingFile);
    }

    void diffuse() {
        current_->diffuse = color();
        hasDiffuse_ = true;
    }
    void specular() { current_->specular = color(); }
    void emission() { current_->emission = color(); }
    void shininess() { current_->shininess = number(largestNumber); }
    void illumination() {
        const float model = number(10);
        if (model != std::floor(model)) fail("expected a whole number");
        current_->illuminationModel = static_cast<int>(model);
    }
    void roughness() { current_->roughness = unitNumber(); }
    void metallic() { current_->metallic = unitNumber(); }

    void indexOfRefraction() {
        const float index = number(100);
        if (index > 0)
            current_->indexOfRefraction = index;
        else
            note("Ni 0 ignored");
    }

    void dissolve() {
        current_->opacity = unitNumber();
        hasDissolve_ = true;
    }

    /// Exporters write it beside the `d` that it should complement, and not always truly.
    void transparency() {
        const float opacity = 1.0f - unitNumber();
        if (!hasDissolve_)
            current_->opacity = opacity;
        else if (opacity != current_->opacity)
            note("Tr ignored, d is there too");
    }

    void diffuseMap() { diffuseMap_ = map(); }
    void opacityMap() { opacityMap_ = map(); }

    Map map() {
        std::string_view text = lines_.takeRest();
        while (true) {
            const auto option = std::ranges::find(mapOptions, firstWord(text), &MapOption::name);
            if (option == mapOptions.end()) break;
            ignore(std::string(keyword_) + ' ' + std::string(option->name));
            text = afterOption(text, *option);
        }
        if (text.empty()) note(std::string(keyword_) + " names no file");
        return {std::string(text), lines_.number()};
    }

    /// Three numbers, or one for all of them.
    Vec3 color() {
        const float red = number(largestNumber);
        if (lines_.atEnd()) return {red, red, red};
        const float green = number(largestNumber);
        return {red, green, number(largestNumber)};
    }

    float unitNumber() {
        const float written = number(largestNumber);
        if (written <= 1) return written;
        note(std::string(keyword_) + " above 1 taken as 1");
        return 1;
    }

    float number(float highest) {
        const std::string_view word = lines_.word();
        const std::optional<double> value = parseNumber(word);
        if (!value || !(*value >= 0.0 && *value <= double{highest}))
            fail("expected a number from 0 to " +
                 (highest == largestNumber ? "1e18" : std::to_string(static_cast<int>(highest))) +
                 ", found " + quoteForMessage(word));
        return static_cast<float>(*value);
    }

    [[noreturn]] void fail(const std::string& message) const {
        lines_.fail(std::string(keyword_) + ": " + message);
    }
    void note(const std::string& message) {
        notes_.push_back(file_.string() + ":" + std::to_string(lines_.number()) + ": " + message);
    }
    void ignore(const std::string& what) {
        ignored_.insert(ignored_.size() < mostListed ? what : "...");
    }

    const std::filesystem::path& file_;
    const std::set<std::string>& wanted_;
    std::vector<std::string>& notes_;
    std::string text_;
    TextLines lines_;
    std::string_view keyword_;

    std::optional<ObjMaterial> current_;
    bool isWanted_ = false, hasDiffuse_ = false, hasDissolve_ = false;
    Map diffuseMap_, opacityMap_;
    std::vector<ObjMaterial> materials_;
    std::set<std::string> begun_, ignored_;
};

const std::array<MtlReader::Statement, 12> MtlReader::statements = {{
    {"Kd", &MtlReader::diffuse},
    {"Ks", &MtlReader::specular},
    {"Ke", &MtlReader::emission},
    {"Ns", &MtlReader::shininess},
    {"Ni", &MtlReader::indexOfRefraction},
    {"d", &MtlReader::dissolve},
    {"Tr", &MtlReader::transparency},
    {"illum", &MtlReader::illumination},
    {"Pr", &MtlReader::roughness},
    {"Pm", &MtlReader::metallic},
    {"map_Kd", &MtlReader::diffuseMap},
    {"map_d", &MtlReader::opacityMap},
}};

}  // namespace

std::vector<ObjMaterial> readMtl(const std::filesystem::path& file,
                                 const std::set<std::string>& wanted,
                                 std::vector<std::string>& notes) {
    return MtlReader(file, wanted, notes).read();
}

}  // namespace etendue
