#include "renderer/metals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>

#include "renderer/colorimetry.h"
#include "renderer/vec.h"

namespace etendue {

namespace {

struct Measurement {
    double wavelengthNm, eta, k;
};

// Gold, silver, copper: P. B. Johnson and R. W. Christy 1972, "Optical Constants of the Noble
// Metals", Phys. Rev. B 6, 4370, at room temperature (photon energies 3.37 … 1.51 eV).
constexpr Measurement gold[] = {
    {367.9, 1.48, 1.895}, {381.5, 1.46, 1.933}, {397.4, 1.47, 1.952}, {413.3, 1.46, 1.958},
    {430.5, 1.45, 1.948}, {450.9, 1.38, 1.914}, {471.4, 1.31, 1.849}, {495.9, 1.04, 1.833},
    {520.9, 0.62, 2.081}, {548.6, 0.43, 2.455}, {582.1, 0.29, 2.863}, {616.8, 0.21, 3.272},
    {659.5, 0.14, 3.697}, {704.5, 0.13, 4.103}, {756.0, 0.14, 4.542}, {821.1, 0.16, 5.083}};
constexpr Measurement silver[] = {
    {367.9, 0.07, 1.657}, {381.5, 0.05, 1.864}, {397.4, 0.05, 2.070}, {413.3, 0.05, 2.275},
    {430.5, 0.04, 2.462}, {450.9, 0.04, 2.657}, {471.4, 0.05, 2.869}, {495.9, 0.05, 3.093},
    {520.9, 0.05, 3.324}, {548.6, 0.06, 3.586}, {582.1, 0.05, 3.858}, {616.8, 0.06, 4.152},
    {659.5, 0.05, 4.483}, {704.5, 0.04, 4.838}, {756.0, 0.03, 5.242}, {821.1, 0.04, 5.727}};
constexpr Measurement copper[] = {
    {367.9, 1.36, 1.975}, {381.5, 1.33, 2.045}, {397.4, 1.32, 2.116}, {413.3, 1.28, 2.207},
    {430.5, 1.25, 2.305}, {450.9, 1.24, 2.397}, {471.4, 1.25, 2.483}, {495.9, 1.22, 2.564},
    {520.9, 1.18, 2.608}, {548.6, 1.02, 2.577}, {582.1, 0.70, 2.704}, {616.8, 0.30, 3.205},
    {659.5, 0.22, 3.747}, {704.5, 0.21, 4.205}, {756.0, 0.24, 4.665}, {821.1, 0.26, 5.180}};
// A. D. Rakić 1995, "Algorithm for the Determination of Intrinsic Optical Constants of Metal Films:
// Application to Aluminum", Appl. Opt. 34, 4755.
constexpr Measurement aluminium[] = {
    {364.66, 0.39877, 4.3957}, {413.28, 0.52135, 5.0008}, {442.80, 0.60790, 5.3676},
    {476.87, 0.72780, 5.7781}, {516.60, 0.87340, 6.2418}, {563.57, 1.0728, 6.7839},
    {619.93, 1.3660, 7.4052},  {652.25, 1.5724, 7.7354},  {688.81, 1.8301, 8.0601},
    {729.32, 2.1606, 8.3565},  {774.91, 2.6154, 8.4914},  {815.69, 2.7668, 8.2573},
    {837.74, 2.6945, 8.1878}};

struct Metal {
    std::string_view name;
    std::span<const Measurement> table;
};
constexpr std::array metals{Metal{"gold", gold}, Metal{"silver", silver}, Metal{"copper", copper},
                            Metal{"aluminium", aluminium}};

constexpr double squared(double x) { return x * x; }

std::span<const Measurement> tableOf(std::string_view name) {
    for (const Metal& metal : metals)
        if (metal.name == name) return metal.table;
    throw std::invalid_argument("no metal called " + std::string(name));
}

OpticalConstants interpolate(std::span<const Measurement> table, double wavelengthNm) {
    const auto above = std::upper_bound(
        table.begin() + 1, table.end() - 1, wavelengthNm,
        [](double wavelength, const Measurement& m) { return wavelength < m.wavelengthNm; });
    const Measurement &a = *(above - 1), &b = *above;
    const double t =
        std::clamp((wavelengthNm - a.wavelengthNm) / (b.wavelengthNm - a.wavelengthNm), 0.0, 1.0);
    return {a.eta + t * (b.eta - a.eta), a.k + t * (b.k - a.k)};
}

double normalReflectance(OpticalConstants c) {
    return (squared(c.eta - 1) + squared(c.k)) / (squared(c.eta + 1) + squared(c.k));
}

struct RgbOptics {
    Vec3d reflectance, eta;
};

RgbOptics averageOverLanes(std::span<const Measurement> table) {
    Vec3d reflected, white, eta, weight;
    double brightest = 0.0;
    for (double nm = 380.0; nm <= 780.0; nm += 10.0) {
        const OpticalConstants constants = interpolate(table, nm);
        const double reflectance = normalReflectance(constants);
        const Vec3d lane = rec709FromXyz(xyzMatching(nm)) * d65(nm);
        reflected += lane * reflectance;
        white += lane;
        const Vec3d positive = max(lane, Vec3d{});
        eta += positive * constants.eta;
        weight += positive;
        brightest = std::max(brightest, reflectance);
    }
    const auto divide = [](Vec3d a, Vec3d b) { return Vec3d{a.x / b.x, a.y / b.y, a.z / b.z}; };
    const Vec3d top{brightest, brightest, brightest};
    return {min(divide(reflected, white), top), divide(eta, weight)};
}

/// k such that η + i k reflects `reflectance` at normal incidence; 0 where none does.
double extinction(double reflectance, double eta) {
    return std::sqrt(
        std::max(0.0, (reflectance * squared(eta + 1) - squared(eta - 1)) / (1.0 - reflectance)));
}

}  // namespace

std::vector<std::string> metalNames() {
    std::vector<std::string> names;
    names.reserve(metals.size());
    for (const Metal& metal : metals) names.emplace_back(metal.name);
    return names;
}

OpticalConstants opticalConstants(std::string_view name, double wavelengthNm) {
    return interpolate(tableOf(name), wavelengthNm);
}

ConductorOptics metalOptics(std::string_view name) {
    const RgbOptics rgbOptics = averageOverLanes(tableOf(name));
    const auto used = [](int i) { return std::min(i, 2); };  // the fourth lane repeats the third
    return {Spectrum::fromLanes([&](int i) { return static_cast<float>(rgbOptics.eta[used(i)]); }),
            Spectrum::fromLanes([&](int i) {
                return static_cast<float>(
                    extinction(rgbOptics.reflectance[used(i)], rgbOptics.eta[used(i)]));
            })};
}

}  // namespace etendue
