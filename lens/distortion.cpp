#include "lens/distortion.h"

#include <Eigen/QR>
#include <cmath>
#include <numbers>

namespace etendue {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

const AperturePoint stopCentre{{0.0, 0.0}};

double angleFromAxis(const Eigen::Vector3d& direction) {
    return std::atan2(std::hypot(direction.x(), direction.y()), direction.z());
}

/// The picture on a sensor is turned by half a turn about the axis.
Eigen::Vector2d upright(const Eigen::Vector2d& sensorMm) { return -sensorMm; }

/// What both models have in common: the picture is fx or fy times something linear in the
/// coefficients, m₀ + Σ kᵢ mᵢ, m₀ … being the rows of a matrix for each ray.
struct Model {
    std::vector<Eigen::Matrix2Xd> terms;  // for each ray: columns m₀, m₁, …; rows x, y
    std::vector<Eigen::Vector2d> targetsMm;
};

struct Solution {
    Eigen::Vector2d focalLengthMm;
    VectorXd coefficients;
    DistortionResidual residual;
};

Solution startOf(const Model& model) {
    Eigen::Vector2d over = Eigen::Vector2d::Zero(), under = over;
    for (std::size_t i = 0; i < model.terms.size(); ++i) {
        const Eigen::Vector2d ideal = model.terms[i].col(0);
        over += ideal.cwiseProduct(model.targetsMm[i]);
        under += ideal.cwiseProduct(ideal);
    }
    return {over.cwiseQuotient(under), VectorXd::Zero(model.terms.front().cols() - 1), {}};
}

DistortionResidual residualOf(const Model& model, const Solution& solution) {
    DistortionResidual residual;
    double squares = 0.0;
    for (std::size_t i = 0; i < model.terms.size(); ++i) {
        const Eigen::Matrix2Xd& terms = model.terms[i];
        const Eigen::Vector2d shape =
            terms.col(0) + terms.rightCols(terms.cols() - 1) * solution.coefficients;
        const Eigen::Vector2d off = solution.focalLengthMm.cwiseProduct(shape) - model.targetsMm[i];
        squares += off.squaredNorm();
        residual.mostMm = std::max(residual.mostMm, off.norm());
    }
    residual.rmsMm = std::sqrt(squares / static_cast<double>(model.terms.size()));
    return residual;
}

/// Gauss and Newton's method. The model is bilinear and nearly ideal, so it takes a few steps.
Solution solve(const Model& model) {
    constexpr int steps = 20;
    Solution solution = startOf(model);
    const Index rays = static_cast<Index>(model.terms.size());
    const Index unknowns = 2 + solution.coefficients.size();
    for (int step = 0; step < steps; ++step) {
        MatrixXd jacobian = MatrixXd::Zero(2 * rays, unknowns);
        VectorXd off(2 * rays);
        for (Index i = 0; i < rays; ++i) {
            const Eigen::Matrix2Xd& terms = model.terms[static_cast<std::size_t>(i)];
            const Eigen::Matrix2Xd others = terms.rightCols(terms.cols() - 1);
            const Eigen::Vector2d shape = terms.col(0) + others * solution.coefficients;
            for (Index axis = 0; axis < 2; ++axis) {
                const double f = solution.focalLengthMm[axis];
                jacobian(2 * i + axis, axis) = shape[axis];
                jacobian.row(2 * i + axis).tail(unknowns - 2) = f * others.row(axis);
                off[2 * i + axis] =
                    model.targetsMm[static_cast<std::size_t>(i)][axis] - f * shape[axis];
            }
        }
        const VectorXd change = jacobian.completeOrthogonalDecomposition().solve(off);
        solution.focalLengthMm += change.head<2>();
        solution.coefficients += change.tail(unknowns - 2);
        if (change.norm() <= 1e-13 * solution.focalLengthMm.norm()) break;
    }
    solution.residual = residualOf(model, solution);
    return solution;
}

Eigen::Matrix2Xd pinholeTerms(const Eigen::Vector3d& direction) {
    const double x = direction.x() / direction.z(), y = direction.y() / direction.z();
    const double r2 = x * x + y * y;
    Eigen::Matrix2Xd terms(2, 6);  // 1, k1, k2, p1, p2, k3
    terms.row(0) << x, x * r2, x * r2 * r2, 2.0 * x * y, r2 + 2.0 * x * x, x * r2 * r2 * r2;
    terms.row(1) << y, y * r2, y * r2 * r2, r2 + 2.0 * y * y, 2.0 * x * y, y * r2 * r2 * r2;
    return terms;
}

Eigen::Matrix2Xd fisheyeTerms(const Eigen::Vector3d& direction) {
    const double theta = angleFromAxis(direction);
    const double across = std::hypot(direction.x(), direction.y());
    Eigen::Vector2d term = Eigen::Vector2d::Zero();
    if (across > 0.0) term = direction.head<2>() * (theta / across);
    Eigen::Matrix2Xd terms(2, 5);  // 1, k1 … k4
    for (Index i = 0; i < 5; ++i, term *= theta * theta) terms.col(i) = term;
    return terms;
}

template <class Terms>
std::optional<Solution> fit(std::span<const FieldRay> rays, const Terms& termsOf) {
    constexpr std::size_t fewest = 8;
    if (rays.size() < fewest) return {};
    Model model;
    for (const FieldRay& ray : rays) {
        model.terms.push_back(termsOf(ray.direction));
        model.targetsMm.push_back(upright(ray.sensorMm));
    }
    return solve(model);
}

}  // namespace

