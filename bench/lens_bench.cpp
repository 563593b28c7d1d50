// Nanoseconds on one core: a fitted polynomial in every way it can be asked, beside the exact trace
// of the same rays. Arguments: prescriptions.
#include <dlfcn.h>
#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <stdexcept>
#include <vector>

#include "lens/code_generation.h"
#include "lens/fit_domain.h"
#include "lens/polynomial.h"
#include "lens/polynomial_lens.h"
#include "lens/thread_time.h"
#include "lens/traced_lens.h"

namespace etendue {
namespace {

volatile double sink;  // what is computed must not be optimised away

/// Does something `count` times.
struct Contestant {
    std::string name;
    std::size_t count;
    std::function<void()> run;
    std::vector<double> nanoseconds = {};  // of one, by round
};

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// All take turns, so that what else the machine does falls on all alike. A turn begins untimed:
/// caches, predictions and wide registers, which sleep when unused, are as in the midst of work.
void race(std::vector<Contestant>& contestants) {
    constexpr int rounds = 51;
    for (int round = 0; round < rounds; ++round)
        for (Contestant& contestant : contestants) {
            contestant.run();
            const double start = threadSeconds();
            contestant.run();
            contestant.nanoseconds.push_back(1e9 * (threadSeconds() - start) /
                                             static_cast<double>(contestant.count));
        }
}

using Inputs = std::vector<PolynomialInput>;

template <class T>
void addSingle(std::vector<Contestant>& contestants, const std::string& name,
               const SparsePolynomial& polynomial, const Inputs& inputs) {
    const PolynomialEvaluator<T> evaluator(polynomial);
    contestants.push_back({name + " value", inputs.size(), [=] {
                               for (const PolynomialInput& input : inputs)
                                   sink = evaluator.values(input)[0];
                           }});
    contestants.push_back({name + " by sensor", inputs.size(), [=] {
                               for (const PolynomialInput& input : inputs)
                                   sink = evaluator.evaluateBySensor(input).bySensor[0][0];
                           }});
    contestants.push_back({name + " Jacobian", inputs.size(), [=] {
                               for (const PolynomialInput& input : inputs)
                                   sink = evaluator.evaluate(input).jacobian[0][0];
                           }});
}

template <class T, int size>
void addBatch(std::vector<Contestant>& contestants, const std::string& name,
              const SparsePolynomial& polynomial, const Inputs& inputs,
              VectorRegisters registers = widestRegisters()) {
    const PolynomialEvaluator<T> evaluator(polynomial, registers);
    std::vector<BatchInput<T, size>> batches(inputs.size() / size);
    for (std::size_t b = 0; b < batches.size(); ++b)
        for (int i = 0; i < size; ++i) {
            const PolynomialInput& input = inputs[b * size + static_cast<std::size_t>(i)];
            batches[b].sx[i] = static_cast<T>(input.s.x());
            batches[b].sy[i] = static_cast<T>(input.s.y());
            batches[b].px[i] = static_cast<T>(input.p.x());
            batches[b].py[i] = static_cast<T>(input.p.y());
            batches[b].wavelengthNm[i] = static_cast<T>(input.wavelengthNm);
        }
    const std::string full = name + fmt::format(" x{}", size);
    const std::size_t count = batches.size() * size;
    contestants.push_back({full + " value", count, [=] {
                               for (const auto& batch : batches)
                                   sink = evaluator.values(batch)[0][0];
                           }});
    contestants.push_back({full + " by sensor", count, [=] {
                               for (const auto& batch : batches)
                                   sink = evaluator.evaluateBySensor(batch).bySensor[0][0][0];
                           }});
    contestants.push_back({full + " Jacobian", count, [=] {
                               for (const auto& batch : batches)
                                   sink = evaluator.evaluate(batch).jacobian[0][0][0];
                           }});
}

/// A quick fit: its speed is that of any with as many terms.
FitSettings settingsFor(PolynomialBasis basis, int terms) {
    FitSettings settings;
    settings.basis = basis;
    settings.terms = terms;
    settings.raysPerCandidate = 4;
    settings.refinements = 0;
    settings.clip.rays = 2000;
    if (basis == PolynomialBasis::cartesian) settings.degree = 7;
    return settings;
}

/// A ray that passes, with the slope that belongs to it.
struct Ray {
    FitQuery query;
    SensorState state;
    ExitRay exit;
};

constexpr double targetDistancesMetres[] = {0.1, 2.0, 1000.0};

std::vector<Ray> drawRays(const TracedLens& exact, const FitDomain& domain, std::size_t count) {
    std::vector<Ray> rays;
    for (std::uint64_t i = 0; rays.size() < count; ++i) {
        const FitQuery query = drawQuery(domain, 1, i);
        const auto exit = exact.trace(query.sensor, query.aperture, query.wavelengthNm);
        if (!exit) continue;
        const auto slope = exact.at(query.wavelengthNm)->slopeThrough(query.sensor, query.aperture);
        rays.push_back(
            {query, {query.sensor.mm.x(), query.sensor.mm.y(), slope->x(), slope->y()}, *exit});
    }
    return rays;
}

struct Target {
    Eigen::Vector3d mm;
    AperturePoint aperture;
    double wavelengthNm;
};

/// Two metres off in any direction, those that no sensor point sees.
std::vector<Target> unseenTargets(const auto& lens, const std::vector<Ray>& rays) {
    std::mt19937_64 engine(1);
    std::normal_distribution<double> normal;
    std::vector<Target> targets;
    for (const Ray& ray : rays) {
        const double x = normal(engine), y = normal(engine), z = normal(engine);
        const Eigen::Vector3d mm = 2e3 * Eigen::Vector3d(x, y, z).normalized();
        if (!lens.connect(mm, ray.query.aperture, ray.query.wavelengthNm))
            targets.push_back({mm, ray.query.aperture, ray.query.wavelengthNm});
    }
    return targets;
}

void addLens(std::vector<Contestant>& contestants, const std::string& name, const auto& lens,
             const std::vector<Ray>& rays) {
    contestants.push_back({name + " trace", rays.size(), [&] {
                               for (const auto& [query, state, exit] : rays) {
                                   const auto ray =
                                       lens.trace(query.sensor, query.aperture, query.wavelengthNm);
                                   sink = ray ? ray->throughput : 0.0;
                               }
                           }});
    const auto addTargets = [&](const std::string& what, std::vector<Target> targets) {
        contestants.push_back({name + " connect " + what, targets.size(), [&lens, targets] {
                                   for (const auto& [mm, aperture, nm] : targets) {
                                       const auto sensor = lens.connect(mm, aperture, nm);
                                       sink = sensor ? sensor->mm.x() : 0.0;
                                   }
                               }});
        contestants.push_back({name + " see " + what, targets.size(), [&lens, targets] {
                                   for (const auto& [mm, aperture, nm] : targets) {
                                       const auto sighting = lens.see(mm, aperture, nm);
                                       sink = sighting ? sighting->ray.throughput : 0.0;
                                   }
                               }});
    };
    for (const double metres : targetDistancesMetres) {
        std::vector<Target> targets;
        for (const Ray& ray : rays)
            targets.push_back({ray.exit.origin + 1e3 * metres * ray.exit.direction,
                               ray.query.aperture, ray.query.wavelengthNm});
        addTargets(fmt::format("{} m", metres), std::move(targets));
    }
    addTargets("2 m, unseen", unseenTargets(lens, rays));
}

/// The C++ that codegen writes of a fit, compiled as its users would and loaded.
class GeneratedLens {
public:
    GeneratedLens(const LensFit& fit, const Prescription& prescription) {
        std::string folder = (std::filesystem::temp_directory_path() / "etendue-XXXXXX").string();
        if (!::mkdtemp(folder.data())) throw std::runtime_error("cannot make " + folder);
        std::ofstream(folder + "/lens.h")
            << generateCode(fit, prescription, CodeLanguage::cPlusPlus, "lens");
        std::ofstream(folder + "/lens.cpp")
            << "#include \"lens.h\"\n"
               "extern \"C\" double throughput(const double* q) {\n"
               "    const double sensor[2] = {q[0], q[1]}, aperture[2] = {q[2], q[3]};\n"
               "    const auto ray = etendue_lenses::Lens<double>::trace(sensor, aperture, q[4]);\n"
               "    return ray ? ray->throughput : 0.0;\n}\n";
        const std::string library = folder + "/lens.so";
        const std::string compile = "c++ -std=c++17 -O3 -march=x86-64-v3 -shared -fPIC " + folder +
                                    "/lens.cpp -o " + library;
        void* const loaded =
            std::system(compile.c_str()) == 0 ? ::dlopen(library.c_str(), RTLD_NOW) : nullptr;
        std::filesystem::remove_all(folder);
        if (!loaded) throw std::runtime_error("generated code: cannot be compiled or loaded");
        throughput_ = reinterpret_cast<double (*)(const double*)>(::dlsym(loaded, "throughput"));
    }

