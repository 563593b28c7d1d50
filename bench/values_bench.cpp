// Nanoseconds of a polynomial's values, without derivatives, by nested schemes
// (PolynomialEvaluator) and as a lens asks for them (ValueEvaluator): the first guess of
// connections and the clips, of each lens given. Medians of interleaved rounds of one thread's own
// time.
#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <vector>

#include "lens/fit_cache.h"
#include "lens/fit_domain.h"
#include "lens/polynomial_products.h"

namespace etendue {
namespace {

constexpr int rounds = 51;
volatile double sink;

double threadNanoseconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

template <class Evaluator>
double nanoseconds(const Evaluator& evaluator, const std::vector<PolynomialInput>& inputs) {
    const double start = threadNanoseconds();
    for (const PolynomialInput& input : inputs) sink = evaluator.values(input)[0];
    return (threadNanoseconds() - start) / static_cast<double>(inputs.size());
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void measure(const std::string& lens, const char* name, const SparsePolynomial& polynomial) {
    if (polynomial.groups.empty()) return;
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::vector<PolynomialInput> inputs(1024);
    for (PolynomialInput& input : inputs) {
        input.s = Eigen::Vector2d(unit(random), unit(random)) / polynomial.scaling.sensorScale;
        input.p = Eigen::Vector2d(unit(random), unit(random)) / polynomial.scaling.secondScale;
        input.wavelengthNm = 550.0 + 150.0 * unit(random);
    }
    const PolynomialEvaluator<double> nested(polynomial);
    const ValueEvaluator asAsked(polynomial);
    std::vector<double> nestedTimes, times;
    for (int round = 0; round < rounds; ++round) {
        nestedTimes.push_back(nanoseconds(nested, inputs));
        times.push_back(nanoseconds(asAsked, inputs));
    }
    std::size_t terms = 0;
    for (const TermGroup& group : polynomial.groups) terms += group.terms.size();
    fmt::print("{:<44}{:>8}{:>8}{:>10.1f}{:>10.1f}\n", lens, name, terms, median(nestedTimes),
               median(times));
}

}  // namespace
}  // namespace etendue

/// Arguments: prescriptions.
int main(int argc, char** argv) {
    using namespace etendue;
    fmt::print("{:<44}{:>8}{:>8}{:>10}{:>10}\n", "lens", "", "terms", "nested", "as asked");
    for (int i = 1; i < argc; ++i)
        for (const Prescription& prescription : loadPrescriptions(argv[i])) {
            FitSettings settings;
            if (isAnamorphic(prescription)) settings.basis = PolynomialBasis::twoPlane;
            const LensFit fit =
                cachedFit(prescription, fitDomain(prescription, {}), settings, fitCacheDirectory());
            measure(prescription.name, "guess", fit.start.sensor);
            measure(prescription.name, "clip", fit.clip.squares);
        }
}
