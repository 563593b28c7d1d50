#include "lens/field_curvature.h"

#include <doctest/doctest.h>

#include <cmath>

#include "lens/ray_path.h"
#include "tests/lens/prescriptions.h"

namespace etendue {
namespace {

constexpr double farAway = std::numeric_limits<double>::infinity();

/// Wide open, its sensor so far behind the last vertex.
TracedLens lensWithSensorAt(const Prescription& prescription, double sensorDistanceMm) {
    return TracedLens(prescription, OpticalSystem(prescription).aperture, sensorDistanceMm);
}

/// Σ (n′ − n) / (n n′ R): the curvature at which a lens without astigmatism pictures a plane.
double petzvalSum(const OpticalSystem& system) {
    const std::vector<double> indices = refractiveIndices(system, dLineNm);
    double sum = 0.0;
    // In lens space the curvature has the opposite sign.
    for (std::size_t i = 0; i < system.surfaces.size(); ++i)
        sum -= (indices[i + 1] - indices[i]) / (indices[i] * indices[i + 1]) *
               system.surfaces[i].shape.curvature;
    return sum;
}

TEST_CASE("pencilFocus: on the axis both are the paraxial focus") {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Prescription prescription = load(shipped);
        const ParaxialData data = paraxialData(OpticalSystem(prescription));
        const double distance = data.y.backFocalDistanceMm + 0.3;
        const TracedLens lens = lensWithSensorAt(prescription, distance);
        for (const int axis : {0, 1}) {
            const PencilFocus focus = pencilFocus(lens, Eigen::Vector2d::Unit(axis), 0.0, farAway);
            const ParaxialAxis& along = axis == 0 ? data.x : data.y;
            const ParaxialAxis& across = axis == 0 ? data.y : data.x;
            // Infinity is 1000 km, which moves the focus by f²/1e9 mm: 2e-5 mm at f = 143 mm.
            CHECK(std::abs(focus.tangentialMm - (distance - along.backFocalDistanceMm)) < 3e-5);
            CHECK(std::abs(focus.sagittalMm - (distance - across.backFocalDistanceMm)) < 3e-5);
        }
    }
}

TEST_CASE("pencilFocus: a thin lens at the stop has the textbook's astigmatism") {
    constexpr double index = 1.5, focalLength = 60.0, height = 0.6;
    Prescription prescription = singlet(60.0, -60.0, 0.01, index, 0.5);
    prescription.surfaces[1].thicknessMm = 0.01;
    const TracedLens lens = lensWithSensorAt(prescription, focalLength);
    const double sag = height * height / (2.0 * focalLength);
    const auto isClose = [&](double shift, double expected) {
        // The fifth order is (height/f)² = 1e-4 of the third, the lens' thickness and its distance
        // from the stop 2e-4 of its focal length.
        return std::abs(shift - expected) < 1e-3 * expected;
    };
    for (const Eigen::Vector2d& along :
         {Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 1.0), Eigen::Vector2d(0.6, -0.8)}) {
        const PencilFocus focus = pencilFocus(lens, along, height, farAway),
                          axis = pencilFocus(lens, along, 0.0, farAway);
        CHECK(isClose(focus.tangentialMm - axis.tangentialMm, sag * (3.0 + 1.0 / index)));
        CHECK(isClose(focus.sagittalMm - axis.sagittalMm, sag * (1.0 + 1.0 / index)));
    }
}

TEST_CASE("pencilFocus: tangential and sagittal focus stand 3 to 1 from Petzval's surface") {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Prescription prescription = load(shipped);
        if (isAnamorphic(prescription)) continue;
        const auto lens = makeTracedLens(prescription);
        const double height = lens->focalLengthMm() / 200.0;
        const Eigen::Vector2d along(0.6, 0.8);
        const PencilFocus focus = pencilFocus(*lens, along, height, farAway),
                          axis = pencilFocus(*lens, along, 0.0, farAway);
        const double tangential = focus.tangentialMm - axis.tangentialMm,
                     sagittal = focus.sagittalMm - axis.sagittalMm;
        const double petzval = 0.5 * height * height * petzvalSum(lens->system());
        // The fifth order is (height/f)² = 2.5e-5 of the third, times what lenses have it larger.
        CHECK(std::abs(0.5 * (3.0 * sagittal - tangential) - petzval) <
              1e-3 * (std::abs(sagittal) + std::abs(tangential)));
    }
}

TEST_CASE("pencilFocus: off the axis it is where close rays cross") {
    const auto lens =
        makeTracedLens(loadPrescription(lensFile("tessar-100mm.toml")), {{}, {}, 2e3});
    const MonochromaticLens atLine(*lens, dLineNm);
    const Eigen::Vector2d along(0.8, 0.6), across(-0.6, 0.8);
    for (const double height : {5.0, 20.0}) {
        const PencilFocus focus = pencilFocus(*lens, along, height, 2e3);
        const auto target = objectPoint(*lens, {height * along}, 2e3);
        REQUIRE(target.has_value());
        const auto crossing = [&](const Eigen::Vector2d& axis) {
            const AperturePoint up{0.15 * axis}, down{-0.15 * axis};  // 1/100 of the stop's radius
            const auto s = atLine.connect(*target, up), t = atLine.connect(*target, down);
            REQUIRE(s.has_value());
            REQUIRE(t.has_value());
            const auto p = atLine.slopeThrough(*s, up), q = atLine.slopeThrough(*t, down);
            REQUIRE(p.has_value());
            REQUIRE(q.has_value());
            return -(s->mm - t->mm).dot(axis) / (*p - *q).dot(axis);
        };
        // Aberrations of the third order, some millimetres at the rim, are 1e-4 of that so close to
        // the middle; the solves' 1e-7 mm at a crossing angle of 1/300 are 3e-5 mm.
        CHECK(std::abs(focus.tangentialMm - crossing(along)) < 3e-4);
        CHECK(std::abs(focus.sagittalMm - crossing(across)) < 3e-4);
    }
}

TEST_CASE("pencilFocus: none where the chief ray is blocked") {
    const auto lens = makeTracedLens(loadPrescription(lensFile("anamorphic-80x90mm.toml")));
    const Eigen::Vector2d along = Eigen::Vector2d::UnitY();
    CHECK(std::isfinite(pencilFocus(*lens, along, 5.0, farAway).tangentialMm));
    CHECK(std::isnan(pencilFocus(*lens, along, 7.2, farAway).tangentialMm));
    CHECK(std::isnan(pencilFocus(*lens, along, 7.2, farAway).sagittalMm));
}

}  // namespace
}  // namespace etendue
