// Generated code is compiled and run as its users would: C++ by the system's compiler; GLSL checked
// by glslangValidator, and run as C++ behind the few types that it uses of GLSL.
#include "lens/code_generation.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>

#include "lens/polynomial_lens.h"
#include "tests/lens/fitted_lenses.h"
#include "tests/support/temporary_folder.h"

namespace etendue {

namespace {

struct GeneratedLens {
    Prescription prescription;
    LensFit fit;
};

GeneratedLens axialLens(FitForm form) {
    FitSettings settings = smallSettings();
    settings.form = form;
    return {doubleGauss(), fitLens(doubleGauss(), doubleGaussDomain(), settings)};
}

/// Two mirror planes, coupled inputs, a picture cut to a disc.
GeneratedLens anamorphicLens() {
    const Prescription prescription = loadPrescription(lensFile("anamorphic-80x90mm.toml"));
    FitSettings settings = smallSettings();
    settings.basis = PolynomialBasis::twoPlane;
    return {prescription,
            fitLens(prescription, domainOf(prescription, {11.8, 7.85}, 12.0), settings)};
}

GeneratedLens fisheye() {
    const Prescription prescription = loadPrescription(lensFile("fisheye-220-6mm-f2.8.toml"));
    return {prescription,
            fitLens(prescription, domainOf(prescription, {12.0, 12.0}, 11.0), smallSettings())};
}

/// Over the domain and as far again beyond it.
std::vector<FitQuery> queriesFor(const FitDomain& domain, std::size_t count) {
    FitDomain wider = domain;
    wider.sensorHalfSizeMm *= 1.2;
    wider.imageRadiusMm *= 1.2;
    wider.apertureRadiusMm *= 1.2;
    wider.shortestWavelengthNm -= 20.0;
    wider.longestWavelengthNm += 20.0;
    std::vector<FitQuery> queries;
    for (std::uint64_t i = 0; i < count; ++i) queries.push_back(drawQuery(wider, 21, i));
    return queries;
}

/// What a generated lens answers: whether there is a ray, then origin, direction, their derivatives
/// row by row, and the throughput.
using Answer = std::array<double, 20>;

Answer answerOf(const std::optional<ExitRay>& ray) {
    Answer answer{};
    if (!ray) return answer;
    answer[0] = 1.0;
    Eigen::Map<Eigen::Vector3d>(answer.data() + 1) = ray->origin;
    Eigen::Map<Eigen::Vector3d>(answer.data() + 4) = ray->direction;
    using Rows = Eigen::Matrix<double, 3, 2, Eigen::RowMajor>;
    Eigen::Map<Rows>(answer.data() + 7) = ray->originBySensor;
    Eigen::Map<Rows>(answer.data() + 13) = ray->directionBySensor;
    answer[19] = ray->throughput;
    return answer;
}

void writeQueries(const std::filesystem::path& file, const std::vector<FitQuery>& queries) {
    std::ofstream stream(file, std::ios::binary);
    for (const FitQuery& q : queries) {
        const std::array<double, 5> numbers{q.sensor.mm.x(), q.sensor.mm.y(), q.aperture.mm.x(),
                                            q.aperture.mm.y(), q.wavelengthNm};
        stream.write(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
    }
}

/// Compiles `program`, which reads queries from its standard input and writes answers, and runs it.
std::vector<Answer> answersOf(const TemporaryFolder& folder, const std::string& program,
                              const std::vector<FitQuery>& queries) {
    folder.write("main.cpp", program);
    writeQueries(folder / "queries", queries);
    const std::string in = "cd " + folder.path().string() + " && ";
    const std::string compile =
        "c++ -std=c++17 -O1 -ffp-contract=off -Wall -Wextra -Wshadow -Wconversion -Werror main.cpp "
        "-o main";
    REQUIRE(std::system((in + compile).c_str()) == 0);
    REQUIRE(std::system((in + "./main <queries >answers").c_str()) == 0);
    const std::string bytes = readFile(folder / "answers");
    std::vector<Answer> answers(bytes.size() / sizeof(Answer));
    std::copy_n(bytes.data(), answers.size() * sizeof(Answer),
                reinterpret_cast<char*>(answers.data()));
    REQUIRE(answers.size() == queries.size());
    return answers;
}

/// Reads queries, calls `answer(q, result)` for each, writes the results.
std::string programAround(const std::string& answer) {
    return answer + R"(
#include <cstdio>
int main() {
    double q[5];
    while (std::fread(q, sizeof q, 1, stdin) == 1) {
        double result[20] = {};
        answer(q, result);
        std::fwrite(result, sizeof result, 1, stdout);
    }
}
)";
}

std::string cPlusPlusProgram(const std::string& lensAndType) {
    return programAround("#include \"lens.h\"\nusing Lens = etendue_lenses::" + lensAndType + R"(;
using Real = decltype(Lens::Ray::throughput);
static void answer(const double* q, double* result) {
    const Real sensor[2] = {Real(q[0]), Real(q[1])}, aperture[2] = {Real(q[2]), Real(q[3])};
    const auto ray = Lens::trace(sensor, aperture, Real(q[4]));
    if (!ray) return;
    result[0] = 1.0;
    for (int i = 0; i < 3; ++i) {
        result[1 + i] = double(ray->origin[i]);
        result[4 + i] = double(ray->direction[i]);
        for (int j = 0; j < 2; ++j) {
            result[7 + 2 * i + j] = double(ray->originBySensor[i][j]);
            result[13 + 2 * i + j] = double(ray->directionBySensor[i][j]);
        }
    }
    result[19] = double(ray->throughput);
}
)");
}

/// What generated GLSL needs of the language. Columns of a matrix are named by their index.
constexpr const char* glslAsCPlusPlus = R"(#include <cmath>
using std::abs; using std::sqrt;
struct vec2 { float x, y; };
struct vec3 {
    float x, y, z;
    vec3() : x(0), y(0), z(0) {}
    vec3(float a, float b, float c) : x(a), y(b), z(c) {}
    vec3& operator+=(vec3 b) { x += b.x; y += b.y; z += b.z; return *this; }
};
static vec3 operator+(vec3 a, vec3 b) { return vec3(a.x + b.x, a.y + b.y, a.z + b.z); }
static vec3 operator-(vec3 a, vec3 b) { return vec3(a.x - b.x, a.y - b.y, a.z - b.z); }
static vec3 operator*(float f, vec3 a) { return vec3(f * a.x, f * a.y, f * a.z); }
struct mat2x3 {
    vec3 columns[2];
    mat2x3() {}
    mat2x3(vec3 a, vec3 b) : columns{a, b} {}
};
)";

std::string glslProgram() {
    return programAround(std::string(glslAsCPlusPlus) + R"(
namespace {
#include "lens.glsl"
}
static void answer(const double* q, double* result) {
    const Lens220DegreeLensRay ray = lens220DegreeLensTrace(
        {float(q[0]), float(q[1])}, {float(q[2]), float(q[3])}, float(q[4]));
    if (!ray.passes) return;
    result[0] = 1.0;
    const auto store = [](vec3 v, double* to, int stride) {
        to[0] = double(v.x); to[stride] = double(v.y); to[2 * stride] = double(v.z);
    };
    store(ray.origin, result + 1, 1);
    store(ray.direction, result + 4, 1);
    for (int j = 0; j < 2; ++j) {
        store(ray.originBySensor.columns[j], result + 7 + j, 2);
        store(ray.directionBySensor.columns[j], result + 13 + j, 2);
    }
    result[19] = double(ray.throughput);
}
)");
}

/// Each number relative to the largest of its kind among all answers; `atRims` of the queries may
/// be so near the domain's edge or a rim that rounding decides whether there is a ray.
void checkAnswers(const GeneratedLens& lens, const std::vector<FitQuery>& queries,
                  const std::vector<Answer>& answers, double tolerance, std::size_t atRims) {
    const PolynomialLens model(lens.prescription, lens.fit,
                               Aperture(lens.fit.domain.apertureRadiusMm));
    std::vector<Answer> expected;
    Answer largest{};
    for (const FitQuery& q : queries) {
        expected.push_back(answerOf(model.trace(q.sensor, q.aperture, q.wavelengthNm)));
        for (std::size_t i = 0; i < largest.size(); ++i)
            largest[i] = std::max(largest[i], std::abs(expected.back()[i]));
    }
    // The z components of axial derivatives are small beside x and y.
    for (const auto& [first, last] : {std::pair(1, 4), {4, 7}, {7, 13}, {13, 19}})
        std::fill(largest.begin() + first, largest.begin() + last,
                  *std::max_element(largest.begin() + first, largest.begin() + last));
    std::size_t passed = 0, different = 0;
    Answer worst{};
    for (std::size_t n = 0; n < queries.size(); ++n) {
        passed += expected[n][0] == 1.0;
        if (answers[n][0] != expected[n][0]) {
            ++different;
            continue;
        }
        for (std::size_t i = 1; i < worst.size(); ++i)
            worst[i] = std::max(worst[i], std::abs(answers[n][i] - expected[n][i]) / largest[i]);
    }
    CHECK(passed > queries.size() / 20);
    CHECK(passed < queries.size() * 9 / 10);
    CHECK(different <= atRims);
    CHECK(*std::ranges::max_element(worst) <= tolerance);
}

// A sum of 12 terms of degree 5 rounds some 30 times, and its terms are a few times the sum.
constexpr double roundings = 100.0;

}  // namespace

