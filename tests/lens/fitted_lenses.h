// Domains and small fits that several tests share.
#pragma once

#include "lens/lens_fit.h"
#include "lens/paraxial.h"
#include "tests/lens/prescriptions.h"

namespace etendue {

/// Focus at infinity, the stop at its tabulated opening, the sensor cut to its image circle.
inline FitDomain domainOf(const Prescription& prescription, Eigen::Vector2d sensorHalfSizeMm,
                          double imageRadiusMm = std::numeric_limits<double>::infinity()) {
    const OpticalSystem system(prescription);
    FitDomain domain{};
    domain.sensorHalfSizeMm = sensorHalfSizeMm;
    domain.imageRadiusMm = imageRadiusMm;
    domain.sensorDistanceMm =
        sensorDistanceMm(paraxialData(system), std::numeric_limits<double>::infinity());
    domain.apertureRadiusMm = system.aperture.radiusMm();
    domain.shortestWavelengthNm = 400.0;
    domain.longestWavelengthNm = 700.0;
    return domain;
}

inline Prescription doubleGauss() { return loadPrescription(lensFile("double-gauss-100mm.toml")); }
inline FitDomain doubleGaussDomain() { return domainOf(doubleGauss(), {18.0, 12.0}); }

/// Quick, and good enough for most questions.
inline FitSettings smallSettings() {
    FitSettings settings;
    settings.terms = 12;
    settings.degree = 5;
    settings.refinements = 1;
    settings.clip = {8, 4, 1000};
    return settings;
}

}  // namespace etendue
