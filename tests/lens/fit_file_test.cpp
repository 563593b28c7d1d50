#include "lens/fit_file.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "lens/fit_cache.h"
#include "lens/hash.h"
#include "tests/lens/fitted_lenses.h"

namespace etendue {

namespace {

class TemporaryDirectory {
public:
    TemporaryDirectory()
        : path_(std::filesystem::temp_directory_path() /
                ("etendue-fit-test-" + std::to_string(::getpid()))) {
        std::filesystem::remove_all(path_);
        std::filesystem::create_directories(path_);
    }
    ~TemporaryDirectory() { std::filesystem::remove_all(path_); }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

const LensFit& someFit() {
    static const LensFit fit = fitLens(doubleGauss(), doubleGaussDomain(), smallSettings());
    return fit;
}

std::string textOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(stream), {});
}
void write(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

void checkSame(const SparsePolynomial& a, const SparsePolynomial& b) {
    CHECK(a.basis == b.basis);
    CHECK(a.outputs.vectors == b.outputs.vectors);
    CHECK(a.outputs.scalars == b.outputs.scalars);
    CHECK(a.scaling.sensorScale == b.scaling.sensorScale);
    CHECK(a.scaling.secondScale == b.scaling.secondScale);
    CHECK(a.scaling.coupling == b.scaling.coupling);
    CHECK(a.scaling.waveScale == b.scaling.waveScale);
    CHECK(a.scaling.waveOffset == b.scaling.waveOffset);
    REQUIRE(a.groups.size() == b.groups.size());
    for (std::size_t g = 0; g < a.groups.size(); ++g) {
        CHECK(a.groups[g].outputs == b.groups[g].outputs);
        CHECK(a.groups[g].terms == b.groups[g].terms);
        CHECK(a.groups[g].coefficients == b.groups[g].coefficients);
    }
}

}  // namespace

TEST_CASE("Fit file: what is read has the bits that were written") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory.path() / "fit.json";
    writeFitFile(file, someFit());
    CHECK(textOf(file) == fitFileText(someFit()));
    const FitFileContent content =
        readFitFile(file, fitKey(doubleGauss(), doubleGaussDomain(), smallSettings()));
    CHECK(content.refusal.empty());
    REQUIRE(content.fit.has_value());
    checkSame(content.fit->exit, someFit().exit);
    checkSame(content.fit->aperture, someFit().aperture);
    checkSame(content.fit->slope, someFit().slope);
    checkSame(content.fit->clip.squares, someFit().clip.squares);
    checkSame(content.fit->start.sensor, someFit().start.sensor);
    CHECK(content.fit->start.nearnessBend == someFit().start.nearnessBend);
    CHECK(content.fit->start.widestField == someFit().start.widestField);
    CHECK(content.fit->start.errorMm == someFit().start.errorMm);
    CHECK(content.fit->clip.surfaces == someFit().clip.surfaces);
    CHECK(content.fit->clip.reflecting == someFit().clip.reflecting);
    CHECK(content.fit->errors.directionMrad.rms == someFit().errors.directionMrad.rms);
    CHECK(content.fit->errors.etendue.most == someFit().errors.etendue.most);
    CHECK(content.fit->training.drawn == someFit().training.drawn);
    CHECK(content.fit->clipErrors.wronglyBlocked == someFit().clipErrors.wronglyBlocked);
}

TEST_CASE("Fit file: nothing but the file itself is left behind, also over an older one") {
    const TemporaryDirectory directory;
    for (int i = 0; i < 2; ++i) writeFitFile(directory.path() / "fit.json", someFit());
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(directory.path()))
        ++files;
    CHECK(files == 1);
    CHECK_THROWS_AS(writeFitFile(directory.path() / "nowhere" / "fit.json", someFit()),
                    std::runtime_error);
}

TEST_CASE("Fit file: truncated anywhere, it is refused with a reason") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory.path() / "fit.json";
    writeFitFile(file, someFit());
    const std::string text = textOf(file);
    // Every byte but the newline at the end is needed.
    for (std::size_t length = 0; length + 1 < text.size(); length += 1 + text.size() / 60) {
        write(file, text.substr(0, length));
        const FitFileContent content = readFitFile(file);
        CHECK_FALSE(content.fit.has_value());
        CHECK(content.refusal.find("fit.json: ") != std::string::npos);
    }
}

TEST_CASE("Fit file: one digit changed is noticed") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory.path() / "fit.json";
    writeFitFile(file, someFit());
    const std::string text = textOf(file);
    int changed = 0;
    for (std::size_t i = 0; i < text.size(); i += 1 + text.size() / 60) {
        if (text[i] < '0' || text[i] > '9') continue;
        std::string other = text;
        other[i] = other[i] == '7' ? '3' : '7';
        write(file, other);
        CHECK_FALSE(readFitFile(file).fit.has_value());
        ++changed;
    }
    CHECK(changed > 20);
}

