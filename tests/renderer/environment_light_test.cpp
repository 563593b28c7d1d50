#include <doctest/doctest.h>

#include "config/config.h"
#include "renderer/light.h"
#include "tests/renderer/light_fixtures.h"
#include "tests/support/chi_square_sphere.h"
#include "tests/support/estimate.h"

using namespace etendue;

namespace {

struct Grey {
    int width, height;
    std::vector<float> texels;

    std::unique_ptr<Light> light(const Transform& worldFromLight = {}, float scale = 1.0f) const {
        return makeEnvironmentLight(greyImage(width, height, texels), scale, worldFromLight,
                                    testBounds);
    }
    double texel(int x, int y) const {
        x = (x % width + width) % width;
        y = std::clamp(y, 0, height - 1);
        return double{texels[static_cast<std::size_t>(y * width + x)]};
    }
    /// The picture at `x` across and `y` down, in texels: the oracle for the light's radiance.
    double bilinear(double x, double y) const {
        const int left = static_cast<int>(std::floor(x - 0.5));
        const int top = static_cast<int>(std::floor(y - 0.5));
        double sum = 0.0;
        for (int i = left; i <= left + 1; ++i)
            for (int j = top; j <= top + 1; ++j)
                sum += texel(i, j) * (1.0 - std::abs(x - 0.5 - i)) * (1.0 - std::abs(y - 0.5 - j));
        return sum;
    }
};

/// Towards the point at `x` across and `y` down the image, both from 0 to 1.
Vec3d directionOf(double x, double y) {
    const double longitude = 2.0 * std::numbers::pi * (x - 0.5), theta = std::numbers::pi * y;
    return {-std::sin(theta) * std::sin(longitude), std::cos(theta),
            std::sin(theta) * std::cos(longitude)};
}

EmitterHit towards(Vec3d direction) { return {toFloat(direction), 1e30f, toFloat(-direction)}; }

/// Odd sizes, a hot pixel, a black half.
std::vector<Grey> images() {
    Grey hot{16, 9, std::vector<float>(16 * 9, 1e-3f)};
    hot.texels[3 * 16 + 15] = 1e6f;
    Grey half{6, 8, randomTexels(48, 3)};
    for (std::size_t i = 0; i < 24; ++i) half.texels[i] = 0.0f;
    return {{1, 1, {0.6f}},
            {2, 1, {0.0f, 1.0f}},
            {1, 2, {0.2f, 1.0f}},
            {7, 3, randomTexels(21, 1)},
            hot,
            half};
}

const Transform turned = Transform::rotate(normalize(Vec3d{0.3, -1.0, 0.8}), 77.0);

}  // namespace

TEST_CASE(
    "EnvironmentLight: the image stands upright and unmirrored around a viewer who looks at it") {
    // One bright texel each; the viewer looks along +z, his right hand at cross(forward, up).
    const Vec3d forward{0, 0, 1}, up{0, 1, 0}, right = cross(forward, up);
    const auto brightAt = [](int x, int y) {
        Grey grey{9, 5, std::vector<float>(45, 0.0f)};
        grey.texels[static_cast<std::size_t>(y * 9 + x)] = 1.0f;
        return grey;
    };
    const auto radiance = [](const Grey& grey, Vec3d direction) {
        return grey.light()->radiance(towards(normalize(direction)))[0];
    };
    CHECK(radiance(brightAt(4, 2), forward) == doctest::Approx(1.0f));
    CHECK(radiance(brightAt(5, 2), forward + right * 0.8) > 0.9f);
    CHECK(radiance(brightAt(5, 2), forward - right * 0.8) == 0.0f);
    CHECK(radiance(brightAt(3, 2), forward - right * 0.8) > 0.9f);
    CHECK(radiance(brightAt(4, 1), forward + up * 0.7) > 0.9f);
    CHECK(radiance(brightAt(4, 3), forward - up * 0.7) > 0.9f);
    // The edges meet behind.
    CHECK(radiance(brightAt(8, 2), -forward) == doctest::Approx(0.5f));
    CHECK(radiance(brightAt(0, 2), -forward) == doctest::Approx(0.5f));
    CHECK(radiance(brightAt(8, 2), right * 0.3 - forward) > 0.9f);
}

