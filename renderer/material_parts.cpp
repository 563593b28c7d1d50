// [[material]], and what an MTL entry means.
#include <fmt/format.h>

#include <cmath>

#include "renderer/bsdfs.h"
#include "renderer/scene_parts.h"

namespace etendue {

namespace {

constexpr float greyReflectance = 0.5f;

Spectrum toSpectrum(Vec3 v) { return rgb(v.x, v.y, v.z); }

/// Integers of a file are shares as they are.
void checkShares(const Image& image, TextureUse use, const std::filesystem::path& file) {
    const auto* values = std::get_if<std::vector<float>>(&image.pixels);
    if (use == TextureUse::radiance || !values || image.isEncoded) return;
    // As Texture reads them: colours; or of an opacity one channel, alpha where there is one.
    const auto channels = static_cast<std::size_t>(image.channels),
               width = static_cast<std::size_t>(image.width);
    const std::size_t colors = channels % 2 == 0 ? channels - 1 : channels;
    const bool isOpacity = use == TextureUse::opacity;
    const std::size_t first = isOpacity && colors < channels ? colors : 0;
    const std::size_t end = isOpacity ? first + 1 : colors;
    for (std::size_t i = 0; i < values->size(); ++i) {
        const std::size_t texel = i / channels, channel = i % channels;
        const float value = (*values)[i];
        if (channel < first || channel >= end || (value >= 0.0f && value <= 1.0f)) continue;
        throw InputError(fmt::format("{}: texel ({}, {}) is {}: expected {} from 0 to 1",
                                     file.string(), texel % width, texel / width, value,
                                     isOpacity ? "an opacity" : "a reflectance"));
    }
}

Texture textureOr(const ConfigTable& table, std::string_view key, Spectrum fallback,
                  LoadingScene& loading) {
    if (!table.has(key)) return Texture(fallback);
    if (table.isText(key)) return *loadTexture(table, key, TextureUse::reflectance, loading);
    return Texture(color(table, key, Range::unit()));
}

std::unique_ptr<Bsdf> conductorFrom(const ConfigTable& table) {
    const auto roughness = static_cast<float>(table.number("roughness", Range::unit(), 0.0));
    if (table.has("metal") && table.has("color"))
        table.fail("metal", "a conductor has either a metal or a color");
    if (table.has("color")) return makeConductor(color(table, "color", Range::unit()), roughness);
    return makeConductor(metalOptics(table.choice("metal", metalNames())), roughness);
}

std::unique_ptr<Bsdf> bsdfFrom(const ConfigTable& table, LoadingScene& loading) {
    const std::string type =
        table.choice("type", {"diffuse", "conductor", "dielectric", "plastic"}, "diffuse");
    const auto roughness = [&] {
        return static_cast<float>(table.number("roughness", Range::unit(), 0.0));
    };
    const auto ior = [&] { return static_cast<float>(table.number("ior", {0.1, 10.0}, 1.5)); };
    if (type == "conductor") return conductorFrom(table);
    if (type == "dielectric") {
        const Spectrum tint =
            table.has("color") ? color(table, "color", Range::unit()) : rgb(1, 1, 1);
        if (!table.has("abbe_number")) return makeDielectric(ior(), tint, roughness());
        if (roughness() > 0.0f)
            table.fail("abbe_number", "only smooth dielectrics disperse: roughness must be 0");
        loading.isDispersive = true;
        const double abbeNumber = table.number("abbe_number", {1.0, 1000.0});
        return makeDispersiveDielectric(ior(), static_cast<float>(abbeNumber), tint);
    }
    Texture reflectance =
        textureOr(table, "color", Spectrum(rgb(1, 1, 1) * greyReflectance), loading);
    if (type == "plastic") return makePlastic(std::move(reflectance), ior(), roughness());
    return makeDiffuse(std::move(reflectance));
}

void loadOpacity(const ConfigTable& table, Material& material, LoadingScene& loading) {
    if (!table.has("opacity")) return;
    if (emits(material)) table.fail("opacity", "a material that emits cannot have an opacity");
    if (table.isText("opacity"))
        material.opacity = *loadTexture(table, "opacity", TextureUse::opacity, loading);
    else if (const double value = table.number("opacity", Range::unit()); value < 1.0)
        material.opacity = Texture(Spectrum(static_cast<float>(value)));
}

/// Blinn–Phong's exponent as GGX roughness: α² = 2 / (n + 2) matches the widths of the two lobes
/// (Walter et al. 2007), and α is the roughness squared.
float roughnessFromShininess(float shininess) {
    return std::sqrt(std::sqrt(2.0f / (std::max(shininess, 0.0f) + 2.0f)));
}

/// MTL values are whatever the exporter wrote; reflectance above 1 would create light.
Spectrum reflectance(Vec3 v, const ObjMaterial& m, const char* key, LoadingScene& loading) {
    const float top = maxComponent(v);
    if (top <= 1.0f) return toSpectrum(v);
    loading.notes.push_back("material '" + m.name + "': " + key + " above 1 scaled down to 1");
    return toSpectrum(v / top);
}

bool isGlass(const ObjMaterial& m) {
    const int i = m.illuminationModel;
    return (i == 4 || i == 6 || i == 7 || i == 9) && m.indexOfRefraction > 1.0f;
}

/// Metals have one colour all over.
Spectrum metalColor(const ObjMaterial& m, LoadingScene& loading) {
    if (m.diffuseMap.empty()) return reflectance(m.diffuse, m, "Kd", loading);
    loading.notes.push_back("material '" + m.name +
                            "' is a metal: only the mean of its map_Kd counts");
    return loadTexture(m.diffuseMap, TextureUse::reflectance, loading)->average();
}

Texture diffuseTexture(const ObjMaterial& m, LoadingScene& loading) {
    if (!m.diffuseMap.empty()) return *loadTexture(m.diffuseMap, TextureUse::reflectance, loading);
    return Texture(reflectance(m.diffuse, m, "Kd", loading));
}

/// docs/scene-format.md, "What an MTL entry means".
std::unique_ptr<Bsdf> bsdfFromMtl(const ObjMaterial& m, LoadingScene& loading) {
    const bool isBlackDiffuse = m.diffuseMap.empty() && maxComponent(m.diffuse) <= 0.0f;
    const bool isSpecular = maxComponent(m.specular) > 0.0f;
    const float ior = m.indexOfRefraction > 1.0f ? m.indexOfRefraction : 1.5f;
    if (m.metallic && *m.metallic >= 0.5f)
        return makeConductor(metalColor(m, loading), m.roughness.value_or(0.5f));
    if (isGlass(m)) {
        if (!m.diffuseMap.empty())
            loading.notes.push_back("material '" + m.name + "' is glass: its map_Kd is ignored");
        return makeDielectric(m.indexOfRefraction, rgb(1, 1, 1), m.roughness.value_or(0.0f));
    }
    if (isSpecular && isBlackDiffuse) {
        const bool isMirror = m.illuminationModel == 3 || m.illuminationModel == 5;
        const float roughness = isMirror ? 0.0f : roughnessFromShininess(m.shininess);
        return makeConductor(reflectance(m.specular, m, "Ks", loading),
                             m.roughness.value_or(roughness));
    }
    if (m.roughness) return makePlastic(diffuseTexture(m, loading), ior, *m.roughness);
    if (isSpecular && m.illuminationModel >= 2)
        return makePlastic(diffuseTexture(m, loading), ior, roughnessFromShininess(m.shininess));
    return makeDiffuse(diffuseTexture(m, loading));
}

Material* addMaterial(LoadingScene& loading) {
    loading.parts.materials.push_back(std::make_unique<Material>());
    return loading.parts.materials.back().get();
}

}  // namespace

std::shared_ptr<const Texture> loadTexture(const std::filesystem::path& file, TextureUse use,
                                           LoadingScene& loading) {
    std::shared_ptr<const Texture>& texture = loading.textures[{file, use}];
    if (!texture) {
        Image image = readImage(file);
        checkShares(image, use, file);
        // An environment light wraps its image in longitude by itself.
        texture = std::make_shared<Texture>(
            std::move(image),
            use == TextureUse::opacity ? ColorEncoding::linear : ColorEncoding::sRgb,
            use == TextureUse::radiance ? TextureWrap::clamp : TextureWrap::repeat);
        loading.files.push_back(file);
    }
    return texture;
}

Spectrum color(const ConfigTable& table, std::string_view key, Range range) {
    const std::vector<double> v = table.numbers(key, 3, range);
    return rgb(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
}

void loadMaterials(const std::vector<ConfigTable>& tables, LoadingScene& loading) {
    for (const ConfigTable& table : tables) {
        Material* material = addMaterial(loading);
        material->name = table.text("name");
        if (!loading.materials.emplace(material->name, material).second)
            table.fail("name", "used by an earlier material");
        material->bsdf = bsdfFrom(table, loading);
        if (table.has("emission")) {
            material->emission = color(table, "emission", Range::nonNegative());
            material->isEmissionTwoSided = table.boolean("two_sided_emission", false);
        }
        loadOpacity(table, *material, loading);
        table.finish();
    }
}

const Material* findMaterial(const ConfigTable& table, const std::string& key,
                             const LoadingScene& loading) {
    std::vector<std::string> names;
    for (const auto& [name, material] : loading.materials) names.push_back(name);
    return loading.materials.at(table.choice(key, names));
}

const Material* addObjMaterial(const ObjMaterial& m, LoadingScene& loading) {
    Material* material = addMaterial(loading);
    material->name = m.name;
    material->bsdf = bsdfFromMtl(m, loading);
    material->emission = toSpectrum(m.emission);
    const bool hasOpacity = !m.opacityMap.empty() || (m.opacity < 1.0f && !isGlass(m));
    if (!hasOpacity) return material;
    if (emits(*material)) {
        loading.notes.push_back("material '" + m.name + "' emits: its opacity is ignored");
    } else if (!m.opacityMap.empty()) {
        material->opacity = *loadTexture(m.opacityMap, TextureUse::opacity, loading);
    } else {
        material->opacity = Texture(Spectrum(m.opacity));
    }
    return material;
}

const Material* defaultMaterial(LoadingScene& loading) {
    if (!loading.defaultMaterial) {
        Material* grey = addMaterial(loading);
        grey->bsdf = makeDiffuse(Texture(rgb(1, 1, 1) * greyReflectance));
        loading.defaultMaterial = grey;
    }
    return loading.defaultMaterial;
}

}  // namespace etendue