TEST_CASE("Fit file: what is no fit is refused, not trusted") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory.path() / "fit.json";
    CHECK(readFitFile(file).refusal.find("no such file") != std::string::npos);
    for (const std::string& text :
         {std::string("{}"), std::string("[1, 2]"), std::string("\"fit\""),
          std::string("\0\xff", 2), std::string("{\"format\": 3}"),
          std::string("{\"format\": \"etendue lens fit 1\"}"), std::string(100'000, '[')}) {
        write(file, text);
        const FitFileContent content = readFitFile(file);
        CHECK_FALSE(content.fit.has_value());
        CHECK_FALSE(content.refusal.empty());
    }
}

TEST_CASE(
    "Fit file: polynomials that are not built as a fit's are refused, whatever the checksum") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory.path() / "fit.json";
    const auto refusalOf = [&](const auto& change) {
        LensFit fit = someFit();
        change(fit);
        writeFitFile(file, fit);
        const FitFileContent content = readFitFile(file);
        CHECK_FALSE(content.fit.has_value());
        return content.refusal;
    };
    const auto has = [](const std::string& text, const char* part) {
        return text.find(part) != std::string::npos;
    };
    const auto repeatRow = [](TermGroup& group, std::vector<int> outputs) {
        group.outputs = std::move(outputs);
        group.coefficients = Eigen::MatrixXd::Ones(static_cast<Eigen::Index>(group.outputs.size()),
                                                   group.coefficients.cols());
    };
    CHECK(has(refusalOf([&](LensFit& fit) {
                  fit.exit.outputs = {0, 1};
                  repeatRow(fit.exit.groups.front(), {0});
              }),
              "exit: expected 2 vectors and 1 scalars"));
    // Twenty thousand times output 4, one missing, two exchanged, none at all, one group too many.
    const std::vector<std::vector<int>> wrong{
        std::vector<int>(20'000, 4), {0, 1, 2, 3}, {1, 0, 2, 3, 4}, {}, {0, 1, 2, 3, 3}};
    for (const std::vector<int>& outputs : wrong)
        CHECK(has(refusalOf([&](LensFit& fit) { repeatRow(fit.exit.groups.front(), outputs); }),
                  "exit: its outputs"));
    CHECK(has(refusalOf([](LensFit& fit) { fit.exit.groups.push_back(fit.exit.groups[0]); }),
              "exit: its outputs"));
    CHECK(has(refusalOf([](LensFit& fit) { fit.exit.groups.clear(); }), "exit: its outputs"));
    CHECK(has(refusalOf([](LensFit& fit) { fit.exit.groups[0].terms[0].back() = 1; }),
              "exit: a term"));
    CHECK(has(refusalOf([](LensFit& fit) { fit.settings.form = FitForm::sensorState; }),
              "aperture: expected"));
    CHECK(has(refusalOf([](LensFit& fit) { fit.start.sensor = fit.exit; }), "start: expected"));
    CHECK(has(refusalOf([](LensFit& fit) { fit.clip.surfaces.push_back(3); }), "clip: expected"));
    CHECK(has(refusalOf([](LensFit& fit) { fit.domain.sensorTravelMm = 1.0; }), "slope: expected"));
    CHECK(has(refusalOf([](LensFit& fit) { fit.domain.imageRadiusMm = 0.0; }), "domain"));
    refusalOf([](LensFit& fit) { fit.exit.groups[0].coefficients(0, 0) = std::nan(""); });
    refusalOf([](LensFit& fit) { fit.exit.scaling.waveScale = HUGE_VAL; });
}

TEST_CASE("Fit file: counts that are none are refused, whatever the checksum") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory.path() / "fit.json";
    const auto refusalOf = [&](const std::string& count) {
        LensFit fit = someFit();
        fit.training.drawn = 123456789;
        std::string text = fitFileText(fit);
        text.replace(text.find("123456789"), 9, count);
        const std::size_t begin = text.find("\"fit\":") + 6, end = text.rfind(",\"format\"");
        std::ostringstream checksum;
        checksum << std::hex << fnv1a(text.substr(begin, end - begin));
        write(file, "{\"checksum\":\"" + checksum.str() + "\"," + text.substr(begin - 6));
        return readFitFile(file).refusal;
    };
    CHECK(refusalOf("12345").empty());
    CHECK(refusalOf("4e+88").ends_with("a count is not whole"));
    CHECK(refusalOf("0.5").ends_with("a count is not whole"));
    CHECK(refusalOf("-1").ends_with("a count is out of range"));
    CHECK(refusalOf("18446744073709551615").ends_with("a count is out of range"));
}

TEST_CASE("Fit file: fits in both forms, with a focus range and of two planes are read back") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory.path() / "fit.json";
    for (const PolynomialBasis basis : {PolynomialBasis::axial, PolynomialBasis::twoPlane,
                                        PolynomialBasis::cartesian, PolynomialBasis::none}) {
        FitSettings settings = smallSettings();
        settings.form = FitForm::sensorState;
        settings.basis = basis;
        settings.degree = 3;
        FitDomain domain = doubleGaussDomain();
        domain.sensorTravelMm = 1.0;
        writeFitFile(file, fitLens(doubleGauss(), domain, settings));
        CHECK(readFitFile(file).refusal == "");
    }
}

TEST_CASE("Fit file: threads that write the same file at once do not disturb each other") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory.path() / "fit.json";
    std::atomic<int> failures = 0;
    {
        std::vector<std::jthread> writers;
        for (int t = 0; t < 6; ++t)
            writers.emplace_back([&] {
                for (int i = 0; i < 20; ++i) try {
                        writeFitFile(file, someFit());
                    } catch (const std::runtime_error&) {
                        ++failures;
                    }
            });
    }
    CHECK(failures == 0);
    CHECK(readFitFile(file).refusal == "");
    CHECK(std::distance(std::filesystem::directory_iterator(directory.path()), {}) == 1);
}

