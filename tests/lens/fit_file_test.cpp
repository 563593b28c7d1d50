#include "lens/fit_file.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>

#include "lens/fit_cache.h"
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

TEST_CASE("Fit file: a fit of another lens, domain or number of terms is stale") {
    const TemporaryDirectory directory;
    const std::filesystem::path file = directory.path() / "fit.json";
    writeFitFile(file, someFit());
    const FitKey key = fitKey(doubleGauss(), doubleGaussDomain(), smallSettings());
    FitKey lens = key, domain = key, settings = key;
    lens.prescriptionHash ^= 1;
    domain.domain.apertureRadiusMm *= 0.5;
    settings.settings.terms += 1;
    for (const FitKey& other : {lens, domain, settings}) {
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
