#include "renderer/colorimetry.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace etendue {

namespace {

constexpr double firstNm = 380.0, stepNm = 10.0;
constexpr std::array d65Table{49.9755, 54.6482, 82.7549, 91.4860, 93.4318, 86.6823, 104.865,
                              117.008, 117.812, 114.861, 115.923, 108.811, 109.354, 107.802,
                              104.790, 107.689, 104.405, 104.046, 100.000, 96.3342, 95.7880,
                              88.6856, 90.0062, 89.5991, 87.6987, 83.2886, 83.6992, 80.0268,
                              80.2146, 82.2778, 78.2842, 69.7213, 71.6091, 74.3490, 61.6040,
                              69.8856, 75.0870, 63.5927, 46.4182, 66.8054, 63.3828};

constexpr double squared(double x) { return x * x; }

}  // namespace

Vec3d xyzMatching(double wavelengthNm) {
    const auto lobe = [=](double center, double below, double above) {
        return std::exp(-0.5 *
                        squared((wavelengthNm - center) / (wavelengthNm < center ? below : above)));
    };
    return {1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) -
                0.065 * lobe(501.1, 20.4, 26.2),
            0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
            1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8)};
}

double d65(double wavelengthNm) {
    const double place = std::clamp((wavelengthNm - firstNm) / stepNm, 0.0,
                                    static_cast<double>(d65Table.size() - 1));
    const auto i = std::min(static_cast<std::size_t>(place), d65Table.size() - 2);
    const double t = place - static_cast<double>(i);
    return d65Table[i] + t * (d65Table[i + 1] - d65Table[i]);
}

Vec3d rec709FromXyz(Vec3d c) {
    return {3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z,
            -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z,
            0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z};
}

Vec3d xyzFromRec709(Vec3d c) {
    // The inverse of the matrix above, from its rows.
    const Vec3d r = rec709FromXyz({1, 0, 0}), g = rec709FromXyz({0, 1, 0}),
                b = rec709FromXyz({0, 0, 1});
    const double determinant = dot(r, cross(g, b));
    return Vec3d{dot(c, cross(g, b)), dot(c, cross(b, r)), dot(c, cross(r, g))} / determinant;
}

}  // namespace etendue
