#include "lens/prescription.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "config/config.h"
#include "lens/paraxial.h"
#include "lens/prescription_check.h"
#include "tests/lens/prescriptions.h"
#include "tests/support/temporary_folder.h"

namespace etendue {
namespace {

const std::string header =
    "name = \"test\"\n"                   // line 1
    "source = \"none\"\n"                 // 2
    "focal_length_mm = 100.0\n"           // 3
    "back_focal_distance_mm = 94.3192\n"  // 4
    "f_number = 5.27\n";                  // 5
const std::string front =                 // line 7, surface[0]
    "{ radius_mm = 100, thickness_mm = 5, nd = 1.5, vd = 60, semi_aperture_mm = 10 },\n";
const std::string rear =  // line 8, surface[1]
    "{ radius_mm = -98.3051, thickness_mm = 4, semi_aperture_mm = 10 },\n";
const std::string iris =  // line 9, surface[2]
    "{ type = \"stop\", thickness_mm = 94, semi_aperture_mm = 9 },\n";

std::string table(const std::string& surfaces) {
    return header + "surface = [\n" + surfaces + "]\n";
}

Prescription loaded(const std::string& text, const std::string& zoom = {}) {
    const TemporaryFolder folder;
    writeFile(folder / "lens.toml", text);
    return loadPrescription(folder / "lens.toml", zoom);
}

/// what() of the error, its folder cut away; empty when there is none.
std::string errorOf(const std::string& text, const std::string& zoom = {}) {
    try {
        loaded(text, zoom);
    } catch (const InputError& error) {
        const std::string message = error.what();
        return message.substr(message.find("lens.toml"));
    }
    return "";
}

/// `text` with the first `from` replaced.
std::string with(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

bool has(const std::string& text, const std::string& part) {
    if (text.find(part) != std::string::npos) return true;
    MESSAGE(text);
    return false;
}

const std::string sound = table(front + rear + iris);

TEST_CASE("Prescription: every lens that ships is what its header states") {
    for (const ShippedLens& shipped : shippedLenses()) {
        CAPTURE(shipped.file);
        const Prescription prescription = load(shipped);
        CHECK_FALSE(findFault(prescription));
        CHECK_FALSE(findContradiction(prescription));
        CHECK(prescription.source.size() > 10);
        CHECK(prescription.zoomPosition == shipped.zoomPosition);
    }
}

TEST_CASE("Prescription: a sound table loads, with all that it says") {
    const Prescription lens = loaded(sound);
    CHECK(lens.name == "test");
    CHECK(lens.surfaces.size() == 3);
    CHECK(stopIndex(lens) == 2);
    CHECK(lengthMm(lens) == 9.0);
    CHECK(lens.surfaces[1].radiusMm == -98.3051);
    CHECK(refractiveIndex(lens.surfaces[0].behind, dLineNm) == doctest::Approx(1.5));
    CHECK_FALSE(isAnamorphic(lens));
}

TEST_CASE("Prescription: every way to name a medium and every kind of surface") {
    const Prescription lens = loaded(with(
        table("{ type = \"conic\", radius_mm = 100, conic = 0, thickness_mm = 5, "
              "glass = \"N-BK7\", semi_aperture_mm = 10, coating = { index = 1.4 } },\n"
              "{ type = \"aspheric\", radius_mm = -105.137, a4 = 1e-9, a16 = 1e-30, thickness_mm = "
              "1, semi_aperture_mm = 10 },\n"
              "{ type = \"planar\", thickness_mm = 1, sellmeier = [1.03961212, 0.231792344, "
              "1.01046945, 0.00600069867, 0.0200179144, 103.560653], semi_aperture_mm = 10 },\n"
              "{ radius_mm = inf, thickness_mm = 2, semi_aperture_mm = 10 },\n" +
              iris),
        "94.3192", "94.6396"));
    CHECK(lens.surfaces[0].kind == SurfaceKind::conic);
    REQUIRE(lens.surfaces[0].coating.has_value());
    CHECK(lens.surfaces[0].coating->index == 1.4);
    CHECK(lens.surfaces[0].coating->thicknessWaves == 0.25);
    CHECK(lens.surfaces[1].asphere[0] == 1e-9);
    CHECK(lens.surfaces[1].asphere[6] == 1e-30);
    CHECK(refractiveIndex(lens.surfaces[0].behind, 480.0) ==
          refractiveIndex(lens.surfaces[2].behind, 480.0));
    CHECK(std::isinf(lens.surfaces[2].radiusMm));
}

TEST_CASE("Prescription: degenerate surfaces are refused by file, line and surface") {
    const auto changed = [](const std::string& from, const std::string& to) {
        return errorOf(with(sound, from, to));
    };
    const std::string first = "lens.toml:7: surface[0].";
    CHECK(has(changed("radius_mm = 100", "radius_mm = 0"), first + "radius_mm"));
    CHECK(has(changed("radius_mm = 100", "radius_mm = nan"), first + "radius_mm"));
    CHECK(has(changed("thickness_mm = 5", "thickness_mm = inf"), first + "thickness_mm"));
    CHECK(has(changed("thickness_mm = 5", "thickness_mm = nan"), first + "thickness_mm"));
    CHECK(has(changed("semi_aperture_mm = 10", "semi_aperture_mm = 0"), first + "semi_aperture"));
    CHECK(has(changed("semi_aperture_mm = 10", "semi_aperture_mm = -1"), first + "semi_aperture"));
    CHECK(has(changed("nd = 1.5", "nd = 0.9"), first + "nd"));
    CHECK(has(changed("vd = 60", "vd = -60"), first + "vd"));
    CHECK(has(changed("nd = 1.5, vd = 60", "glass = \"N-BK8\""), "did you mean \"N-BK7\"?"));
    CHECK(has(changed("nd = 1.5", "glass = \"N-BK7\", nd = 1.5"), "lens.toml:7: surface[0]"));
    CHECK(has(changed("nd = 1.5, vd = 60", "sellmeier = [1, 0, 0, 0.25, 0, 0]"),
              first + "sellmeier: no glass"));
    CHECK(has(changed("radius_mm = 100", "radius_mm = 100, conic = 1"), first + "conic"));
    CHECK(has(changed("radius_mm = 100", "radius = 100"), "lens.toml:7: surface[0].radius"));
    CHECK(has(changed("nd = 1.5", "coating = { index = 0.9 }, nd = 1.5"), "coating.index"));
}

TEST_CASE("Prescription: a semi-aperture beyond the sphere is refused with the sphere's end") {
    const std::string error = errorOf(with(sound, "radius_mm = 100", "radius_mm = 9"));
    CHECK(has(error, "lens.toml:7: surface[0].semi_aperture_mm"));
    CHECK(has(error, "ends at 9 mm"));
}

TEST_CASE("Prescription: surfaces that cross within their semi-apertures are refused") {
    const std::string negative = errorOf(with(sound, "thickness_mm = 5", "thickness_mm = -5"));
    CHECK(has(negative, "lens.toml:7: surface[0].thickness_mm"));
    CHECK(has(negative, "surface[0] and surface[1], -5 mm apart on the axis, cross by"));
    // Positive on the axis, but the rims of the biconvex element, 1 mm thick, meet.
    const std::string thin = errorOf(with(sound, "thickness_mm = 5", "thickness_mm = 1"));
    CHECK(has(thin, "lens.toml:7: surface[0].thickness_mm"));
}

TEST_CASE("Prescription: a stop may lie within the hollow of a surface") {
    // Here 1 mm in front of the rear vertex: the stop is no body.
    const std::string inside =
        with(with(with(sound, "thickness_mm = 4", "thickness_mm = -1"), "94.3192", "99.3192"),
             "5.27", "5.51");
    CHECK(errorOf(inside) == "");
}

TEST_CASE("Prescription: a lens has one stop and something that bends light") {
    CHECK(has(errorOf(table(front + rear)), "no stop"));
    CHECK(has(errorOf(table(front + rear + iris + iris)),
              "lens.toml:10: surface[3].type: a second stop; the first is surface[2]"));
    CHECK(has(errorOf(table(iris)), "nothing but a stop"));
    CHECK(has(errorOf(table("")), "lens.toml:"));
    CHECK(has(errorOf(header), "surface"));
    CHECK(has(errorOf(table(front + iris)), "lens.toml:8: surface[1]: behind the last"));
    CHECK(has(errorOf(table(iris + with(front, "nd = 1.5, vd = 60", "glass = \"N-BK7\""))),
              "surface[1].glass: behind the last surface there must be air"));
}

TEST_CASE("Prescription: numbers that are none are refused by name, heights that are none too") {
    const auto faultOf = [](const auto& change) {
        Prescription lens = singlet(50.0, -50.0, 5.0, 1.5, 10.0);
        change(lens);
        const auto fault = findFault(lens);
        return fault ? fault->key : std::string("none");
    };
    CHECK(faultOf([](Prescription&) {}) == "none");
    CHECK(faultOf([](Prescription& p) { p.surfaces[0].conic = std::nan(""); }) == "conic");
    CHECK(faultOf([](Prescription& p) { p.surfaces[0].asphere[2] = HUGE_VAL; }) == "a8");
    // Both surfaces overflow: how far they are apart is inf − inf.
    CHECK(faultOf([](Prescription& p) {
              p.surfaces[0].asphere[6] = p.surfaces[1].asphere[6] = 1e300;
          }) == "semi_aperture_mm");
}

TEST_CASE("Prescription: a header that the table contradicts is refused with both numbers") {
    const std::string focal = errorOf(with(sound, "100.0", "103.0"));
    CHECK(has(focal,
              "lens.toml:3: focal_length_mm: the header states 103 mm, the table gives 99.98"));
    const std::string back = errorOf(with(sound, "94.3192", "97.0"));
    CHECK(has(back, "lens.toml:4: back_focal_distance_mm: the header states 97 mm"));
    const std::string number = errorOf(with(sound, "5.27", "4.0"));
    CHECK(has(number, "lens.toml:5: f_number: the header states 4, the table gives 5.2"));
    CHECK(has(number, "surface[2].semi_aperture_mm limits"));
}

TEST_CASE("Prescription: a misprint is traced to its surface") {
    Prescription lens = load({"double-gauss-100mm.toml", 0.0});
    const auto complaint = [&] {
        const auto contradiction = findContradiction(lens);
        REQUIRE(contradiction.has_value());
        return contradiction->message;
    };
    lens.surfaces[3].radiusMm = 27.04;  // for 20.74
    CHECK(has(complaint(), "surface[3].radius_mm were 20.74"));
    lens.surfaces[3].radiusMm = 20.74;
    lens.surfaces[9].radiusMm *= -1.0;
    CHECK(has(complaint(), "surface[9].radius_mm were -59."));
    lens.surfaces[9].radiusMm *= -1.0;
    lens.surfaces[3].thicknessMm = 21.03;  // for 12.03
    CHECK(has(complaint(), "surface[3].thickness_mm were 12.0"));
    lens.surfaces[3].thicknessMm = 12.03;
    lens.surfaces[8].behind = glassFromAbbeNumber(1.5706, 27.8);  // for 1.7506
    CHECK(has(complaint(), "surface[8].nd were 1.75"));
}

TEST_CASE("Prescription: zoom positions have their own thicknesses and headers") {
    const Prescription wide = load({"zoom-57-143mm.toml", 0.0, "57 mm"});
    const Prescription tele = load({"zoom-57-143mm.toml", 0.0, "143 mm"});
    CHECK(wide.surfaces[4].thicknessMm == 1.86);
    CHECK(tele.surfaces[4].thicknessMm == 48.678);
    CHECK(loadPrescriptions(lensFile("zoom-57-143mm.toml")).size() == 2);
    CHECK(contentHash(wide) != contentHash(tele));
    CHECK_THROWS_AS(load({"zoom-57-143mm.toml", 0.0, "100 mm"}), InputError);
    CHECK(has(errorOf(sound, "wide"), "no zoom position \"wide\""));
    CHECK(has(errorOf(with(sound, "thickness_mm = 5", "thickness_mm = [5, 6]")),
              "lens.toml:7: surface[0].thickness_mm"));
}

TEST_CASE("Prescription: a missing file has its own exit code") {
    try {
        loadPrescription(lensFile("no-such-lens.toml"));
        FAIL("loaded");
    } catch (const InputError& error) {
        CHECK(error.code() == ExitCode::missingFile);
    }
}

TEST_CASE("Prescription: the hash tells lenses apart and looks at nothing but optics") {
    std::set<std::uint64_t> hashes;
    for (const ShippedLens& shipped : shippedLenses()) hashes.insert(contentHash(load(shipped)));
    CHECK(hashes.size() == shippedLenses().size());

    const Prescription lens = loaded(sound);
    Prescription other = lens;
    other.name = "another";
    other.notes = "a note";
    other.stated.fNumber = 17.0;
    CHECK(contentHash(other) == contentHash(lens));
    // FNV-1a over bytes in a stated order: the same number for ever.
    Prescription plain = singlet(50.0, -50.0, 4.0, 1.5, 10.0);
    CHECK(contentHash(plain) == contentHash(singlet(50.0, -50.0, 4.0, 1.5, 10.0)));
    const auto differs = [&](auto change) {
        Prescription changed = lens;
        change(changed.surfaces[0]);
        return contentHash(changed) != contentHash(lens);
    };
    CHECK(differs([](Surface& s) { s.radiusMm = std::nextafter(s.radiusMm, 0.0); }));
    CHECK(differs([](Surface& s) { s.thicknessMm += 1e-12; }));
    CHECK(differs([](Surface& s) { s.semiApertureMm += 1e-12; }));
    CHECK(differs([](Surface& s) { s.kind = SurfaceKind::cylinderX; }));
    CHECK(differs([](Surface& s) { s.conic = 1e-9; }));
    CHECK(differs([](Surface& s) { s.asphere[6] = 1e-30; }));
    CHECK(differs([](Surface& s) { s.behind = plainGlass(1.5); }));
    CHECK(differs([](Surface& s) { s.coating = Coating{}; }));
    Prescription coated = lens, recoated = lens;
    coated.surfaces[0].coating = Coating{};
    recoated.surfaces[0].coating = Coating{1.38, 551.0, 0.25};
    CHECK(contentHash(coated) != contentHash(recoated));
}

TEST_CASE("Prescription: a scaled lens has scaled distances and the same f-number") {
    for (const double factor : {1e-3, 0.24, 1e3})
        for (const ShippedLens& shipped : shippedLenses()) {
            const Prescription lens = scaled(load(shipped), factor);
            CAPTURE(shipped.file);
            CHECK_FALSE(findFault(lens));
            CHECK_FALSE(findContradiction(lens));
        }
}

}  // namespace
}  // namespace etendue
