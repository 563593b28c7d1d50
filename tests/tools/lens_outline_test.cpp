#include "tools/lens_outline.h"

#include <doctest/doctest.h>

#include <cmath>

#include "tests/lens/prescriptions.h"

using namespace etendue;

namespace {

double area(const std::vector<SectionPoint>& outline) {
    double sum = 0.0;
    for (std::size_t i = 0; i < outline.size(); ++i) {
        const SectionPoint &a = outline[i], &b = outline[(i + 1) % outline.size()];
        sum += 0.5 * (a.x() * b.y() - b.x() * a.y());
    }
    return std::abs(sum);
}

}  // namespace

TEST_CASE("glassElements: a plate is a rectangle") {
    const Prescription plate = singlet(INFINITY, INFINITY, 5.0, 1.5, 10.0);
    const auto elements = glassElements(OpticalSystem(plate), SectionPlane::yz);
    REQUIRE(elements.size() == 1);
    CHECK(elements[0].index == doctest::Approx(1.5));
    CHECK(area(elements[0].outline) == doctest::Approx(5.0 * 20.0));
}

TEST_CASE("glassElements: the smaller face of a pair is framed by a flat") {
    Prescription lens = singlet(INFINITY, INFINITY, 5.0, 1.5, 10.0);
    lens.surfaces[1].semiApertureMm = 6.0;
    const auto elements = glassElements(OpticalSystem(lens), SectionPlane::yz);
    CHECK(area(elements[0].outline) == doctest::Approx(5.0 * 20.0));
}

TEST_CASE("surfaceProfile: a circle is on its circle, and a cylinder straight in one plane") {
    Prescription lens = singlet(30.0, INFINITY, 5.0, 1.5, 10.0);
    for (const SectionPoint& point :
         surfaceProfile(OpticalSystem(lens).surfaces[0], SectionPlane::yz))
        CHECK((point - SectionPoint(30.0, 0.0)).norm() == doctest::Approx(30.0));
    lens.surfaces[0].kind = SurfaceKind::cylinderX;
    const OpticalSystem system(lens);
    for (const SectionPoint& point : surfaceProfile(system.surfaces[0], SectionPlane::yz))
        CHECK(point.x() == doctest::Approx(0.0));
    CHECK(surfaceProfile(system.surfaces[0], SectionPlane::xz).back().x() > 1.0);
}

TEST_CASE("glassElements: every glass of every lens is drawn once, and covers an area") {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Prescription lens = load(shipped);
        const OpticalSystem system(lens);
        std::size_t glasses = 0;
        for (const Surface& surface : lens.surfaces)
            glasses += std::holds_alternative<Air>(surface.behind) ? 0 : 1;
        const auto elements = glassElements(system, SectionPlane::yz);
        CHECK(elements.size() == glasses);
        for (const GlassElement& element : elements) CHECK(area(element.outline) > 1.0);
    }
}
