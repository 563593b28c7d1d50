#include "renderer/obj_scan.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_map>

#include "renderer/text_lines.h"

namespace etendue {
namespace {

constexpr double largestCoordinate = 1e18;  // beyond this Embree aborts
constexpr std::size_t mostFaceCorners = 4096;
constexpr std::size_t mostMaterials = 65535;
constexpr std::size_t mostListed = 20;  // kinds of what is ignored
// The parser counts in int.
constexpr std::size_t mostElements = std::numeric_limits<std::int32_t>::max();

constexpr std::array<std::string_view, 3> freeFormElements = {"curv", "curv2", "surf"};
/// Statements without effect on triangles, or that belong to elements noted as ignored.
constexpr std::array<std::string_view, 21> silentStatements = {
    "g",  "o",   "vp",  "cstype", "deg",   "bmat",     "step",     "parm", "trim",  "hole", "scrv",
    "sp", "end", "con", "mg",     "bevel", "c_interp", "d_interp", "lod",  "ctech", "stech"};

template <class Names>
bool contains(const Names& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

/// What an index can name, and the largest one seen: `v` lines may follow the faces that use them.
struct Target {
    std::string_view name;
    std::size_t count = 0;
    std::size_t largest = 0;
    std::size_t largestLine = 0;
};

class ObjScanner {
public:
    ObjScanner(std::string& text, const std::filesystem::path& file)
        : file_(file), lines_(text, file) {}

    ObjScan scan() {
        while (lines_.next()) statement(lines_.word());
        finish();
        return std::move(result_);
    }

private:
    struct Ignored {
        std::size_t count = 0;
        std::size_t firstLine = 0;
    };

    void statement(std::string_view keyword) {
        if (keyword.empty()) return;
        if (keyword == "v")
            vertex();
        else if (keyword == "vn")
            normal();
        else if (keyword == "vt")
            textureCoordinate();
        else if (keyword == "f")
            face();
        else if (keyword == "usemtl")
            useMaterial(lines_.takeRest());
        else if (keyword == "mtllib")
            result_.libraries.push_back({std::string(lines_.takeRest()), lines_.number()});
        else if (keyword == "s")
            smoothingGroup();
        else if (keyword == "l")
            ignore("lines (l)");
        else if (keyword == "p")
            ignore("points (p)");
        else if (contains(freeFormElements, keyword))
            ignore("free-form curves and surfaces (curv, curv2, surf)");
        else if (!contains(silentStatements, keyword))
            ignore("statements " + quoteForMessage(keyword));
    }

    void vertex() {
        const std::size_t count = numbers();
        if (count != 3 && count != 4 && count != 6 && count != 7)
            wrongCount("v", "3 coordinates, with a weight or a colour or both", count);
        if (count > 4) ignore("vertex colours");
        add(positions_);
    }

    void normal() {
        if (const std::size_t count = numbers(); count != 3)
            wrongCount("vn", "3 coordinates", count);
        add(normals_);
    }

    void textureCoordinate() {
        if (const std::size_t count = numbers(); count < 1 || count > 3)
            wrongCount("vt", "1 to 3 coordinates", count);
        add(textureCoordinates_);
    }

    void face() {
        std::size_t count = 0;
        for (std::string_view word = lines_.word(); !word.empty(); word = lines_.word()) {
            corner(word);
            ++count;
        }
        if (count < 3 || count > mostFaceCorners)
            wrongCount("f", "3 to " + std::to_string(mostFaceCorners) + " corners", count);
        if (result_.materials.empty()) useMaterial("");
        ++result_.faces;
        result_.corners += count;
        if (result_.corners > mostElements) lines_.fail("more than 2147483647 corners of faces");
    }

    /// How many there are on the rest of the line.
    std::size_t numbers() {
        std::size_t count = 0;
        for (std::string_view word = lines_.word(); !word.empty(); word = lines_.word()) {
            checkNumber(word);
            ++count;
        }
        return count;
    }

    void checkNumber(std::string_view word) {
        const std::optional<double> value = parseNumber(word);
        if (!value) lines_.fail("expected a number, found " + quoteForMessage(word));
        if (std::abs(*value) > largestCoordinate)
            lines_.fail("expected a number within ±1e18, found " + quoteForMessage(word));
    }

    /// "position", "position/texture", "position//normal" or "position/texture/normal"; what stands
    /// behind the last slash may be missing, as some exporters write it.
    void corner(std::string_view word) {
        std::array<Target*, 3> targets = {&positions_, &textureCoordinates_, &normals_};
        std::string_view rest = word;
        for (std::size_t i = 0;; ++i) {
            const std::size_t slash = rest.find('/');
            const std::string_view part = rest.substr(0, slash);
            if (!part.empty())
                index(part, *targets[i], word);
            else if (i == 0)
                badCorner(word);
            if (slash == rest.npos) return;
            if (i == 2) badCorner(word);
            rest.remove_prefix(slash + 1);
        }
    }

    void index(std::string_view part, Target& target, std::string_view word) {
        std::int64_t value = 0;
        const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
        if (end != part.data() + part.size() || error == std::errc::invalid_argument)
            badCorner(word);
        if (value == 0 && error == std::errc{})
            lines_.fail("index 0 in " + quoteForMessage(word) + ", they count from 1");
        const auto known = static_cast<std::int64_t>(target.count);
        const auto limit = static_cast<std::int64_t>(mostElements);
        if (error != std::errc{} || value > limit || value < -known)
            lines_.fail(outOfRange(part, target));
        if (value > 0 && static_cast<std::size_t>(value) > target.largest) {
            target.largest = static_cast<std::size_t>(value);
            target.largestLine = lines_.number();
        }
    }

    static std::string outOfRange(std::string_view index, const Target& target) {
        return std::string(target.name) + " index " + std::string(index.substr(0, 40)) + " of " +
               std::to_string(target.count);
    }

    [[noreturn]] void badCorner(std::string_view word) const {
        lines_.fail("expected a corner such as 1, 1/2, 1//3 or 1/2/3, found " +
                    quoteForMessage(word));
    }

    [[noreturn]] void wrongCount(std::string_view keyword, const std::string& expected,
                                 std::size_t found) const {
        lines_.fail(std::string(keyword) + ": expected " + expected + ", found " +
                    std::to_string(found));
    }

    void add(Target& target) {
        if (++target.count > mostElements)
            lines_.fail("more than 2147483647 of one kind of vertex");
    }

    void useMaterial(std::string_view name) {
        const auto next = static_cast<std::uint32_t>(result_.materialNames.size());
        const auto [entry, isNew] = materialIndices_.emplace(name, next);
        if (isNew) result_.materialNames.emplace_back(name);
        if (result_.materialNames.size() > mostMaterials)
            lines_.fail("more than " + std::to_string(mostMaterials) + " materials");
        change(result_.materials, entry->second);
    }

    void smoothingGroup() {
        const std::string_view word = lines_.word();
        std::uint32_t group = word == "on" ? 1 : 0;
        if (word != "on" && word != "off") {
            const auto [end, error] =
                std::from_chars(word.data(), word.data() + word.size(), group);
            if (end != word.data() + word.size() || error != std::errc{})
                lines_.fail("s: expected a group number or off, found " + quoteForMessage(word));
        }
        change(result_.smoothing, group);
    }

    void change(std::vector<ObjChange>& changes, std::uint32_t value) const {
        const auto face = static_cast<std::uint32_t>(result_.faces);
        if (!changes.empty() && changes.back().firstFace == face)
            changes.back().value = value;
        else
            changes.push_back({face, value});
    }

    void ignore(const std::string& what) {
        const bool isListed = ignored_.size() < mostListed || ignored_.contains(what);
        Ignored& entry = ignored_[isListed ? what : "other statements"];
        if (entry.count++ == 0) entry.firstLine = lines_.number();
    }

    void finish() {
        for (const Target* target : {&positions_, &textureCoordinates_, &normals_})
            if (target->largest > target->count)
                lines_.failAtLine(target->largestLine,
                                  outOfRange(std::to_string(target->largest), *target));
        if (result_.faces == 0) throw InputError(file_.string() + ": no faces (f)");
        result_.positions = positions_.count;
        result_.normals = normals_.count;
        result_.textureCoordinates = textureCoordinates_.count;
        for (const auto& [what, entry] : ignored_)
            result_.notes.push_back(file_.string() + ":" + std::to_string(entry.firstLine) + ": " +
                                    std::to_string(entry.count) + " " + what + " ignored");
    }

    const std::filesystem::path& file_;
    TextLines lines_;
    ObjScan result_;
    Target positions_{"vertex"}, textureCoordinates_{"texture coordinate"}, normals_{"normal"};
    std::unordered_map<std::string, std::uint32_t> materialIndices_;
    std::map<std::string, Ignored> ignored_;
};

}  // namespace

ObjScan scanObj(std::string& text, const std::filesystem::path& file) {
    return ObjScanner(text, file).scan();
}

}  // namespace etendue
