#include <doctest/doctest.h>

#include "renderer/frame.h"
#include "renderer/light.h"
#include "tests/renderer/light_fixtures.h"
#include "tests/support/estimate.h"

using namespace etendue;

namespace {

const Vec3 position{0.5f, -0.25f, 0.125f};
const Vec3 axis = normalize(Vec3{0.3f, -0.7f, 0.2f});

/// At a distance of 2 and `degrees` from the axis.
Vec3 receiverAt(double degrees) {
    const Frame frame = Frame::fromZ(axis);
    const double angle = degrees * std::numbers::pi / 180.0;
    const Vec3d direction =
        toDouble(frame.z) * std::cos(angle) + toDouble(frame.y) * std::sin(angle);
    return toFloat(toDouble(position) + direction * 2.0);
}

}  // namespace

TEST_CASE("SpotLight: constant inside, falling smoothly to nothing outside") {
    const auto light = makeSpotLight(position, axis, Spectrum(8.0f), 20.0f, 40.0f);
    const auto irradiance = [&](double degrees) {
        const auto s = light->sample(receiverAt(degrees), {});
        return s ? s->radiance[0] : 0.0f;
    };
    CHECK(irradiance(0) == doctest::Approx(2.0f));
    CHECK(irradiance(19.9) == doctest::Approx(2.0f));
    CHECK_FALSE(light->sample(receiverAt(40.1), {}));
    CHECK_FALSE(light->sample(receiverAt(180), {}));
    CHECK_FALSE(light->sample(position, {}));
    float previous = 2.1f;
    for (double degrees = 20; degrees < 40; degrees += 0.5) {
        const float here = irradiance(degrees);
        CHECK(here > 0.0f);
        CHECK(here < previous);
        CHECK(previous - here < 0.25f);  // 0.5° of 20°, 2 W/m², slope up to 3/2 · sin 40° / mean
        previous = here;
    }
    // Halfway in the cosine, by the symmetry of the smoothstep.
    const double halfway =
        std::acos(0.5 * (std::cos(std::numbers::pi / 9.0) + std::cos(std::numbers::pi / 4.5))) *
        180.0 / std::numbers::pi;
    CHECK(irradiance(halfway) == doctest::Approx(1.0f).epsilon(1e-5));
}

TEST_CASE("SpotLight: directions are uniform in the cone, from wide to a hundredth of a degree") {
    const float outerDegrees[] = {180.0f, 90.0f, 30.0f, 1.0f, 0.01f};
    for (const float outer : outerDegrees) {
        CAPTURE(outer);
        const auto light = makeSpotLight(position, axis, Spectrum(1.0f), outer, outer);
        constexpr int rings = 16, sectors = 15, count = 50'000;
        std::vector<double> observed(rings * sectors);
        int missing = 0;
        const double outerAngle = double{outer} * std::numbers::pi / 180.0;
        const double sinHalf = std::sin(0.5 * outerAngle);
        const Frame frame = Frame::fromZ(axis);
        for (std::uint32_t i = 0; i < count; ++i) {
            RandomStream random(1, i, 0, RandomDomain::test);
            const auto ray = light->emit({}, random.next2());
            if (!ray) {
                ++missing;
                continue;
            }
            // Rings of equal solid angle: sin²(θ/2), from the chord, since the cosine rounds to 1.
            const double halfChord =
                0.5 * length(toDouble(ray->direction) - toDouble(axis)) / sinHalf;
            const Vec3 local = frame.localFromWorld(ray->direction);
            const double turn =
                std::atan2(double{local.y}, double{local.x}) / (2 * std::numbers::pi);
            const int ring = std::min(static_cast<int>(halfChord * halfChord * rings), rings - 1);
            const int sector = std::min(static_cast<int>((turn + 0.5) * sectors), sectors - 1);
            ++observed[static_cast<std::size_t>(ring * sectors + sector)];
        }
        // Rounding to 6e-8 carries directions over the rim: of a cone of 1.7e-4, 1e-3 of them.
        CHECK(missing < 2 * 6e-8 / outerAngle * count + 1);
        const std::vector<double> expected(observed.size(),
                                           (count - missing) / double{rings * sectors});
        CHECK(chiSquareTest(observed, expected).pValue >
              sidakLevel(falseAlarmLevel, std::size(outerDegrees)));
        // The density is the inverse of the cone's solid angle, and nothing outside.
        const float pdf = light->emissionPdf({-axis, 1.0f, axis}).pdfSolidAngle;
        const double solidAngle = 4.0 * std::numbers::pi * sinHalf * sinHalf;
        CHECK(pdf * solidAngle == doctest::Approx(1.0).epsilon(1e-6));
        if (outer < 180.0f) CHECK(light->emissionPdf({axis, 1.0f, -axis}).pdfSolidAngle == 0.0f);
    }
}

TEST_CASE("SpotLight: the power is the intensity's integral") {
    for (const auto& cone : {std::pair{0.0f, 0.01f}, {20.0f, 40.0f}, {60.0f, 60.0f}}) {
        const float inner = cone.first, outer = cone.second;
        CAPTURE(outer);
        const auto light = makeSpotLight(position, axis, Spectrum(3.0f), inner, outer);
        // ∫ I(θ) 2π sin θ dθ by the midpoint rule, the intensity being the irradiance at a distance
        // of 1 in double; the falloff written down anew.
        const auto radians = [](double degrees) { return degrees * std::numbers::pi / 180.0; };
        const auto versine = [&](double degrees) {
            return 2.0 * std::pow(std::sin(0.5 * radians(degrees)), 2.0);
        };
        constexpr int steps = 20'000;
        double integral = 0.0;
        for (int i = 0; i < steps; ++i) {
            const double degrees = double{outer} * (i + 0.5) / steps;
            const double rim = versine(double{outer}) - versine(double{inner});
            const double t =
                degrees <= double{inner} ? 1.0 : (versine(double{outer}) - versine(degrees)) / rim;
            integral +=
                3.0 * t * t * (3.0 - 2.0 * t) * 2.0 * std::numbers::pi * std::sin(radians(degrees));
        }
        integral *= radians(double{outer}) / steps;
        CHECK(relativeError(light->power(), integral) < 1e-6);
    }
}
