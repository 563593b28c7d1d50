// measureErrors: what a fit is off by, on rays drawn anew.
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "lens/density.h"
#include "lens/lens_fit.h"
#include "lens/parallel.h"
#include "lens/polynomial.h"
#include "lens/slope_solver.h"

namespace etendue {

namespace {

/// Of the outputs `row` and `row + 1`: by s (column 0) or by p (column 2).
Eigen::Matrix2d block(const PolynomialResult<double>& result, std::size_t row, std::size_t column) {
    Eigen::Matrix2d m;
    m << result.jacobian[row][column], result.jacobian[row][column + 1],
        result.jacobian[row + 1][column], result.jacobian[row + 1][column + 1];
    return m;
}

/// Where a fit's polynomials take a ray whose aperture point is held.
struct FittedExit {
    PupilState<double> pupil;
    Eigen::Matrix4d bySensorAndAperture;  // of the pupil state by (s, a)
    double throughput;                    // J τ
    std::optional<double> j;              // where it is known apart from τ
};

class FittedExits {
public:
    explicit FittedExits(const LensFit& fit)
        : exit_(fit.exit), apertureRadiusMm_(fit.domain.apertureRadiusMm) {
        if (fit.settings.form == FitForm::sensorState) aperture_.emplace(fit.aperture);
    }

    /// Empty where no slope leads to the aperture point.
    std::optional<FittedExit> at(const FitRay& ray) const {
        const FitQuery& query = ray.query;
        if (aperture_) return throughSlope(ray);
        const auto at = exit_.evaluate({query.sensor.mm, query.aperture.mm, query.wavelengthNm});
        FittedExit result{stateOf(at), {}, at.values[4], {}};
        for (std::size_t v = 0; v < 2; ++v)
            setRows(result, v, block(at, 2 * v, 0), block(at, 2 * v, 2));
        return result;
    }

private:
    static PupilState<double> stateOf(const PolynomialResult<double>& at) {
        return {at.values[0], at.values[1], at.values[2], at.values[3]};
    }

    static void setRows(FittedExit& exit, std::size_t vector, const Eigen::Matrix2d& bySensor,
                        const Eigen::Matrix2d& byAperture) {
        const auto row = static_cast<Eigen::Index>(2 * vector);
        exit.bySensorAndAperture.block<2, 2>(row, 0) = bySensor;
        exit.bySensorAndAperture.block<2, 2>(row, 2) = byAperture;
    }

    std::optional<FittedExit> throughSlope(const FitRay& ray) const {
        const FitQuery& query = ray.query;
        const auto inputWith = [&](const Eigen::Vector2d& slope) {
            return PolynomialInput{query.sensor.mm, slope, query.wavelengthNm};
        };
        const auto hit = [&](const Eigen::Vector2d& slope) {
            const PolynomialResult<double> at = aperture_->evaluate(inputWith(slope));
            return std::optional(StopHit{{at.values[0], at.values[1]}, block(at, 0, 2)});
        };
        const auto slope = solveSlope(hit, ray.slope, query.aperture, apertureRadiusMm_);
        if (!slope) return {};
        const PolynomialResult<double> stop = aperture_->evaluate(inputWith(*slope));
        const PolynomialResult<double> at = exit_.evaluate(inputWith(*slope));
        const Eigen::Matrix2d bySlope = block(stop, 0, 2);
        const Eigen::Matrix2d k = slopeBySensor(bySlope, block(stop, 0, 0));
        const double j = exchangeJacobian(*slope, bySlope);
        FittedExit result{stateOf(at), {}, j * at.values[4], j};
        for (std::size_t v = 0; v < 2; ++v)
            setRows(result, v, block(at, 2 * v, 0) + block(at, 2 * v, 2) * k,
                    block(at, 2 * v, 2) * bySlope.inverse());
        return result;
    }

    PolynomialEvaluator<double> exit_;
    std::optional<PolynomialEvaluator<double>> aperture_;
    double apertureRadiusMm_;
};

struct RayErrors {
    double pupilMm, directionMrad, sensorMicrometres, throughput, etendue;
};

/// `brightness`: the mean throughput over the domain.
std::optional<RayErrors> errorsOf(const FittedExits& fitted, const PupilSphere& sphere,
                                  const FitRay& ray, double brightness) {
    const std::optional<FittedExit> exit = fitted.at(ray);
    const std::optional<LensRay<double>> there = exit ? sphere.ray(exit->pupil) : std::nullopt;
    if (!there) return {};
    const PupilState<double>& pupil = exit->pupil;
    const Eigen::Vector3d off = toEigen(there->direction) - ray.direction;
    const double j = exit->j ? *exit->j : exit->throughput / ray.transmittance;
    const double determinant = etendueDeterminant(exit->bySensorAndAperture, j, pupil, sphere);
    return RayErrors{std::hypot(pupil.x - ray.pupil.x, pupil.y - ray.pupil.y), 1e3 * off.norm(),
                     1e3 * ray.directionBySensor.colPivHouseholderQr().solve(off).norm(),
                     std::abs(exit->throughput - ray.throughput) / brightness,
                     std::abs(determinant - 1.0)};
}

ErrorSummary summarize(std::vector<double> magnitudes) {
    if (magnitudes.empty()) return {};
    double squares = 0.0;
    for (const double m : magnitudes) squares += m * m;
    std::ranges::sort(magnitudes);
    const std::size_t rank =
        static_cast<std::size_t>(std::ceil(0.999 * static_cast<double>(magnitudes.size())));
    return {std::sqrt(squares / static_cast<double>(magnitudes.size())), magnitudes[rank - 1],
            magnitudes.back()};
}

}  // namespace

FitErrors measureErrors(const LensFit& fit, const TracedLens& lens, std::size_t rays,
                        std::uint64_t seed) {
    const PupilSphere sphere(lens.system());
    const FittedExits fitted(fit);
    const FitRays heldOut = drawFitRays(lens, fit.domain, rays, seed);
    double brightness = 0.0;
    for (const FitRay& ray : heldOut.rays)
        brightness += ray.throughput / static_cast<double>(heldOut.rays.size());
    std::vector<std::optional<RayErrors>> errors(heldOut.rays.size());
    parallelFor(errors.size(), [&](std::size_t i) {
        errors[i] = errorsOf(fitted, sphere, heldOut.rays[i], brightness);
    });

    FitErrors result;
    result.rays = static_cast<std::int64_t>(errors.size());
    result.unsolved = std::ranges::count_if(errors, [](const auto& one) { return !one; });
    const auto summaryOf = [&](double RayErrors::*error) {
        std::vector<double> magnitudes;
        for (const std::optional<RayErrors>& one : errors)
            if (one) magnitudes.push_back((*one).*error);
        return summarize(std::move(magnitudes));
    };
    result.pupilMm = summaryOf(&RayErrors::pupilMm);
    result.directionMrad = summaryOf(&RayErrors::directionMrad);
    result.sensorMicrometres = summaryOf(&RayErrors::sensorMicrometres);
    result.throughputRelative = summaryOf(&RayErrors::throughput);
    result.etendue = summaryOf(&RayErrors::etendue);
    return result;
}

}  // namespace etendue
