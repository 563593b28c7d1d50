// Lights to test with, and what is known about light in closed form.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "renderer/light.h"
#include "renderer/random.h"

namespace etendue {

inline constexpr BoundingSphere testBounds{{0.3f, -0.2f, 0.1f}, 2.0f};

/// A grid of columns × rows parallelograms, two triangles each; the front is along x × y.
inline std::vector<EmissiveTriangle> rectangle(Vec3 corner, Vec3 x, Vec3 y, int columns = 1,
                                               int rows = 1) {
    std::vector<EmissiveTriangle> triangles;
    const auto at = [&](int i, int j) {
        return toFloat(toDouble(corner) + toDouble(x) * (static_cast<double>(i) / columns) +
                       toDouble(y) * (static_cast<double>(j) / rows));
    };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return triangles;
}

/// The six faces of a box, fronts inward.
inline std::vector<EmissiveTriangle> boxFromInside(Vec3 low, Vec3 high) {
    const Vec3 size = high - low;
    const Vec3 x{size.x, 0, 0}, y{0, size.y, 0}, z{0, 0, size.z};
    std::vector<EmissiveTriangle> triangles;
    for (const auto& face :
         {rectangle(low, x, y), rectangle(low + z, y, x), rectangle(low, y, z),
          rectangle(low + x, z, y), rectangle(low, z, x), rectangle(low + y, x, z)})
        triangles.insert(triangles.end(), face.begin(), face.end());
    return triangles;
}

/// Irradiance at `receiver` with unit `normal` from a polygon of uniform radiance, whole above the
/// receiver's horizon and counter-clockwise as the receiver sees it from its front (Lambert 1760;
/// see Arvo 1994, "The Irradiance Jacobian for Partially Occluded Polyhedral Sources", equation 3).
inline double polygonIrradiance(const std::vector<Vec3>& corners, double radiance, Vec3 receiver,
                                Vec3 normal) {
    double sum = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3d a = normalize(toDouble(corners[i]) - toDouble(receiver));
        const Vec3d b = normalize(toDouble(corners[(i + 1) % corners.size()]) - toDouble(receiver));
        const Vec3d across = cross(a, b);
        const double angle = std::atan2(length(across), dot(a, b));
        sum += angle * dot(normalize(across), toDouble(normal));
    }
    return 0.5 * radiance * std::abs(sum);
}

/// Grey texels, row by row from the top.
inline std::shared_ptr<const Texture> greyImage(int width, int height,
                                                const std::vector<float>& texels) {
    Image image;
    image.width = width;
    image.height = height;
    image.channels = 3;
    std::vector<float> pixels;
    for (const float t : texels) pixels.insert(pixels.end(), {t, t, t});
    image.pixels = pixels;
    return std::make_shared<const Texture>(image, ColorEncoding::linear, TextureWrap::clamp);
}

inline std::vector<float> randomTexels(int count, std::uint64_t seed) {
    RandomStream random(seed, 0, 0, RandomDomain::test);
    std::vector<float> texels;
    for (int i = 0; i < count; ++i) texels.push_back(random.next());
    return texels;
}

/// What a sampled light adds to the irradiance of a surface with that normal; 0 for no sample.
inline double irradianceOf(const std::optional<LightSample>& sample, Vec3 normal) {
    if (!sample) return 0.0;
    return sample->radiance[0] * std::max(0.0f, dot(sample->direction, normal)) /
           double{sample->pdfSolidAngle};
}

/// Flux that an emitted ray carries, W; 0 for no ray.
inline double fluxOf(const std::optional<EmittedRay>& ray) {
    if (!ray) return 0.0;
    return double{ray->radiance[0]} * ray->cosTheta /
           (double{ray->pdf.pdfArea} * ray->pdf.pdfSolidAngle);
}

struct NamedLight {
    std::string name;
    std::unique_ptr<Light> light;
};

/// Each kind of light, and the difficult ones of its kind. All are grey, in or around `testBounds`.
inline std::vector<NamedLight> everyLight() {
    const Transform turned = Transform::rotate(normalize(Vec3d{1.0, 2.0, -0.5}), 50.0);
    const Vec3 slanted = normalize(Vec3{1, -3, 0.5f});
    std::vector<float> hotTexels(32 * 16, 0.02f), halfBlack = randomTexels(8 * 5, 12);
    hotTexels[5 * 32 + 9] = 1e5f;
    for (std::size_t i = 0; i < halfBlack.size(); ++i)
        if (i % 8 < 4) halfBlack[i] = 0.0f;
    std::vector<EmissiveTriangle> scattered;
    RandomStream random(13, 0, 0, RandomDomain::test);
    const auto point = [&] { return Vec3{random.next(), 1.0f + random.next(), random.next()}; };
    for (int i = 0; i < 9; ++i) scattered.push_back({point(), point(), point()});

    std::vector<NamedLight> lights;
    const auto add = [&](const char* name, std::unique_ptr<Light> light) {
        lights.push_back({name, std::move(light)});
    };
    const auto panel = rectangle({-0.5f, 1.0f, -0.4f}, {1, 0, 0}, {0, 0.2f, 0.8f});
    add("rectangle", makeAreaLight(panel, Spectrum(3.0f), false));
    add("two-sided rectangle", makeAreaLight(panel, Spectrum(3.0f), true));
    add("scattered triangles", makeAreaLight(scattered, Spectrum(2.0f), false));
    add("small bright triangle",
        makeAreaLight({{{0.1f, 1.0f, 0.0f}, {0.100001f, 1.0f, 0.0f}, {0.1f, 1.0f, 1e-6f}}},
                      Spectrum(1e7f), true));
    add("constant", makeConstantLight(Spectrum(0.7f), testBounds));
    add("random environment",
        makeEnvironmentLight(greyImage(7, 3, randomTexels(21, 11)), 2.5f, turned, testBounds));
    add("environment with a sun",
        makeEnvironmentLight(greyImage(32, 16, hotTexels), 1.0f, turned, testBounds));
    add("half black environment",
        makeEnvironmentLight(greyImage(8, 5, halfBlack), 1.0f, {}, testBounds));
    add("point", makePointLight({0.2f, 1.0f, 0.3f}, Spectrum(5.0f)));
    add("spot", makeSpotLight({0.2f, 1.0f, 0.3f}, slanted, Spectrum(5.0f), 20.0f, 40.0f));
    add("narrow spot", makeSpotLight({0.2f, 1.0f, 0.3f}, slanted, Spectrum(5.0f), 0.0f, 0.5f));
    add("directional", makeDirectionalLight(slanted, Spectrum(4.0f), testBounds));
    return lights;
}

}  // namespace etendue
