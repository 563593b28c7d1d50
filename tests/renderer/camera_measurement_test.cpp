// The measurement of equation (1), taken from the camera's side and from the scene's: the same
// integral before and after the change of variables.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lens/fit_domain.h"
#include "lens/polynomial_lens.h"
#include "renderer/camera.h"
#include "renderer/random.h"
#include "statistics/statistics.h"
#include "tests/renderer/camera_fixtures.h"

namespace etendue {
namespace {

const Wavelengths green;
constexpr int filmWidth = 48, filmHeight = 32;
constexpr std::uint64_t seeds = 16;

/// A tilted rectangle; surface coordinates ξ, η in [−1, 1].
struct Patch {
    Vec3d center, x, y;  // from the centre to the middle of two sides
    double area() const { return 4.0 * length(cross(x, y)); }
    Vec3d normal() const { return normalize(cross(x, y)); }
    Vec3d point(Vec2T<double> p) const { return center + x * p.x + y * p.y; }
    /// Surface coordinates of where the ray meets the patch.
    std::optional<Vec2T<double>> meets(const CameraRay& ray) const {
        const Vec3d origin = toDouble(ray.origin), direction = toDouble(ray.direction);
        const double t = dot(center - origin, normal()) / dot(direction, normal());
        const Vec3d offset = origin + direction * t - center;
        const Vec2T<double> p{dot(offset, x) / lengthSquared(x), dot(offset, y) / lengthSquared(y)};
        if (t <= 0.0 || std::abs(p.x) > 1.0 || std::abs(p.y) > 1.0) return {};
        return p;
    }
};

/// In front of a camera with this transform, 2 m away, tilted by 45°; wider than any view here.
Patch tiltedPatch(const Transform& worldFromLens, double scale = 1.0) {
    return {worldFromLens.point({0.3 * scale, 0.0, 2.0 + 0.3 * scale}),
            worldFromLens.vector({1.1 * scale, 0.0, 1.1 * scale}),
            worldFromLens.vector({0.0, 1.6 * scale, 0.0})};
}

struct NamedLens {
    std::string name;
    LensPointer lens;
};

std::vector<NamedLens> lenses() {
    const LensPointer near = makeThinLens(50.0, 1000.0, 18.0);
    return {{"pinhole", makePinhole(50.0)},
            {"thin lens at 1 m, f/1.4", near},
            {"thin lens at infinity", makeThinLens(50.0, focusAtInfinity, 18.0)},
            {"thin lens at 10 m, rays from 60 mm further out",
             std::make_shared<ForwardedLens>(makeThinLens(50.0, 1e4, 9.0), 60.0)}};
}

/// A lens from a patent, focused at 3 m, by its exact trace or by polynomials.
LensPointer lensOfGlass(const char* file, double sensorWidthMm, std::optional<FitForm> form) {
    const Prescription prescription = loadPrescription(
        std::filesystem::path(__FILE__).parent_path() / "../../scenes/lenses" / file);
    constexpr double focusMm = 3000.0;
    if (!form) return makeTracedLens(prescription, {{}, {}, focusMm});
    FitSettings settings;
    settings.form = *form;
    settings.terms = 24;
    settings.degree = 9;
    if (isAnamorphic(prescription)) settings.basis = PolynomialBasis::twoPlane;
    const FitDomain domain =
        fitDomain(prescription, {{sensorWidthMm, sensorWidthMm * filmHeight / filmWidth}, focusMm});
    return std::make_shared<PolynomialLens>(prescription, fitLens(prescription, domain, settings),
                                            Aperture(domain.apertureRadiusMm));
}

/// Evenly spread over the unit square: a lattice of steps by the plastic number (Roberts 2018),
/// shifted at random, so that each point alone is uniform and each seed independent.
class ShiftedLattice {
public:
    explicit ShiftedLattice(Vec2 shift) : x_(shift.x), y_(shift.y) {}
    Vec2T<double> next() {
        constexpr double plastic = 1.32471795724474602596;
        x_ += 1.0 / plastic;
        y_ += 1.0 / (plastic * plastic);
        return {x_ -= std::floor(x_), y_ -= std::floor(y_)};
    }

private:
    double x_, y_;
};

/// A radiance that vanishes at the patch's edges and has no symmetry.
double pattern(Vec2T<double> p) {
    const double windowX = 1.0 - p.x * p.x, windowY = 1.0 - p.y * p.y;
    return windowX * windowX * windowY * windowY * (1.0 + 0.6 * p.x - 0.3 * p.y);
}

Vec2 toFilm(Vec2T<double> u) {
    return {static_cast<float>(u.x * filmWidth), static_cast<float>(u.y * filmHeight)};
}
Vec2T<double> toPatch(Vec2T<double> u) { return {2.0 * u.x - 1.0, 2.0 * u.y - 1.0}; }

bool isOnFilm(Vec2 film) {
    return film.x >= 0.0f && film.x < filmWidth && film.y >= 0.0f && film.y < filmHeight;
}

/// The film's sum of pixel values, one estimate from each side.
double filmSide(const Camera& camera, const Patch& patch, RandomStream& random, int count) {
    ShiftedLattice lattice(random.next2());
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        const Vec2 film = toFilm(lattice.next());
        const auto ray = camera.sampleRay(film, random.next2(), green);
        if (!ray) continue;
        if (const auto hit = patch.meets(*ray)) sum += ray->weight * pattern(*hit);
    }
    return sum * filmWidth * filmHeight / count;
}

double sceneSide(const Camera& camera, const Patch& patch, RandomStream& random, int count) {
    const Vec3 normal = toFloat(patch.normal());
    ShiftedLattice lattice(random.next2());
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
        const Vec2T<double> p = toPatch(lattice.next());
        const auto connection = camera.connect(toFloat(patch.point(p)), random.next2(), green);
        if (!connection || !isOnFilm(connection->film)) continue;
        sum += importance(connection->ray, connection->distance, normal) * pattern(p);
    }
    return sum * patch.area() / count;
}

