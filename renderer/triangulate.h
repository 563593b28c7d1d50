// Polygons to triangles, by ear clipping (Meisters 1975, "Polygons have ears").
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/vec.h"

namespace etendue {

/// Appends the size() - 2 triangles of a polygon of at least three corners, as indices into it, in
/// its winding. Simple polygons, convex or not, and those with holes cut open by a double edge are
/// covered exactly; one that crosses itself is covered somehow. Of the two ways to halve a convex
/// quadrilateral it takes the shorter diagonal. A polygon that is not flat counts as seen along the
/// axis nearest to its normal.
void triangulate(std::span<const Vec3> polygon,
                 std::vector<std::array<std::uint32_t, 3>>& triangles);

/// Twice its area, along its normal (Newell's method). Zero for fewer than three corners.
Vec3d polygonNormal(std::span<const Vec3> polygon);

}  // namespace etendue