std::vector<FieldRay> chiefRays(const TracedLens& lens, const Eigen::Vector2d& sensorHalfSizeMm,
                                double imageRadiusMm, int grid) {
    const MonochromaticLens atLine(lens, dLineNm);
    std::vector<FieldRay> rays;
    for (int i = 0; i < grid; ++i)
        for (int j = 0; j < grid; ++j) {
            const Eigen::Vector2d share(2.0 * i / (grid - 1) - 1.0, 2.0 * j / (grid - 1) - 1.0);
            const Eigen::Vector2d sensor = share.cwiseProduct(sensorHalfSizeMm);
            if (sensor.norm() > imageRadiusMm) continue;
            if (const auto ray = atLine.trace({sensor}, stopCentre))
                rays.push_back({sensor, ray->direction});
        }
    return rays;
}

std::optional<PinholeDistortion> fitPinhole(std::span<const FieldRay> rays) {
    constexpr double widest = 85.0 * std::numbers::pi / 180.0;
    for (const FieldRay& ray : rays)
        if (angleFromAxis(ray.direction) >= widest) return {};
    const std::optional<Solution> found = fit(rays, pinholeTerms);
    if (!found) return {};
    const VectorXd& k = found->coefficients;
    return PinholeDistortion{found->focalLengthMm, k[0], k[1], k[2], k[3], k[4], found->residual};
}

std::optional<FisheyeDistortion> fitFisheye(std::span<const FieldRay> rays) {
    const std::optional<Solution> found = fit(rays, fisheyeTerms);
    if (!found) return {};
    const VectorXd& k = found->coefficients;
    return FisheyeDistortion{found->focalLengthMm, {k[0], k[1], k[2], k[3]}, found->residual};
}

std::vector<DistortionPoint> distortionCurve(const TracedLens& lens, const Eigen::Vector2d& along,
                                             double highestMm, int count) {
    constexpr double degree = std::numbers::pi / 180.0, steepest = 89.0 * degree;
    constexpr double nearAxis = 1e-3;  // of the highest: distortion there is its square
    const MonochromaticLens atLine(lens, dLineNm);
    const auto angleAt = [&](double height) {
        const std::optional<ExitRay> ray = atLine.trace({height * along}, stopCentre);
        return ray ? angleFromAxis(ray->direction) : std::numeric_limits<double>::quiet_NaN();
    };
    const double first = nearAxis * highestMm;
    const double focal = first / angleAt(first);
    std::vector<DistortionPoint> curve;
    for (int i = 1; i <= count; ++i) {
        const double height = highestMm * i / count;
        const double angle = angleAt(height);
        if (!std::isfinite(angle)) continue;
        const auto percent = [&](double ideal) { return 100.0 * (height / (focal * ideal) - 1.0); };
        curve.push_back(
            {height, angle / degree,
             angle < steepest ? percent(std::tan(angle)) : std::numeric_limits<double>::quiet_NaN(),
             percent(angle)});
    }
    return curve;
}

}  // namespace etendue