TEST_CASE("Generated C++: it compiles without a warning and answers as the model does" *
          doctest::test_suite("slow")) {
    for (const GeneratedLens& lens : {axialLens(FitForm::twoPoint), anamorphicLens(), fisheye()}) {
        const TemporaryFolder folder;
        folder.write("lens.h",
                     generateCode(lens.fit, lens.prescription, CodeLanguage::cPlusPlus, "a lens"));
        const auto queries = queriesFor(lens.fit.domain, 20'000);
        checkAnswers(lens, queries, answersOf(folder, cPlusPlusProgram("ALens<double>"), queries),
                     0x1p-53 * roundings, 0);
        checkAnswers(lens, queries, answersOf(folder, cPlusPlusProgram("ALens<float>"), queries),
                     0x1p-24 * roundings, queries.size() / 1000);
    }
}

TEST_CASE("Generated C++: the sensor-state form solves for the slope as the model does") {
    const GeneratedLens lens = axialLens(FitForm::sensorState);
    const TemporaryFolder folder;
    folder.write("lens.h",
                 generateCode(lens.fit, lens.prescription, CodeLanguage::cPlusPlus, "a lens"));
    const auto queries = queriesFor(lens.fit.domain, 20'000);
    // Both end their search once a step more would gain 1e-10.
    checkAnswers(lens, queries, answersOf(folder, cPlusPlusProgram("ALens<double>"), queries), 1e-8,
                 0);
}

TEST_CASE("Generated GLSL: valid in ES 3.00 and 4.50, and answers as the model does" *
          doctest::test_suite("slow")) {
    for (const GeneratedLens& lens : {axialLens(FitForm::twoPoint), axialLens(FitForm::sensorState),
                                      anamorphicLens(), fisheye()}) {
        const TemporaryFolder folder;
        const std::string text =
            generateCode(lens.fit, lens.prescription, CodeLanguage::glsl, "220-degree lens");
        const std::string main =
            "\nout vec4 colour;\nvoid main() {\n    Lens220DegreeLensRay ray ="
            " lens220DegreeLensTrace(vec2(1.0), vec2(0.5), 550.0);\n"
            "    colour = vec4(ray.direction, ray.throughput);\n}\n";
        folder.write("es.frag", "#version 300 es\n" + text + "precision highp float;" + main);
        folder.write("desktop.frag", "#version 450\n" + text + "layout(location = 0)" + main);
        for (const char* shader : {"es.frag", "desktop.frag"})
            CHECK(std::system(("glslangValidator " + (folder / shader).string()).c_str()) == 0);
        folder.write("lens.glsl", text);
        const auto queries = queriesFor(lens.fit.domain, 20'000);
        checkAnswers(lens, queries, answersOf(folder, glslProgram(), queries), 0x1p-24 * roundings,
                     queries.size() / 1000);
    }
}

TEST_CASE("Generated code: it names its lens, its source and its measured errors") {
    const GeneratedLens lens = axialLens(FitForm::twoPoint);
    for (const CodeLanguage language : {CodeLanguage::cPlusPlus, CodeLanguage::glsl}) {
        const std::string text =
            generateCode(lens.fit, lens.prescription, language, "double-gauss-100mm");
        const bool isHeader = language == CodeLanguage::cPlusPlus;
        CHECK(text.starts_with("// SPDX-License-Identifier: Apache-2.0\n"));
        for (const std::string& word :
             {lens.prescription.name, lens.prescription.source, std::string("direction, mrad"),
              std::string(isHeader ? "struct DoubleGauss100mm {" : "struct DoubleGauss100mmRay {")})
            CHECK(text.find(word) != std::string::npos);
    }
    CHECK_THROWS_AS(generateCode(lens.fit, lens.prescription, CodeLanguage::glsl, "--"),
                    std::invalid_argument);
}

}  // namespace etendue
