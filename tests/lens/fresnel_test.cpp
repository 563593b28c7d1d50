#include "lens/fresnel.h"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>

namespace etendue {
namespace {

Refraction refracted(double from, double to, double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const double sine = from / to * std::sin(angle);
    return {from, to, std::cos(angle), std::sqrt(1.0 - sine * sine)};
}

double square(double x) { return x * x; }

/// A film by Abelès' matrices, which know nothing of sums over reflections.
double filmByMatrices(double from, double film, double to, double degrees, double waves) {
    const Refraction whole = refracted(from, to, degrees);
    const double cosFilm = refracted(from, film, degrees).cosTo;
    const double phase = 2.0 * std::numbers::pi * waves * cosFilm;
    double sum = 0.0;
    for (const bool isParallel : {false, true}) {
        const auto admittance = [&](double n, double cosine) {
            return isParallel ? n / cosine : n * cosine;
        };
        const double a = admittance(from, whole.cosFrom), f = admittance(film, cosFilm),
                     b = admittance(to, whole.cosTo);
        const std::complex<double> i(0.0, 1.0);
        const std::complex<double> electric = std::cos(phase) + i * std::sin(phase) / f * b;
        const std::complex<double> magnetic = i * f * std::sin(phase) + std::cos(phase) * b;
        sum += std::norm((a * electric - magnetic) / (a * electric + magnetic));
    }
    return 0.5 * sum;
}

TEST_CASE("Fresnel: at normal incidence ((n − 1)/(n + 1))² is reflected, from either side") {
    for (const double n : {1.0003, 1.5, 1.9, 4.0}) {
        const double expected = square((n - 1.0) / (n + 1.0));
        CHECK(reflectance(refracted(1.0, n, 0.0)) == doctest::Approx(expected).epsilon(1e-13));
        CHECK(reflectance(refracted(n, 1.0, 0.0)) == doctest::Approx(expected).epsilon(1e-13));
    }
}

TEST_CASE("Fresnel: at Brewster's angle only the perpendicular half is reflected") {
    for (const double n : {1.3, 1.5, 2.0}) {
        const double brewster = std::atan(n) * 180.0 / std::numbers::pi;
        // There rs = (1 − n²)/(1 + n²).
        const double expected = 0.5 * square((1.0 - n * n) / (1.0 + n * n));
        CHECK(reflectance(refracted(1.0, n, brewster)) == doctest::Approx(expected).epsilon(1e-13));
    }
}

TEST_CASE("Fresnel: light reversed is reflected alike, coated or not") {
    const Coating coating{1.38, 550.0, 0.25};
    for (const double degrees : {0.0, 20.0, 45.0, 70.0, 89.0}) {
        const Refraction into = refracted(1.0, 1.7, degrees);
        const Refraction back{into.indexTo, into.indexFrom, into.cosTo, into.cosFrom};
        CHECK(reflectance(into) == doctest::Approx(reflectance(back)).epsilon(1e-13));
        CHECK(reflectance(into, coating, 480.0) ==
              doctest::Approx(reflectance(back, coating, 480.0)).epsilon(1e-12));
    }
}

TEST_CASE("Fresnel: a quarter-wave film reflects ((n₀ nₛ − n₁²)/(n₀ nₛ + n₁²))²") {
    for (const double glass : {1.5, 1.7, 1.9})
        for (const double film : {1.38, 1.46, 2.1}) {
            const double expected = square((glass - film * film) / (glass + film * film));
            const double found =
                reflectance(refracted(1.0, glass, 0.0), Coating{film, 550.0, 0.25}, 550.0);
            CHECK(found == doctest::Approx(expected).epsilon(1e-12));
        }
}

TEST_CASE("Fresnel: a film of no thickness, of half a wave or of the glass itself is no film") {
    const Refraction refraction = refracted(1.0, 1.6, 0.0);
    const double bare = reflectance(refraction);
    CHECK(reflectance(refraction, {1.38, 550.0, 0.0}, 550.0) == doctest::Approx(bare));
    CHECK(reflectance(refraction, {1.38, 550.0, 0.5}, 550.0) == doctest::Approx(bare));
    for (const double degrees : {0.0, 30.0, 80.0})
        CHECK(reflectance(refracted(1.0, 1.6, degrees), {1.6, 550.0, 0.25}, 480.0) ==
              doctest::Approx(reflectance(refracted(1.0, 1.6, degrees))).epsilon(1e-12));
}

TEST_CASE("Fresnel: films at any angle and wavelength agree with Abelès' matrices") {
    for (const double degrees : {0.0, 17.0, 40.0, 63.0, 85.0})
        for (const double wavelength : {350.0, 550.0, 811.0})
            for (const double film : {1.38, 2.05}) {
                const Coating coating{film, 520.0, 0.3};
                const double expected =
                    filmByMatrices(1.0, film, 1.62, degrees, 0.3 * 520.0 / wavelength);
                CHECK(reflectance(refracted(1.0, 1.62, degrees), coating, wavelength) ==
                      doctest::Approx(expected).epsilon(1e-12));
            }
}

TEST_CASE("Fresnel: magnesium fluoride on glass reflects less than bare glass at its wavelength") {
    for (const double n : {1.45, 1.6, 1.9})
        for (const double degrees : {0.0, 20.0, 40.0})
            CHECK(reflectance(refracted(1.0, n, degrees), Coating{}, 550.0) <
                  reflectance(refracted(1.0, n, degrees)));
}

}  // namespace
}  // namespace etendue