/// Both sides agree: by Welch's t at a level of one in a thousand for `tests` of them together, and
/// sharply enough to see an error of one in a hundred.
void checkBothSides(const Camera& camera, const Patch& patch, int count, std::size_t tests) {
    std::vector<double> film, scene;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        RandomStream a(seed, 0, 0, RandomDomain::test), b(seed, 1, 0, RandomDomain::test);
        film.push_back(filmSide(camera, patch, a, count));
        scene.push_back(sceneSide(camera, patch, b, count));
    }
    const WelchResult welch = welchTest(film, scene);
    CHECK(welch.pValue > sidakLevel(1e-3, tests));
    CHECK(welch.standardError < 0.002 * summarize(film).mean);
}

TEST_CASE("Measurement: a tilted, patterned surface sums to the same from film and from scene") {
    for (const NamedLens& named : lenses()) {
        CAPTURE(named.name);
        const Camera camera(named.lens, settingsFor(filmWidth, filmHeight, somewhere()));
        checkBothSides(camera, tiltedPatch(somewhere()), 10000, lenses().size());
    }
}

TEST_CASE("Measurement: …and so it does through lenses of glass, exactly traced and fitted" *
          doctest::test_suite("statistical")) {
    struct Case {
        const char* file;
        std::optional<FitForm> form;  // none: traced
        double sensorWidthMm, patchScale;
        int count;
    };
    const Case cases[] = {
        {"double-gauss-100mm.toml", {}, 36.0, 0.25, 7500},
        {"double-gauss-100mm.toml", FitForm::twoPoint, 36.0, 0.25, 20000},
        {"double-gauss-100mm.toml", FitForm::sensorState, 36.0, 0.25, 20000},
        {"fisheye-10mm.toml", FitForm::twoPoint, 22.0, 1.0, 70000},
        {"fisheye-220-6mm-f2.8.toml", FitForm::twoPoint, 18.0, 1.0, 20000},
        {"anamorphic-80x90mm.toml", FitForm::twoPoint, 22.0, 0.2, 450000},
    };
    for (const Case& c : cases) {
        CAPTURE(std::string(c.file));
        CameraSettings settings = settingsFor(filmWidth, filmHeight, somewhere());
        settings.sensorWidthMm = c.sensorWidthMm;
        const Camera camera(lensOfGlass(c.file, c.sensorWidthMm, c.form), settings);
        checkBothSides(camera, tiltedPatch(somewhere(), c.patchScale), c.count, std::size(cases));
    }
}

