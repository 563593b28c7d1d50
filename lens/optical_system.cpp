#include "lens/optical_system.h"

#include "config/config.h"
#include "lens/prescription_check.h"

namespace etendue {

namespace {

const Prescription& checked(const Prescription& prescription) {
    if (const auto fault = findFault(prescription)) {
        const std::string place =
            fault->surface ? "surface[" + std::to_string(*fault->surface) + "]." : "";
        throw InputError(prescription.name + ": " + place + fault->key + ": " + fault->message);
    }
    return prescription;
}

}  // namespace

OpticalSystem::OpticalSystem(const Prescription& prescription)
    : stop(stopIndex(checked(prescription))), aperture(prescription.surfaces[stop].semiApertureMm) {
    double z = 0.0;
    media.push_back(Air{});
    for (const Surface& surface : prescription.surfaces) {
        surfaces.push_back({lensSpaceShape(surface), z, surface.semiApertureMm, surface.coating});
        media.push_back(surface.behind);
        z -= surface.thicknessMm;
    }
}

std::vector<double> refractiveIndices(const OpticalSystem& system, double wavelengthNm) {
    std::vector<double> indices;
    indices.reserve(system.media.size());
    for (const Glass& glass : system.media) indices.push_back(refractiveIndex(glass, wavelengthNm));
    return indices;
}

}  // namespace etendue
