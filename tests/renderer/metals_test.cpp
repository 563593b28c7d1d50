#include "renderer/metals.h"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

namespace etendue {

namespace {

double normalReflectance(const std::string& metal, double wavelengthNm) {
    const OpticalConstants c = opticalConstants(metal, wavelengthNm);
    return double{fresnelConductor(1.0f, static_cast<float>(c.eta), static_cast<float>(c.k))};
}

}  // namespace

TEST_CASE("Metals: reflectance at normal incidence is that of evaporated mirrors") {
    // American Institute of Physics Handbook, 3rd ed., table 6g: fresh opaque films. Other samples
    // than those whose constants are used here: films differ by up to 0.03.
    struct Reading {
        const char* metal;
        double wavelengthNm, reflectance;
    };
    for (const Reading& r : {Reading{"aluminium", 400, 0.924},
                             {"aluminium", 500, 0.918},
                             {"aluminium", 600, 0.911},
                             {"aluminium", 700, 0.897},
                             {"silver", 400, 0.956},
                             {"silver", 500, 0.979},
                             {"silver", 600, 0.986},
                             {"silver", 700, 0.989},
                             {"gold", 400, 0.387},
                             {"gold", 500, 0.477},
                             {"gold", 600, 0.919},
                             {"gold", 700, 0.970},
                             {"copper", 400, 0.475},
                             {"copper", 500, 0.600},
                             {"copper", 700, 0.975}}) {
        CAPTURE(r.metal);
        CAPTURE(r.wavelengthNm);
        CHECK(std::abs(normalReflectance(r.metal, r.wavelengthNm) - r.reflectance) < 0.03);
    }
}

TEST_CASE(
    "Metals: constants are the measured ones at the measured wavelengths, and steady between") {
    CHECK(opticalConstants("gold", 548.6).eta == doctest::Approx(0.43));
    CHECK(opticalConstants("gold", 548.6).k == doctest::Approx(2.455));
    CHECK(opticalConstants("aluminium", 619.93).k == doctest::Approx(7.4052));
    for (const std::string& metal : metalNames())
        for (double nm = 300.0; nm < 900.0; nm += 1.0) {
            const OpticalConstants a = opticalConstants(metal, nm);
            const OpticalConstants b = opticalConstants(metal, nm + 1.0);
            CHECK(a.eta > 0.0);
            CHECK(a.k > 0.0);
            CHECK(std::abs(b.eta - a.eta) < 0.02);
            CHECK(std::abs(b.k - a.k) < 0.02);
        }
    CHECK(opticalConstants("silver", 100.0).k == opticalConstants("silver", 367.9).k);
    CHECK(opticalConstants("silver", 2000.0).k == opticalConstants("silver", 821.1).k);
}

TEST_CASE("Metals: gold is yellow, copper is red, silver and aluminium are white") {
    const auto color = [](const char* metal) { return fresnelConductor(1.0f, metalOptics(metal)); };
    const Spectrum gold = color("gold"), copper = color("copper");
    CHECK(gold[0] > gold[1] + 0.1f);
    CHECK(gold[1] > gold[2] + 0.3f);
    CHECK(copper[0] > copper[1] + 0.2f);
    CHECK(copper[1] > copper[2]);
    for (const char* metal : {"silver", "aluminium"}) {
        CHECK(std::abs(color(metal)[0] - color(metal)[1]) < 0.02f);
        CHECK(std::abs(color(metal)[2] - color(metal)[1]) < 0.02f);
    }
    // The lanes cannot reflect more than the metal itself does somewhere in the visible.
    for (const std::string& metal : metalNames()) {
        double brightest = 0.0;
        for (double nm = 380.0; nm <= 780.0; nm += 1.0)
            brightest = std::max(brightest, normalReflectance(metal, nm));
        for (int lane = 0; lane < 3; ++lane)
            CHECK(double{fresnelConductor(1.0f, metalOptics(metal))[lane]} <= brightest + 1e-5);
    }
}

}  // namespace etendue
