#include "lens/lens_trade.h"

#include <algorithm>
#include <chrono>

#include "lens/connect_survey.h"
#include "lens/polynomial.h"
#include "lens/polynomial_lens.h"
#include "lens/thread_time.h"

namespace etendue {

namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// A ray that the fitted lens traces, and a point on it.
struct Aim {
    FitQuery query;
    Eigen::Vector3d target;
};

std::vector<Aim> aimsOf(const PolynomialLens& lens, std::size_t count) {
    constexpr std::uint64_t seed = 6, mostDrawn = 200;
    constexpr double distanceMm = 2000.0;
    std::vector<Aim> aims;
    for (std::uint64_t i = 0; aims.size() < count && i < mostDrawn * count; ++i) {
        const FitQuery query = drawQuery(lens.domain(), seed, i);
        if (const auto ray = lens.trace(query.sensor, query.aperture, query.wavelengthNm))
            aims.push_back({query, ray->origin + distanceMm * ray->direction});
    }
    return aims;
}

void measureTimes(TradeRow& row, const LensFit& fit, const PolynomialLens& lens) {
    constexpr std::size_t count = 1000;
    const std::vector<Aim> aims = aimsOf(lens, count);
    const PolynomialEvaluator<double> exit(fit.exit);
    // Rays of the sensor-state form have slopes; what they are does not change the time.
    row.evaluationNs = nanosecondsPer(aims, [&](const Aim& aim) {
        const FitQuery& q = aim.query;
        return exit.evaluateBySensor({q.sensor.mm, q.aperture.mm, q.wavelengthNm}).values[0];
    });
    row.traceNs = nanosecondsPer(aims, [&](const Aim& aim) {
        const FitQuery& q = aim.query;
        const auto ray = lens.trace(q.sensor, q.aperture, q.wavelengthNm);
        return ray ? ray->throughput : 0.0;
    });
    row.connectNs = nanosecondsPer(aims, [&](const Aim& aim) {
        const auto found = lens.connect(aim.target, aim.query.aperture, aim.query.wavelengthNm);
        return found ? found->mm.x() : 0.0;
    });
}

void measureConnect(TradeRow& row, const PolynomialLens& lens) {
    constexpr std::array<double, 4> distancesMm{1e2, 1e3, 1e4, 1e6};
    constexpr int rings = 5, raysPerRing = 400;
    const auto failures = [&](ConnectMethod method) {
        int sum = 0;
        row.connectRays = 0;
        for (const ConnectRing& ring :
             connectSurvey(lens, method, distancesMm, rings, raysPerRing)) {
            sum += ring.failures + ring.otherPoints;
            row.connectRays += ring.rays;
        }
        return sum;
    };
    row.connectFailures = failures(ConnectMethod::newton);
    row.twoStepFailures = failures(ConnectMethod::twoStep);
}

}  // namespace

int rayMultiplyAdds(const LensFit& fit) {
    const bool hasAperture = fit.settings.form == FitForm::sensorState;
    return multiplyAdds(fit.exit) + (hasAperture ? multiplyAdds(fit.aperture) : 0);
}

TradeRow measureTrade(const Prescription& prescription, const FitDomain& domain,
                      const FitSettings& settings, const FitProgress& progress) {
    const Clock::time_point start = Clock::now();
    const LensFit fit = fitLens(prescription, domain, settings, progress);
    TradeRow row;
    row.fitSeconds = secondsSince(start);
    row.settings = settings;
    row.multiplyAdds = rayMultiplyAdds(fit);
    row.rimMultiplyAdds = multiplyAdds(fit.clip.squares);
    row.errors = fit.errors;
    row.clipErrors = fit.clipErrors;
    const PolynomialLens lens(prescription, fit, Aperture(domain.apertureRadiusMm));
    measureTimes(row, fit, lens);
    measureConnect(row, lens);
    return row;
}

}  // namespace etendue
