#include <cmath>
#include <stdexcept>

#include "lens/ideal_lens.h"
#include "lens/lens_model.h"

namespace etendue {

namespace {

class Pinhole final : public LensModel {
public:
    explicit Pinhole(double sensorDistanceMm) : map_{sensorDistanceMm, 0.0} {}

    std::optional<ExitRay> trace(SensorPoint sensor, AperturePoint aperture,
                                 double /*wavelengthNm*/) const override {
        if (!aperture.mm.isZero(0.0)) return {};
        return map_.trace(sensor, aperture);
    }

    std::optional<SensorPoint> connect(const Eigen::Vector3d& targetMm, AperturePoint aperture,
                                       double /*wavelengthNm*/) const override {
        if (!aperture.mm.isZero(0.0)) return {};
        return map_.connect(targetMm, aperture);
    }

    AperturePoint sampleAperture(Eigen::Vector2d /*u*/) const override { return {{0.0, 0.0}}; }
    double apertureAreaMm2() const override { return 1.0; }
    double reachMm() const override { return 0.0; }

private:
    IdealLens map_;
};

}  // namespace

std::unique_ptr<LensModel> makePinhole(double sensorDistanceMm) {
    if (!(sensorDistanceMm > 0.0 && std::isfinite(sensorDistanceMm)))
        throw std::invalid_argument("pinhole: the sensor distance must be positive");
    return std::make_unique<Pinhole>(sensorDistanceMm);
}

}  // namespace etendue
