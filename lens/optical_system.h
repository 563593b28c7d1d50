// OpticalSystem: a prescription laid out in lens space, ready to trace.
//
// Lens space of a prescription: millimetres, the origin at the vertex of the first surface, +z
// toward the scene. Every other vertex, the stop and the sensor lie at negative z.
#pragma once

#include <vector>

#include "lens/aperture.h"
#include "lens/prescription.h"

namespace etendue {

struct TracedSurface {
    SurfaceShape shape;
    double vertexZMm;
    double semiApertureMm;
    std::optional<Coating> coating;
};

struct OpticalSystem {
    /// Wide open. Throws InputError when the prescription has a fault (prescription_check.h).
    explicit OpticalSystem(const Prescription& prescription);

    std::vector<TracedSurface> surfaces;  // from the scene to the sensor
    std::vector<Glass> media;  // media[i] in front of surface i; one more behind the last
    std::size_t stop;          // its surface
    Aperture aperture;         // of the stop
};

/// LensModel::reachMm: rays leave from the first surface, which is at most a hemisphere, or from
/// the plane at its vertex, where they lie a little farther out than on the surface.
inline double reachMm(const OpticalSystem& system) {
    return 2.0 * system.surfaces.front().semiApertureMm;
}

/// The indices of `media` at one wavelength, in its order.
std::vector<double> refractiveIndices(const OpticalSystem& system, double wavelengthNm);

}  // namespace etendue