    double throughput(const FitQuery& q) const {
        const double numbers[] = {q.sensor.mm.x(), q.sensor.mm.y(), q.aperture.mm.x(),
                                  q.aperture.mm.y(), q.wavelengthNm};
        return throughput_(numbers);
    }

private:
    double (*throughput_)(const double*) = nullptr;
};

/// How far float evaluation strays from double, rms in mrad of the pupil direction's components.
double floatErrorMrad(const SparsePolynomial& exit, const Inputs& inputs) {
    const PolynomialEvaluator<double> inDouble(exit);
    const PolynomialEvaluator<float> inFloat(exit);
    double squares = 0.0;
    for (const PolynomialInput& input : inputs) {
        const PolynomialValues<double> exact = inDouble.values(input);
        const PolynomialValues<float> rounded = inFloat.values(input);
        squares += std::pow(static_cast<double>(rounded[2]) - exact[2], 2.0) +
                   std::pow(static_cast<double>(rounded[3]) - exact[3], 2.0);
    }
    return 1e3 * std::sqrt(squares / static_cast<double>(inputs.size()));
}

void measureLens(const std::string& file) {
    const Prescription prescription = loadPrescription(file);
    fmt::print("\n{}\n", prescription.name);
    const FitDomain domain = fitDomain(prescription, {});
    const Aperture aperture(domain.apertureRadiusMm);
    const TracedLens exact(prescription, aperture, domain.sensorDistanceMm);
    const std::vector<Ray> rays = drawRays(exact, domain, 1024);
    Inputs inputs;
    std::vector<MonochromaticLens> monochromatic;
    for (const Ray& ray : rays) {
        inputs.push_back({ray.query.sensor.mm, ray.query.aperture.mm, ray.query.wavelengthNm});
        monochromatic.push_back(*exact.at(ray.query.wavelengthNm));
    }
    std::vector<Contestant> contestants;
    contestants.push_back({"exact, along a known slope", rays.size(), [&] {
                               for (std::size_t i = 0; i < rays.size(); ++i)
                                   sink = monochromatic[i].traceToScene(rays[i].state).ray.origin.x;
                           }});
    addLens(contestants, "exact", exact, rays);
    std::optional<PolynomialLens> polynomialLens;
    for (const int terms : {8, 16, 32, 40, 64}) {
        const LensFit fit =
            fitLens(prescription, domain, settingsFor(PolynomialBasis::axial, terms));
        fmt::print("axial {:<3} direction errs by {:.2e} mrad rms, float adds {:.2e}\n", terms,
                   fit.errors.directionMrad.rms, floatErrorMrad(fit.exit, inputs));
        const std::string name = fmt::format("axial {}", terms);
        addSingle<double>(contestants, name + " double", fit.exit, inputs);
        if (terms != 40) continue;
        addSingle<float>(contestants, name + " float", fit.exit, inputs);
        if (widestRegisters() != VectorRegisters::narrow)
            addBatch<float, 16>(contestants, name + " narrow float", fit.exit, inputs,
                                VectorRegisters::narrow);
        addBatch<float, 8>(contestants, name + " float", fit.exit, inputs);
        addBatch<float, 16>(contestants, name + " float", fit.exit, inputs);
        addBatch<double, 8>(contestants, name + " double", fit.exit, inputs);
        addBatch<double, 16>(contestants, name + " double", fit.exit, inputs);
        polynomialLens.emplace(prescription, fit, aperture);
        addLens(contestants, "polynomial 40", *polynomialLens, rays);
        contestants.push_back({"generated C++ 40 trace", rays.size(),
                               [&rays, generated = GeneratedLens(fit, prescription)] {
                                   for (const Ray& ray : rays)
                                       sink = generated.throughput(ray.query);
                               }});
    }
    const SparsePolynomial published =
        fitLens(prescription, domain, settingsFor(PolynomialBasis::cartesian, 40)).exit;
    addSingle<double>(contestants, "cartesian 40 double", published, inputs);
    addBatch<float, 16>(contestants, "cartesian 40 float", published, inputs);

    race(contestants);
    fmt::print("{:<32} {:>10} {:>10} {:>20}\n", "ns", "median", "fastest", "exact trace takes");
    const double reference = median(contestants.front().nanoseconds);
    for (const Contestant& contestant : contestants) {
        const double ns = median(contestant.nanoseconds);
        fmt::print("{:<32} {:>10.1f} {:>10.1f} {:>18.1f} x\n", contestant.name, ns,
                   std::ranges::min(contestant.nanoseconds), reference / ns);
    }
}

}  // namespace
}  // namespace etendue

int main(int count, char** arguments) {
    try {
        for (int i = 1; i < count; ++i) etendue::measureLens(arguments[i]);
    } catch (const std::exception& error) {
        fmt::print(stderr, "lens_bench: {}\n", error.what());
        return 1;
    }
}
