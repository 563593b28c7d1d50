// [[light]]: sources that are not surfaces.
#include <cmath>

#include "renderer/scene_parts.h"

namespace etendue {

namespace {

Vec3 unitVector(const ConfigTable& table, std::string_view key) {
    const Vec3d v = vector3(table, key);
    if (!(lengthSquared(v) > 0.0)) table.fail(key, "must not be zero");
    return toFloat(normalize(v));
}

using MakeLight = std::function<std::unique_ptr<Light>(BoundingSphere)>;

MakeLight environmentFrom(const ConfigTable& table, LoadingScene& loading) {
    const auto image = loadTexture(table, "image", TextureUse::radiance, loading);
    const auto scale = static_cast<float>(table.number("scale", Range::nonNegative(), 1.0));
    const Transform rotation = loadTransform(table, "rotation");
    const bool isRotation =
        std::abs(length(rotation.x) - 1.0) + std::abs(length(rotation.y) - 1.0) +
            std::abs(dot(rotation.x, rotation.y)) + length(rotation.translation) +
            std::abs(rotation.determinant() - 1.0) <
        1e-6;
    if (!isRotation) table.fail("rotation", "only {rotate = […]} steps can turn an environment");
    return [=](BoundingSphere scene) {
        try {
            return makeEnvironmentLight(image, scale, rotation, scene);
        } catch (const InputError& error) {
            table.fail("image", error.what());
        }
    };
}

MakeLight spotFrom(const ConfigTable& table) {
    const Vec3 position = toFloat(place(table, "position"));
    const Vec3 direction = unitVector(table, "direction");
    const Spectrum intensity = color(table, "intensity", Range::nonNegative());
    const double outer = table.number("outer_angle", {0.01, 90.0});
    const double inner = table.number("inner_angle", {0.0, outer}, 0.75 * outer);
    return [=](BoundingSphere) {
        return makeSpotLight(position, direction, intensity, static_cast<float>(inner),
                             static_cast<float>(outer));
    };
}

MakeLight lightFrom(const ConfigTable& table, LoadingScene& loading) {
    const std::string type =
        table.choice("type", {"environment", "constant", "point", "spot", "directional"});
    if (type == "environment") return environmentFrom(table, loading);
    if (type == "spot") return spotFrom(table);
    if (type == "constant") {
        const Spectrum radiance = color(table, "radiance", Range::nonNegative());
        return [=](BoundingSphere scene) { return makeConstantLight(radiance, scene); };
    }
    if (type == "point") {
        const Vec3 position = toFloat(place(table, "position"));
        const Spectrum intensity = color(table, "intensity", Range::nonNegative());
        return [=](BoundingSphere) { return makePointLight(position, intensity); };
    }
    const Vec3 direction = unitVector(table, "direction");
    const Spectrum irradiance = color(table, "irradiance", Range::nonNegative());
    return [=](BoundingSphere scene) { return makeDirectionalLight(direction, irradiance, scene); };
}

}  // namespace

void loadLights(const std::vector<ConfigTable>& tables, LoadingScene& loading) {
    for (const ConfigTable& table : tables) {
        loading.parts.lights.push_back(lightFrom(table, loading));
        table.finish();
    }
}

}  // namespace etendue