TEST_CASE("EnvironmentLight: radiance is bilinear, wraps around and is constant at the poles") {
    const Grey grey{7, 3, randomTexels(21, 5)};
    const auto plain = grey.light(), rotated = grey.light(turned, 2.0f);
    for (int i = 0; i <= 40; ++i)
        for (int j = 0; j <= 20; ++j) {
            const double x = i / 40.0, y = j / 20.0;
            const double expected = grey.bilinear(7.0 * x, 3.0 * y);
            // The direction is rounded by 1e-7, hence the longitude by that over sin θ, times seven
            // texels in 2π; at the poles themselves it is not defined.
            const double tolerance = j % 20 == 0 ? 1.0 : 1e-5;
            CHECK(std::abs(plain->radiance(towards(directionOf(x, y)))[0] - expected) < tolerance);
            const auto hit = towards(turned.vector(directionOf(x, y)));
            CHECK(std::abs(rotated->radiance(hit)[0] - 2.0 * expected) < 2.0 * tolerance);
        }
    const Grey constant{5, 4, std::vector<float>(20, 0.3f)};
    int differences = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        RandomStream random(6, i, 0, RandomDomain::test);
        const auto s = constant.light()->sample({}, random.next2());
        differences += !s || s->radiance != rgb(0.3f, 0.3f, 0.3f);
    }
    CHECK(differences == 0);  // exactly, for the furnaces to be exact
}

TEST_CASE("EnvironmentLight: a texel is drawn by the light that its interpolant sends through it") {
    for (const Grey& grey : images()) {
        CAPTURE(grey.width);
        CAPTURE(grey.height);
        const auto light = grey.light();
        // The density times the solid angle of each texel, and the radiance integrated over it by
        // the midpoint rule; both relative to the whole sphere.
        constexpr int n = 40;
        std::vector<double> mass, flux;
        double totalMass = 0.0, totalFlux = 0.0;
        for (int y = 0; y < grey.height; ++y)
            for (int x = 0; x < grey.width; ++x) {
                const auto theta = [&](double row) { return std::numbers::pi * row / grey.height; };
                const double longitude = 2.0 * std::numbers::pi / grey.width;
                const double solidAngle = longitude * (std::cos(theta(y)) - std::cos(theta(y + 1)));
                double sum = 0.0;
                for (int i = 0; i < n; ++i)
                    for (int j = 0; j < n; ++j) {
                        const double row = y + (j + 0.5) / n;
                        sum += grey.bilinear(x + (i + 0.5) / n, row) * std::sin(theta(row));
                    }
                flux.push_back(sum * theta(1.0) / n * longitude / n);
                totalFlux += flux.back();
                const auto middle = directionOf((x + 0.4) / grey.width, (y + 0.6) / grey.height);
                mass.push_back(light->pdfSolidAngle(towards(middle)) * solidAngle);
                totalMass += mass.back();
            }
        CHECK(totalMass == doctest::Approx(1.0).epsilon(1e-6));
        // The midpoint rule is off by (π / (height · 40))² / 24 at most, so by 3e-4 for one row.
        CHECK(relativeError(light->power(), totalFlux * std::numbers::pi * 4.0) < 5e-4);
        for (std::size_t i = 0; i < mass.size(); ++i)
            CHECK(relativeError(mass[i], flux[i] / totalFlux) < 5e-4);
    }
}

