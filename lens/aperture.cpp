#include "lens/aperture.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "lens/disc_sampling.h"

namespace etendue {

Aperture::Aperture(double radiusMm, const Blades& blades)
    : radiusMm_(radiusMm),
      blades_(blades.roundness == 1.0 ? 0 : blades.count),
      rotationRadians_(blades.rotationDegrees * (std::numbers::pi / 180.0)),
      roundness_(blades.roundness) {
    if (!(radiusMm > 0.0 && std::isfinite(radiusMm)))
        throw std::invalid_argument("aperture: the radius must be positive");
    if (blades.count != 0 && blades.count < 3)
        throw std::invalid_argument("aperture: at least 3 blades, or 0 for a circle");
    if (!(roundness_ >= 0.0 && roundness_ <= 1.0))
        throw std::invalid_argument("aperture: the roundness must lie between 0 and 1");
    if (!std::isfinite(rotationRadians_))
        throw std::invalid_argument("aperture: the rotation must be finite");
    halfSector_ = blades_ == 0 ? 0.0 : std::numbers::pi / blades_;
    inradiusMm_ = radiusMm_ * std::cos(halfSector_);
    // Half a sector of the polygon is ½ (inradius)² tan, of the circle ½ R² (π/n).
    const double polygon = (1.0 - roundness_) * inradiusMm_ * inradiusMm_ * std::tan(halfSector_);
    const double circle = roundness_ * radiusMm_ * radiusMm_ * halfSector_;
    roundedShare_ = blades_ == 0 ? 1.0 : circle / (polygon + circle);
}

double Aperture::areaMm2() const {
    if (blades_ == 0) return std::numbers::pi * radiusMm_ * radiusMm_;
    const double polygon = inradiusMm_ * inradiusMm_ * std::tan(halfSector_);
    const double circle = radiusMm_ * radiusMm_ * halfSector_;
    return blades_ * ((1.0 - roundness_) * polygon + roundness_ * circle);
}

double Aperture::edgeSquared(double cosFromMiddle) const {
    const double straight = inradiusMm_ / cosFromMiddle;
    return (1.0 - roundness_) * straight * straight + roundness_ * radiusMm_ * radiusMm_;
}

bool Aperture::contains(const Eigen::Vector2d& pointMm) const {
    // So wide that what sample() draws on the rim lies inside in spite of rounding.
    constexpr double rim = 1.0 + 32.0 * std::numeric_limits<double>::epsilon();
    const double squared = pointMm.squaredNorm();
    if (!(squared <= radiusMm_ * radiusMm_ * rim)) return false;
    if (blades_ == 0 || squared <= inradiusMm_ * inradiusMm_) return true;
    const double angle = std::atan2(pointMm.y(), pointMm.x()) - rotationRadians_;
    const double fromCorner = std::remainder(angle, 2.0 * halfSector_);  // in [−π/n, π/n]
    return squared <= edgeSquared(std::cos(halfSector_ - std::abs(fromCorner))) * rim;
}

Eigen::Vector2d Aperture::sample(Eigen::Vector2d u) const {
    if (blades_ == 0) return radiusMm_ * sampleUnitDisc(u);
    const double scaled = u.x() * blades_;
    const double sector = std::floor(scaled);
    // Within the sector φ has a density proportional to r(φ)², a mixture of the circle's part,
    // which is constant, and the polygon's, whose distribution function is a tangent.
    const double v = scaled - sector;
    const bool fromCircle = v < roundedShare_;
    const double share = fromCircle ? roundedShare_ : 1.0 - roundedShare_;
    const double centred = 2.0 * (fromCircle ? v : v - roundedShare_) / share - 1.0;
    const double fromMiddle =
        fromCircle ? centred * halfSector_ : std::atan(centred * std::tan(halfSector_));
    const double radius = std::sqrt(u.y() * edgeSquared(std::cos(fromMiddle)));
    const double angle = rotationRadians_ + (2.0 * sector + 1.0) * halfSector_ + fromMiddle;
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace etendue
