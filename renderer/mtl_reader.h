// Materials of Wavefront OBJ files (MTL). tinyobjloader has a reader too, but one that takes what
// is no number for 0, gives no lines, and cannot tell an absent value from its default.
#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "renderer/vec.h"

namespace etendue {

/// As the file has it: what the numbers mean is for the reader of the scene. Colours are RGB, not
/// negative; nothing keeps a file from a reflectance above 1.
struct ObjMaterial {
    std::string name;
    Vec3 diffuse{0.5f, 0.5f, 0.5f};    // Kd; 1 where there is a diffuseMap and no Kd
    Vec3 specular;                     // Ks
    Vec3 emission;                     // Ke
    float shininess = 0.0f;            // Ns, Phong's exponent
    float indexOfRefraction = 1.5f;    // Ni
    float opacity = 1.0f;              // d, or 1 - Tr, in [0, 1]
    int illuminationModel = 2;         // illum, 0 to 10; 2 has highlights
    std::optional<float> roughness;    // Pr, in [0, 1]
    std::optional<float> metallic;     // Pm, in [0, 1]
    std::filesystem::path diffuseMap;  // map_Kd, times Kd; empty or an existing file
    std::filesystem::path opacityMap;  // map_d
};

/// The materials of `wanted` that the file defines, the first of each name. Adds to `notes` what it
/// ignores or corrects. Throws InputError "file:line: …" for a number that is none or makes no
/// sense, wherever it stands, and for an image of a wanted material that is neither where the file
/// says nor, by its bare name, beside the file.
std::vector<ObjMaterial> readMtl(const std::filesystem::path& file,
                                 const std::set<std::string>& wanted,
                                 std::vector<std::string>& notes);

}  // namespace etendue
