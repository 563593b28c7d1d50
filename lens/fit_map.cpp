#include "lens/fit_map.h"

#include <limits>

namespace etendue {

FitMap fitMap(const LensModel& exact, const LensModel& fitted, const Eigen::Vector2d& along,
              double highestMm, double apertureRadiusMm, double wavelengthNm, int fields,
              int apertures) {
    const std::size_t cells = static_cast<std::size_t>(fields * apertures);
    FitMap map{fields, apertures, {}, {}, {}, std::vector<bool>(cells), std::vector<bool>(cells)};
    map.directionMrad.assign(cells, std::numeric_limits<double>::quiet_NaN());
    for (int i = 0; i < fields; ++i) map.heightsMm.push_back(highestMm * (i + 0.5) / fields);
    for (int j = 0; j < apertures; ++j)
        map.aperturesMm.push_back(apertureRadiusMm * (2.0 * (j + 0.5) / apertures - 1.0));
    for (int j = 0; j < apertures; ++j)
        for (int i = 0; i < fields; ++i) {
            const SensorPoint sensor{map.heightsMm[static_cast<std::size_t>(i)] * along};
            const AperturePoint aperture{map.aperturesMm[static_cast<std::size_t>(j)] * along};
            const auto truth = exact.trace(sensor, aperture, wavelengthNm);
            const auto found = fitted.trace(sensor, aperture, wavelengthNm);
            const std::size_t cell = map.index(j, i);
            map.isWronglyAccepted[cell] = found && !truth;
            map.isWronglyBlocked[cell] = truth && !found;
            if (truth && found)
                map.directionMrad[cell] = 1e3 * (found->direction - truth->direction).norm();
        }
    return map;
}

}  // namespace etendue
