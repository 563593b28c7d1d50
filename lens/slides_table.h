// The published accuracy table of sparse lens polynomials, measured again, and ours beside it.
//
// Its error is the sum over four outputs of the mean squared residual, x and y in mm² and the
// direction's components in sine², on the training rays themselves: from the sensor to the pupil
// sphere, transmittance left out. Rays start anywhere on a sensor of 35 × 35 mm at its tabulated
// place and aim anywhere on the rear element, at 400 to 700 nm; of these 15,000 pass.
#pragma once

#include <array>
#include <memory>
#include <string_view>
#include <vector>

#include "lens/prescription.h"

namespace etendue {

/// Taylor: all monomials up to a degree that the lens' mirror planes allow; complete: all there
/// are; sparse: the most useful of degree 11. A choice of its own for each output.
enum class SlidesMethod { taylor, complete, sparse };

struct SlidesRow {
    SlidesMethod method;
    int degree;                       // of taylor and complete
    int coefficients;                 // of an equation
    std::array<double, 4> published;  // of slidesLenses
};
const std::vector<SlidesRow>& slidesRows();

/// Files of scenes/lenses, in the order of the published columns.
inline constexpr std::array<std::string_view, 4> slidesLenses{
    "fisheye-10mm", "fisheye-181-10mm", "anamorphic-80x90mm", "double-gauss-100mm"};

struct SlidesResult {
    double again;       // the row's own method, by this library's fit
    double twoPoint;    // (s, a, λ) in the basis of the lens' symmetry, on the same rays
    int multiplyAdds;   // of the row's method
    int twoPointTerms;  // as many as cost no more
    int twoPointMultiplyAdds;
};

/// The rays of one lens, drawn once for all rows.
class SlidesMeasurement {
public:
    explicit SlidesMeasurement(const Prescription& prescription, std::size_t rays = 15'000);
    SlidesResult measure(const SlidesRow& row) const;

private:
    struct Rays;
    std::shared_ptr<const Rays> rays_;
    bool isAxial_;
};

}  // namespace etendue
