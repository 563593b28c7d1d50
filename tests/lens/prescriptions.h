// The lenses of scenes/lenses, for tests.
#pragma once

#include <filesystem>
#include <vector>

#include "lens/prescription.h"

namespace etendue {

inline std::filesystem::path lensFile(const std::string& name) {
    return std::filesystem::path(__FILE__).parent_path() / "../../scenes/lenses" / name;
}

struct ShippedLens {
    std::string file;
    double imageHeightMm;  // to which rays pass in some number
    std::string zoomPosition = {};
};

/// Every lens, at every zoom position.
inline const std::vector<ShippedLens>& shippedLenses() {
    static const std::vector<ShippedLens> lenses{
        {"anamorphic-80x90mm.toml", 12.0},     {"double-gauss-100mm.toml", 21.6},
        {"double-gauss-50mm-f1.1.toml", 18.0}, {"fisheye-10mm.toml", 13.5},
        {"fisheye-181-10mm.toml", 14.0},       {"fisheye-220-6mm.toml", 11.0},
        {"fisheye-220-6mm-f2.8.toml", 11.0},   {"petzval-50mm.toml", 15.0},
        {"retrofocus-100mm.toml", 60.0},       {"tessar-100mm.toml", 21.6},
        {"zoom-57-143mm.toml", 18.0, "57 mm"}, {"zoom-57-143mm.toml", 18.0, "143 mm"}};
    return lenses;
}

inline Prescription load(const ShippedLens& lens) {
    return loadPrescription(lensFile(lens.file), lens.zoomPosition);
}

/// A surface of revolution in a table made by hand.
inline Surface spherical(double radiusMm, double thicknessMm, double semiApertureMm,
                         const Glass& behind = Air{}) {
    Surface surface;
    surface.radiusMm = radiusMm;
    surface.thicknessMm = thicknessMm;
    surface.semiApertureMm = semiApertureMm;
    surface.behind = behind;
    return surface;
}

inline Surface stop(double thicknessMm, double semiApertureMm) {
    Surface surface =
        spherical(std::numeric_limits<double>::infinity(), thicknessMm, semiApertureMm);
    surface.kind = SurfaceKind::stop;
    return surface;
}

/// Of the same index at every wavelength.
inline Glass plainGlass(double index) { return ConradyGlass{index, 0.0, 0.0}; }

/// A lens of two surfaces with a stop behind it.
inline Prescription singlet(double frontRadiusMm, double rearRadiusMm, double thicknessMm,
                            double index, double semiApertureMm) {
    Prescription prescription;
    prescription.name = "singlet";
    prescription.surfaces = {
        spherical(frontRadiusMm, thicknessMm, semiApertureMm, plainGlass(index)),
        spherical(rearRadiusMm, 2.0, semiApertureMm), stop(50.0, 0.5 * semiApertureMm)};
    return prescription;
}

}  // namespace etendue
