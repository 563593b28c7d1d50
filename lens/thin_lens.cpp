#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "lens/disc_sampling.h"
#include "lens/ideal_lens.h"
#include "lens/lens_model.h"

namespace etendue {

namespace {

class ThinLens final : public LensModel {
public:
    ThinLens(IdealLens map, double apertureRadiusMm)
        : map_(map), apertureRadiusMm_(apertureRadiusMm) {}

    std::optional<ExitRay> trace(SensorPoint sensor, AperturePoint aperture,
                                 double /*wavelengthNm*/) const override {
        if (!isOpen(aperture)) return {};
        return map_.trace(sensor, aperture);
    }

    std::optional<SensorPoint> connect(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                                       double /*wavelengthNm*/) const override {
        if (!isOpen(aperture)) return {};
        return map_.connect(targetMm, aperture);
    }

    AperturePoint sampleAperture(Eigen::Vector2d u) const override {
        return {apertureRadiusMm_ * sampleUnitDisc(u)};
    }

    double apertureAreaMm2() const override {
        return std::numbers::pi * apertureRadiusMm_ * apertureRadiusMm_;
    }
    double reachMm() const override { return apertureRadiusMm_ * rim; }

private:
    // So wide that what sampleAperture draws on the rim passes in spite of rounding.
    static constexpr double rim = 1.0 + 16.0 * std::numeric_limits<double>::epsilon();

    bool isOpen(AperturePoint aperture) const {
        return aperture.mm.norm() <= apertureRadiusMm_ * rim;
    }

    IdealLens map_;
    double apertureRadiusMm_;
};

}  // namespace

std::unique_ptr<LensModel> makeThinLens(double focalLengthMm, double focusDistanceMm,
                                        double apertureRadiusMm) {
    if (!(focalLengthMm > 0.0 && focusDistanceMm > focalLengthMm))
        throw std::invalid_argument(
            "thin lens: the focus distance must exceed the focal length, and that zero");
    if (!(apertureRadiusMm > 0.0 && std::isfinite(apertureRadiusMm)))
        throw std::invalid_argument("thin lens: the aperture radius must be positive");
    // v = 1/(1/f − 1/u), in a form that allows infinite u.
    const double sensorDistanceMm = focalLengthMm / (1.0 - focalLengthMm / focusDistanceMm);
    if (!std::isfinite(sensorDistanceMm))
        throw std::invalid_argument("thin lens: focused so near that the image is at infinity");
    return std::make_unique<ThinLens>(IdealLens{sensorDistanceMm, 1.0 / focusDistanceMm},
                                      apertureRadiusMm);
}

}  // namespace etendue
