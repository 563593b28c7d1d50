// Built-in shapes, so that a scene can be a small text file.
//
// Every mesh has one material (named ""), its front side outside, no triangle without area, and
// texture coordinates in [0, 1]², not mirrored as seen from the front. Curved shapes have normals,
// flat ones none. Vertices lie exactly on the curved surface, so that a convex shape is slightly
// too small; the shapes below say how much. A bad argument throws std::invalid_argument.
#pragma once

#include <span>

#include "renderer/mesh.h"

namespace etendue {

/// Unit sphere, poles on the z axis, of 8 n² triangles of nearly equal size, where n = ⌈segments /
/// 4⌉: the equator has 4 n sides and every circle of latitude one per quadrant fewer than its
/// neighbour. Area and volume fall short of 4π and 4π/3 by 0.81 / n² and 1.5 / n² of
/// their values at most. u is the longitude from +x, v the latitude from -z to +z.
Mesh makeSphere(int segments);

/// [-1, 1]² in the xy plane, facing +z, of 2 subdivisions² triangles.
Mesh makeRectangle(int subdivisions = 1);

/// [-1, 1]³, of 12 triangles. Every face has its own [0, 1]² of texture coordinates.
Mesh makeBox();

/// Unit disc in the xy plane, facing +z: the regular polygon, whose area is sinc(2π / segments) of
/// the disc's. The texture is laid on the enclosing square.
Mesh makeDisc(int segments);

/// Radius 1 around the z axis from z = 0 to 1; area and volume as the disc's polygon. u is the
/// longitude, v = z; a cap is textured as a disc.
Mesh makeCylinder(int segments, bool capped);

/// Ring of radius 1 around the z axis, its tube of `minorRadius`, between 0 and 1. u is the
/// longitude, v the angle around the tube from its outermost circle by way of the top.
Mesh makeTorus(float minorRadius, int majorSegments, int minorSegments);

/// Surface of revolution around the z axis of a polyline of points (radius, height). Where the
/// profile goes up, the front side is outside: a solid's profile starts on the axis at the bottom
/// and ends on the axis at the top, a vessel's goes up its outer and comes down its inner wall. The
/// surface is closed when both ends have radius 0.
///
/// Joints are smooth unless they turn by more than `creaseDegrees` or their point is given twice.
/// With `subdivisions` > 1 a smooth curve through the points takes the polyline's place, that many
/// pieces from point to point (centripetal Catmull–Rom: Yuksel, Schaefer and Keyser 2011, "On the
/// Parameterization of Catmull-Rom Curves"); it has a corner at a point given twice and meets the
/// axis at a right angle. u is the longitude, v the length along the profile.
Mesh makeLathe(std::span<const Vec2> profile, int segments, int subdivisions = 1,
               float creaseDegrees = 40.0f);

}  // namespace etendue
