// A small scene with every kind of vertex and light.
#pragma once

#include <string>

namespace etendue {

inline const std::string everyMaterialFrame = R"(
[film]
width = 16
height = 12
[camera]
model = "thin-lens"
from = [0.2, 1, 3.9]
to = [0, 0.7, 0]
fov = 60
f_number = 2
focus_distance = 3.4
[estimator]
max_depth = 6
)";

/// The same through a lens of glass, traced in four wavelengths.
inline std::string dispersiveFrame(const std::string& lensFile) {
    return R"(
[film]
width = 16
height = 12
[camera]
lens = ")" +
           lensFile + R"("
representation = "traced"
from = [0.2, 1, 3.9]
to = [0, 0.7, 0]
sensor_width_mm = 36
f_number = 2
focus_distance = 3.4
[estimator]
max_depth = 6
)";
}

/// Makes a spectral scene of it, with a glass that parts the colours.
inline const std::string dispersiveGlass = "material.glass.abbe_number=30";

inline const std::string silverMirror = R"(
[[material]]
name = "mirror"
type = "conductor"
metal = "silver"
roughness = 0
)";

/// Smooth plastic, matte, glass, a mirror and rough metal.
inline const std::string everyMaterialRoom = silverMirror + R"(
[[material]]
name = "floor"
type = "plastic"
color = [0.6, 0.5, 0.4]
roughness = 0
[[material]]
name = "wall"
color = [0.4, 0.5, 0.7]
[[material]]
name = "glass"
type = "dielectric"
[[material]]
name = "gold"
type = "conductor"
metal = "gold"
roughness = 0.5
[[mesh]]
shape = "rectangle"
material = "floor"
transform = [{scale = 3}, {rotate = [1, 0, 0, -90]}]
[[mesh]]
shape = "rectangle"
material = "wall"
transform = [{scale = 1.5}, {translate = [0, 1, -1]}]
[[mesh]]
shape = "sphere"
segments = 12
material = "glass"
transform = [{scale = 0.5}, {translate = [0.3, 0.6, 0.3]}]
[[mesh]]
shape = "sphere"
segments = 12
material = "gold"
transform = [{scale = 0.4}, {translate = [-0.7, 0.4, 0]}]
[[mesh]]
shape = "rectangle"
material = "mirror"
transform = [{scale = 0.6}, {rotate = [0, 1, 0, -50]}, {translate = [1.2, 0.8, -0.3]}]
)";

inline const std::string lampAndSky = R"(
[[material]]
name = "lamp"
color = [0.2, 0.2, 0.2]
emission = [9, 8, 6]
[[mesh]]
shape = "rectangle"
material = "lamp"
transform = [{scale = 0.4}, {rotate = [1, 0, 0, 90]}, {translate = [-0.4, 2.2, 0.3]}]
[[light]]
type = "constant"
radiance = [0.1, 0.2, 0.3]
)";

/// The point is in the picture.
inline const std::string pointAndSun = R"(
[[light]]
type = "point"
position = [-0.5, 1.6, 0]
intensity = [3, 4, 5]
[[light]]
type = "directional"
direction = [0.3, -1, -0.6]
irradiance = [2, 2, 3]
)";

inline const std::string everyMaterialScene =
    everyMaterialFrame + everyMaterialRoom + lampAndSky + pointAndSun;

}  // namespace etendue