TEST_CASE("EnvironmentLight: directions follow the density, constant in a texel and one in all") {
    const auto greys = images();
    // From the image's left edge, behind, about the light's up.
    const Frame image{toFloat(turned.vector({0, 0, -1})), toFloat(turned.vector({-1, 0, 0})),
                      toFloat(turned.vector({0, 1, 0}))};
    for (const Grey& grey : greys) {
        CAPTURE(grey.width);
        CAPTURE(grey.height);
        const auto light = grey.light(turned);
        // Each texel cut in 3 × 3.
        const SphereGrid grid{3 * grey.height, 3 * grey.width, image};
        const auto check = [&](const auto& draw, const auto& density) {
            const DirectionTest result = testDirections(grid, 50'000, 7, draw, density);
            CHECK(result.chiSquare.countInEmptyCells == 0.0);
            CHECK(result.chiSquare.pValue > sidakLevel(falseAlarmLevel, 2 * greys.size()));
            CHECK(result.integral == doctest::Approx(1.0).epsilon(1e-6));
        };
        check(
            [&](RandomStream& random) -> std::optional<Vec3> {
                const auto s = light->sample({}, random.next2());
                if (!s) return {};
                return s->direction;
            },
            [&](Vec3 d) {
                return light->pdfSolidAngle({d, 1e30f, -d});
            });
        check(
            [&](RandomStream& random) -> std::optional<Vec3> {
                const auto ray = light->emit({0.3f, 0.4f}, random.next2());
                if (!ray) return {};
                return -ray->direction;
            },
            [&](Vec3 d) {
                return light->emissionPdf({d, 1e30f, -d}).pdfSolidAngle;
            });
    }
}

TEST_CASE("EnvironmentLight: directions, on a fine grid and with more samples" *
          doctest::test_suite("statistical")) {
    const auto light = Grey{7, 3, randomTexels(21, 11)}.light(turned);
    const auto check = [&](const SphereGrid& grid, std::uint32_t count) {
        const DirectionTest result = testDirections(
            grid, count, 12,
            [&](RandomStream& random) -> std::optional<Vec3> {
                return light->sample({}, random.next2())->direction;
            },
            [&](Vec3 d) {
                return light->pdfSolidAngle({d, 1e30f, -d});
            });
        CHECK(result.chiSquare.pValue > sidakLevel(falseAlarmLevel, 2));
        // The density jumps at the texels' borders, where cells are cut to 1/256 of their width.
        CHECK(result.integral == doctest::Approx(1.0).epsilon(0.5 / 256 / 10));
    };
    check({50, 101, {}}, 1'000'000);
    check({16, 16, {}}, 10'000'000);
}

TEST_CASE("EnvironmentLight: the density is positive wherever there is light") {
    for (const Grey& grey : images()) {
        CAPTURE(grey.width);
        CAPTURE(grey.height);
        const auto light = grey.light(turned);
        int invisible = 0;
        for (std::uint32_t i = 0; i < 5000; ++i) {
            RandomStream random(8, i, 0, RandomDomain::test);
            const EmitterHit hit = towards(directionOf(random.next(), random.next()));
            invisible += light->pdfSolidAngle(hit) == 0.0f && light->radiance(hit)[0] > 0.0f;
        }
        CHECK(invisible == 0);
    }
}

TEST_CASE("EnvironmentLight: irradiance by sampling is that of quadrature") {
    const Vec3 normal = normalize(Vec3{0.5f, 0.4f, -0.3f});
    const auto greys = images();
    for (const Grey& grey : greys) {
        CAPTURE(grey.width);
        CAPTURE(grey.height);
        const auto light = grey.light();
        double expected = 0.0;
        constexpr int rows = 300, columns = 600;
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < columns; ++j) {
                const double x = (j + 0.5) / columns, y = (i + 0.5) / rows;
                expected += grey.bilinear(x * grey.width, y * grey.height) *
                            std::max(0.0, dot(directionOf(x, y), toDouble(normal))) *
                            std::sin(std::numbers::pi * y);
            }
        expected *= 2.0 * std::numbers::pi * std::numbers::pi / (double{rows} * columns);
        const Summary result = estimate(50'000, 9, [&](RandomStream& random) {
            return irradianceOf(light->sample({}, random.next2()), normal);
        });
        // The midpoint rule errs by (π / 300)² / 24 and, where the hot texel's tent has creases, by
        // 1/12 of the square of a texel's 33 points.
        CHECK(meanPValue(result, expected, 1e-4) > sidakLevel(falseAlarmLevel, greys.size()));
        CHECK(result.standardError < 0.02 * expected);
    }
}

TEST_CASE("EnvironmentLight: black has no power and no samples, negative light is refused") {
    const Grey black{4, 2, std::vector<float>(8, 0.0f)};
    CHECK(black.light()->power() == 0.0f);
    CHECK_FALSE(black.light()->sample({}, {0.5f, 0.5f}));
    CHECK_FALSE(black.light()->emit({0.5f, 0.5f}, {0.5f, 0.5f}));
    CHECK(black.light()->pdfSolidAngle(towards({0, 0, 1})) == 0.0f);
    Grey negative = black;
    negative.texels[6] = -1e-3f;
    CHECK_THROWS_WITH_AS(negative.light(), doctest::Contains("texel (2, 1)"), InputError);
    negative.texels[6] = 1e38f;
    CHECK_THROWS_AS(negative.light({}, 100.0f), InputError);
}

TEST_CASE("EnvironmentLight: looking straight at a pole is finite") {
    const Grey grey{7, 3, randomTexels(21, 10)};
    const auto light = grey.light();
    for (const Vec3d d : {Vec3d{0, 1, 0}, {0, -1, 0}, {1e-30, 1, 0}, {0, 0, -1}, {-0.0, 0, -1}}) {
        CHECK(isFinite(light->radiance(towards(d))));
        CHECK(light->pdfSolidAngle(towards(d)) > 0.0f);
        CHECK(light->pdfSolidAngle(towards(d)) < 1.0f);
    }
}

TEST_CASE("EnvironmentLight: a direction rounded over the border of the light has no sample") {
    // The random number 0 draws the very corner of the texels that the bright one reaches.
    Grey grey{9, 7, std::vector<float>(63, 0.0f)};
    grey.texels[3 * 9 + 4] = 1.0f;
    int found = 0, withoutDensity = 0;
    for (int degrees = 0; degrees < 360; ++degrees) {
        const auto light =
            grey.light(Transform::rotate(normalize(Vec3d{0.3, -1.0, 0.8}), degrees + 0.5));
        for (const Vec2 u : {Vec2{0, 0}, {0, 0.5f}, {0.5f, 0}}) {
            const auto s = light->sample({}, u);
            found += s.has_value();
            withoutDensity += s && s->pdfSolidAngle == 0.0f;
            const auto ray = light->emit({0.5f, 0.5f}, u);
            withoutDensity += ray && ray->pdf.pdfSolidAngle == 0.0f;
        }
    }
    CHECK(withoutDensity == 0);
    // Rounding takes either side.
    CHECK(found > 0);
    CHECK(found < 3 * 360);
}
