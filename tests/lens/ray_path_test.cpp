#include "lens/ray_path.h"

#include <doctest/doctest.h>

#include <numbers>

#include "tests/lens/prescriptions.h"

namespace etendue {
namespace {

TEST_CASE("objectPoint: it is on the plane across the axis, and the chief ray leads there") {
    const auto lens =
        makeTracedLens(loadPrescription(lensFile("tessar-100mm.toml")), {2.81, {}, 2000.0});
    const SensorPoint sensor{{5.0, -12.0}};
    const std::optional<Eigen::Vector3d> point = objectPoint(*lens, sensor, 2000.0);
    REQUIRE(point.has_value());
    CHECK(point->z() == doctest::Approx(lens->sensorZMm() + 2000.0).epsilon(1e-12));
    const std::optional<SensorPoint> found = lens->connect(*point, {{0.0, 0.0}}, dLineNm);
    REQUIRE(found.has_value());
    CHECK((found->mm - sensor.mm).norm() < 1e-6);
}

TEST_CASE("clearFan: its ends pass and what is a little farther out is blocked") {
    const auto lens = makeTracedLens(loadPrescription(lensFile("petzval-50mm.toml")));
    const MonochromaticLens atLine(*lens, dLineNm);
    const Eigen::Vector2d along = Eigen::Vector2d::UnitY();
    const auto target = objectPoint(*lens, {{0.0, -16.0}}, std::numeric_limits<double>::infinity());
    REQUIRE(target.has_value());
    const std::vector<AperturePoint> fan = clearFan(*lens, atLine, *target, along, 5);
    REQUIRE(fan.size() == 5);
    const double radius = lens->system().aperture.radiusMm();
    const double width = fan.back().mm.y() - fan.front().mm.y();
    CHECK(width > 0.1 * radius);
    CHECK(width < 1.5 * radius);  // vignetted
    const double beyond = 1e-3 * radius;
    CHECK(atLine.connect(*target, fan.front()).has_value());
    CHECK(atLine.connect(*target, fan.back()).has_value());
    CHECK_FALSE(atLine.connect(*target, {fan.front().mm - beyond * along}).has_value());
    CHECK_FALSE(atLine.connect(*target, {fan.back().mm + beyond * along}).has_value());
}

TEST_CASE(
    "rayPath: it starts on the sensor, crosses the stop where asked and ends toward the target") {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const auto lens = makeTracedLens(load(shipped));
        const MonochromaticLens atLine(*lens, fLineNm);
        const double radius = lens->system().aperture.radiusMm();
        const AperturePoint aperture{{0.1 * radius, -0.2 * radius}};
        const auto target = objectPoint(*lens, {{0.3 * shipped.imageHeightMm, 0.0}},
                                        std::numeric_limits<double>::infinity());
        REQUIRE(target.has_value());
        const std::optional<RayPath> path = rayPath(*lens, atLine, *target, aperture);
        REQUIRE(path.has_value());
        const OpticalSystem& system = lens->system();
        REQUIRE(path->pointsMm.size() == system.surfaces.size() + 1);
        CHECK(path->pointsMm.front().z() == lens->sensorZMm());
        const Eigen::Vector3d& atStop = path->pointsMm[path->pointsMm.size() - 1 - system.stop];
        CHECK((atStop.head<2>() - aperture.mm).norm() < 1e-6 * radius);
        const Eigen::Vector3d toTarget = (*target - path->pointsMm.back()).normalized();
        CHECK((toTarget - path->direction).norm() < 1e-8);
    }
}

TEST_CASE("middleRay: where no ray crosses the middle of the stop it goes through what passes") {
    const auto lens = makeTracedLens(loadPrescription(lensFile("anamorphic-80x90mm.toml")));
    const MonochromaticLens atLine(*lens, dLineNm);
    const SensorPoint corner{{0.0, -17.0}};
    REQUIRE_FALSE(atLine.chiefRay(corner).has_value());
    CHECK(middleRay(*lens, atLine, corner).has_value());
    CHECK_FALSE(middleRay(*lens, atLine, {{0.0, -60.0}}).has_value());
    // Nor does one count that a rim blocks.
    const SensorPoint vignetted{{0.0, -10.0}};
    const auto chief = atLine.chiefRay(vignetted), middle = middleRay(*lens, atLine, vignetted);
    REQUIRE(chief.has_value());
    REQUIRE_FALSE(atLine.trace(vignetted, {{0.0, 0.0}}).has_value());
    REQUIRE(middle.has_value());
    CHECK((middle->origin - chief->origin).norm() > 1.0);
}

}  // namespace
}  // namespace etendue