TEST_CASE("Fit cache: what killed writes left is swept away after a day") {
    const TemporaryDirectory directory;
    const std::filesystem::path old = directory.path() / "a.json.1.part",
                                fresh = directory.path() / "b.json.2.part",
                                fit = directory.path() / "a.json";
    for (const auto& file : {old, fresh, fit}) write(file, "{");
    const auto longAgo = std::filesystem::file_time_type::clock::now() - std::chrono::hours(25);
    for (const auto& file : {old, fit}) std::filesystem::last_write_time(file, longAgo);
    removeStaleParts(directory.path());
    CHECK_FALSE(std::filesystem::exists(old));
    CHECK(std::filesystem::exists(fresh));
    CHECK(std::filesystem::exists(fit));
    removeStaleParts(directory.path() / "nowhere");
}

TEST_CASE("Fit file: a fit of another lens, domain or number of terms is stale") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory.path() / "fit.json";
    writeFitFile(file, someFit());
    const FitKey key = fitKey(doubleGauss(), doubleGaussDomain(), smallSettings());
    FitKey lens = key, domain = key, settings = key;
    FitKey version = key;
    version.algorithm += 1;
    lens.prescriptionHash ^= 1;
    domain.domain.apertureRadiusMm *= 0.5;
    settings.settings.terms += 1;
    for (const FitKey& other : {lens, domain, settings, version}) {
        const FitFileContent content = readFitFile(file, other);
        CHECK_FALSE(content.fit.has_value());
        CHECK(content.refusal.find("stale") != std::string::npos);
        CHECK(fitCacheFile("x", other) != fitCacheFile("x", key));
    }
}

TEST_CASE("Fit cache: a lens is fitted once, and again when its file is damaged") {
    const TemporaryDirectory directory;
    std::vector<std::string> notices;
    const auto get = [&] {
        notices.clear();
        return cachedFit(doubleGauss(), doubleGaussDomain(), smallSettings(),
                         directory.path() / "new" / "cache",
                         [&](const std::string& notice) { notices.push_back(notice); });
    };
    const LensFit first = get();
    CHECK(notices.size() == 1);
    const LensFit second = get();
    CHECK(notices.empty());
    checkSame(first.exit, second.exit);
    const FitKey key = fitKey(doubleGauss(), doubleGaussDomain(), smallSettings());
    write(fitCacheFile(directory.path() / "new" / "cache", key), "{");
    checkSame(get().exit, first.exit);
    CHECK(notices.size() == 2);
    get();
    CHECK(notices.empty());
}

TEST_CASE("Fit file: it is loaded in milliseconds") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory.path() / "fit.json";
    LensFit fit = someFit();
    TermGroup& group = fit.exit.groups.front();
    group.terms.assign(64, group.terms.front());
    group.coefficients = Eigen::MatrixXd::Constant(5, 64, 1.0 / 3.0);
    writeFitFile(file, fit);
    auto fastest = std::chrono::steady_clock::duration::max();
    for (int i = 0; i < 20; ++i) {
        const auto start = std::chrono::steady_clock::now();
        REQUIRE(readFitFile(file).fit.has_value());
        fastest = std::min(fastest, std::chrono::steady_clock::now() - start);
    }
    CHECK(fastest < std::chrono::milliseconds(10));
}

}  // namespace etendue
