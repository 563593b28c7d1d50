#include "lens/distortion.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/lens/prescriptions.h"

namespace etendue {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

/// Rays of a lens that maps (x, y), the direction's tangents, to `picture`(x, y), mm, upright.
template <class Picture>
std::vector<FieldRay> raysOf(double widestDegrees, const Picture& picture) {
    std::vector<FieldRay> rays;
    for (double angle = 0.0; angle <= widestDegrees; angle += widestDegrees / 12.0)
        for (double turn = 3.0; turn < 360.0; turn += 15.0) {
            const double across = std::sin(angle * degree);
            const Eigen::Vector3d direction(across * std::cos(turn * degree),
                                            across * std::sin(turn * degree),
                                            std::cos(angle * degree));
            rays.push_back({-picture(direction), direction});
        }
    return rays;
}

/// The pinhole with a plate of nothing in front of it.
TracedLens emptyLens(double sensorDistanceMm) {
    const double infinity = std::numeric_limits<double>::infinity();
    Prescription lens = singlet(infinity, infinity, 1.0, 1.0, 200.0);
    lens.surfaces.pop_back();
    lens.surfaces.push_back(stop(1.0, 1.0));
    return TracedLens(lens, Aperture(1.0), sensorDistanceMm);
}

TEST_CASE("fitPinhole: a rectilinear lens has no distortion, and known coefficients are found") {
    const auto ideal = fitPinhole(raysOf(40.0, [](const Eigen::Vector3d& d) -> Eigen::Vector2d {
        return 35.0 * d.head<2>() / d.z();
    }));
    REQUIRE(ideal.has_value());
    CHECK((ideal->focalLengthMm - Eigen::Vector2d(35.0, 35.0)).norm() < 1e-9);
    for (const double k : {ideal->k1, ideal->k2, ideal->p1, ideal->p2, ideal->k3})
        CHECK(std::abs(k) < 1e-10);
    CHECK(ideal->residual.mostMm < 1e-10);

    const auto bent = fitPinhole(raysOf(40.0, [](const Eigen::Vector3d& d) -> Eigen::Vector2d {
        const double x = d.x() / d.z(), y = d.y() / d.z(), r2 = x * x + y * y;
        const double radial = 1.0 - 0.2 * r2 + 0.05 * r2 * r2 - 0.01 * r2 * r2 * r2;
        return {30.0 * (x * radial + 2.0 * 1e-3 * x * y - 2e-3 * (r2 + 2.0 * x * x)),
                36.0 * (y * radial + 1e-3 * (r2 + 2.0 * y * y) - 2.0 * 2e-3 * x * y)};
    }));
    REQUIRE(bent.has_value());
    CHECK((bent->focalLengthMm - Eigen::Vector2d(30.0, 36.0)).norm() < 1e-8);
    CHECK(bent->k1 == doctest::Approx(-0.2).epsilon(1e-8));
    CHECK(bent->k2 == doctest::Approx(0.05).epsilon(1e-8));
    CHECK(bent->k3 == doctest::Approx(-0.01).epsilon(1e-8));
    CHECK(bent->p1 == doctest::Approx(1e-3).epsilon(1e-8));
    CHECK(bent->p2 == doctest::Approx(-2e-3).epsilon(1e-8));
}

TEST_CASE("fitFisheye: an f-theta lens has no distortion, and known coefficients are found") {
    const auto mapped = [](double k1, double k4) {
        return [=](const Eigen::Vector3d& d) -> Eigen::Vector2d {
            const double across = d.head<2>().norm(), theta = std::atan2(across, d.z());
            if (across == 0.0) return {0.0, 0.0};
            const double t2 = theta * theta;
            return 8.0 * theta * (1.0 + k1 * t2 + k4 * t2 * t2 * t2 * t2) * d.head<2>() / across;
        };
    };
    const auto ideal = fitFisheye(raysOf(110.0, mapped(0.0, 0.0)));
    REQUIRE(ideal.has_value());
    CHECK((ideal->focalLengthMm - Eigen::Vector2d(8.0, 8.0)).norm() < 1e-9);
    for (const double k : ideal->k) CHECK(std::abs(k) < 1e-10);

    const auto bent = fitFisheye(raysOf(110.0, mapped(-0.04, 2e-4)));
    REQUIRE(bent.has_value());
    CHECK(bent->k[0] == doctest::Approx(-0.04).epsilon(1e-7));
    CHECK(bent->k[3] == doctest::Approx(2e-4).epsilon(1e-6));
    CHECK(bent->residual.mostMm < 1e-10);
}

TEST_CASE("fitPinhole: tangents end at 90 degrees, and two rays are no calibration") {
    const auto wide =
        raysOf(100.0, [](const Eigen::Vector3d& d) -> Eigen::Vector2d { return d.head<2>(); });
    CHECK_FALSE(fitPinhole(wide).has_value());
    CHECK_FALSE(fitFisheye(std::span(wide).first(2)).has_value());
}

TEST_CASE("distortionCurve: a pinhole is rectilinear, and tan θ/θ off from equidistant") {
    const TracedLens lens = emptyLens(50.0);
    const auto curve = distortionCurve(lens, Eigen::Vector2d::UnitY(), 40.0, 8);
    REQUIRE(curve.size() == 8);
    for (const DistortionPoint& point : curve) {
        const double angle = point.fieldDegrees * degree;
        CHECK(std::tan(angle) == doctest::Approx(point.heightMm / 50.0));
        // The slope at the axis is taken at 1/1000 of the height, where θ is 2e-7 below tan θ.
        CHECK(std::abs(point.rectilinearPercent) < 1e-4);
        CHECK(point.equidistantPercent ==
              doctest::Approx(100.0 * (std::tan(angle) / angle - 1.0)).epsilon(1e-4));
    }
}

TEST_CASE("fitFisheye: the models describe the lenses that they are made for") {
    const auto residuals = [](const char* file, double halfSize) {
        const auto lens = makeTracedLens(loadPrescription(lensFile(file)));
        const auto rays = chiefRays(*lens, {halfSize, halfSize}, halfSize);
        return std::pair(fitPinhole(rays), fitFisheye(rays));
    };
    const auto [tessarPinhole, tessarFisheye] = residuals("tessar-100mm.toml", 20.0);
    REQUIRE(tessarPinhole.has_value());
    CHECK(tessarPinhole->residual.mostMm < 1e-5);
    CHECK(tessarPinhole->focalLengthMm.x() == doctest::Approx(100.0).epsilon(1e-3));
    CHECK(std::abs(tessarPinhole->p1) < 1e-9);  // it is symmetric
    const auto [fisheyePinhole, fisheyeFisheye] = residuals("fisheye-220-6mm-f2.8.toml", 11.0);
    CHECK_FALSE(fisheyePinhole.has_value());
    REQUIRE(fisheyeFisheye.has_value());
    CHECK(fisheyeFisheye->residual.mostMm < 0.05);
}

}  // namespace
}  // namespace etendue