/// Means per tile of the film, for a surface of radiance one that fills the view.
using Tiles = std::vector<double>;
constexpr int tileSize = 8, tilesAcross = filmWidth / tileSize, tilesDown = filmHeight / tileSize;

void addToTile(Tiles& tiles, Vec2 film, double value) {
    const int x = static_cast<int>(film.x) / tileSize, y = static_cast<int>(film.y) / tileSize;
    tiles[static_cast<std::size_t>(y * tilesAcross + x)] += value / (tileSize * tileSize);
}

Tiles pathTraced(const Camera& camera, RandomStream& random, int count) {
    Tiles tiles(tilesAcross * tilesDown, 0.0);
    ShiftedLattice lattice(random.next2());
    for (int i = 0; i < count; ++i) {
        const Vec2 film = toFilm(lattice.next());
        const auto ray = camera.sampleRay(film, random.next2(), green);
        if (ray && isOnFilm(film))
            addToTile(tiles, film, 1.0 * ray->weight * filmWidth * filmHeight / count);
    }
    return tiles;
}

Tiles lightTraced(const Camera& camera, const Patch& patch, RandomStream& random, int count) {
    Tiles tiles(tilesAcross * tilesDown, 0.0);
    const Vec3 normal = toFloat(patch.normal());
    ShiftedLattice lattice(random.next2());
    for (int i = 0; i < count; ++i) {
        const Vec3 point = toFloat(patch.point(toPatch(lattice.next())));
        const auto connection = camera.connect(point, random.next2(), green);
        if (!connection || !isOnFilm(connection->film)) continue;
        const double value = importance(connection->ray, connection->distance, normal);
        addToTile(tiles, connection->film, value * patch.area() / count);
    }
    return tiles;
}

TEST_CASE("Measurement: light tracing sees a tilted surface of constant radiance as even") {
    constexpr int count = 40000;
    constexpr std::size_t tileCount = tilesAcross * tilesDown;
    for (const NamedLens& named : lenses()) {
        CAPTURE(named.name);
        const Camera camera(named.lens, settingsFor(filmWidth, filmHeight, somewhere()));
        const Patch patch = tiltedPatch(somewhere());
        std::vector<std::vector<double>> path(tileCount), light(tileCount);
        std::vector<double> pathMean, lightMean;
        for (std::uint64_t seed = 0; seed < seeds; ++seed) {
            RandomStream a(seed, 2, 0, RandomDomain::test), b(seed, 3, 0, RandomDomain::test);
            const Tiles p = pathTraced(camera, a, count), l = lightTraced(camera, patch, b, count);
            for (std::size_t t = 0; t < tileCount; ++t) {
                path[t].push_back(p[t]);
                light[t].push_back(l[t]);
            }
            pathMean.push_back(summarize(p).mean);
            lightMean.push_back(summarize(l).mean);
        }
        for (std::size_t t = 0; t < tileCount; ++t)
            CHECK(welchTest(path[t], light[t]).pValue >
                  sidakLevel(1e-3, tileCount * lenses().size()));
        // And no bias hides in the noise: the difference stays within 0.5 %, four standard errors
        // included.
        const WelchResult welch = welchTest(pathMean, lightMean);
        CHECK(std::abs(welch.difference) + 4.0 * welch.standardError <
              0.005 * summarize(pathMean).mean);
    }
}

}  // namespace
}  // namespace etendue
