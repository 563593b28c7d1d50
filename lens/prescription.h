// Prescription: a lens as its maker tabulates it, surface by surface from the scene to the sensor.
//
//     name = "Tessar, 100 mm f/2.8"
//     source = "US patent 2,854,889"
//     focal_length_mm = 99.996            # what the table must give, at the d line
//     back_focal_distance_mm = 79.809
//     f_number = 2.81
//     surface = [
//       { radius_mm = 42.97, thickness_mm = 9.8, nd = 1.691, vd = 54.8, semi_aperture_mm = 19.2 },
//       { type = "stop", thickness_mm = 4, semi_aperture_mm = 15 },
//       …
//     ]
//
// Of a surface: `type` spherical (default), conic, aspheric, cylinder-x (curved in x, flat in y),
// cylinder-y, planar or stop; `radius_mm` positive when the centre of curvature lies toward the
// sensor, inf for a plane; `thickness_mm` along the axis to the next surface, of the last to the
// tabulated sensor; the medium behind it, toward the sensor, as `nd` and `vd`, as `glass`, a name
// of the catalogue, or as `sellmeier` = [b1, b2, b3, c1, c2, c3] (µm²), none being air; `conic` and
// `a4` … `a16` of the sag (surface_shape.h, with the signs of the radius); `coating` = { index,
// design_wavelength_nm, thickness_waves }.
//
// A zoom lens has `zoom_positions` = ["57 mm", "143 mm"], and any thickness and what the header
// states may then be a list, one number for each. An anamorphic lens states `focal_length_x_mm` and
// `back_focal_distance_x_mm` besides, the ones without x being those in y.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lens/fresnel.h"
#include "lens/glass.h"
#include "lens/surface_shape.h"

namespace etendue {

enum class SurfaceKind { spherical, conic, aspheric, cylinderX, cylinderY, planar, stop };

struct Surface {
    SurfaceKind kind = SurfaceKind::spherical;
    double radiusMm = std::numeric_limits<double>::infinity();
    double thicknessMm = 0.0;
    Glass behind = Air{};  // a stop's: that in front of it
    double semiApertureMm = 0.0;
    double conic = 0.0;
    std::array<double, 7> asphere{};  // a₄ … a₁₆, mm⁻³ … mm⁻¹⁵
    std::optional<Coating> coating;
};

/// What a table claims, at the d line. x and y differ in anamorphic lenses alone.
struct StatedData {
    double focalLengthXMm, focalLengthYMm;
    double backFocalDistanceXMm, backFocalDistanceYMm;  // last vertex to focus
    double fNumber;  // of the widest axial beam from infinity; by the mean of both focal lengths
};

/// One zoom position of a lens.
struct Prescription {
    std::string name, source, notes;
    std::string zoomPosition;  // empty for a lens that does not zoom
    StatedData stated{};
    std::vector<Surface> surfaces;  // from the scene to the sensor
};

/// All zoom positions of a lens file, in its order; one for a lens that does not zoom. Throws
/// InputError, naming file, line and surface, for anything that is no lens (prescription_check.h)
/// or not the lens that its header states.
std::vector<Prescription> loadPrescriptions(const std::filesystem::path& file);
/// The zoom position of that name; the first if empty. InputError lists the names.
Prescription loadPrescription(const std::filesystem::path& file,
                              std::string_view zoomPosition = {});

/// In lens space, where +z points toward the scene.
SurfaceShape lensSpaceShape(const Surface& surface);
/// The index of the stop. There must be one.
std::size_t stopIndex(const Prescription& prescription);
/// From the first vertex to the last.
double lengthMm(const Prescription& prescription);
bool isAnamorphic(const Prescription& prescription);
/// The same lens at `factor` times the size, its stated data with it.
Prescription scaled(const Prescription& prescription, double factor);

/// Of everything that bends or stops light; not of names, notes and stated data. The same on every
/// machine (FNV-1a, 64 bits).
std::uint64_t contentHash(const Prescription& prescription);

}  // namespace etendue
