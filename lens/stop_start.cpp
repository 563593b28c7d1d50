#include "lens/stop_start.h"

#include <cmath>

#include "lens/stop_ray.h"

namespace etendue {

namespace {

/// The ray in the scene from the stop's centre, differentiated by (a, p).
std::optional<LensRay<Dual<4>>> rayFromCentre(const MonochromaticSystem& lens, double slope) {
    using D = Dual<4>;
    LensRay<D> ray = rayAtStop<D>(lens.system, {D::variable(0.0, 0), D::variable(0.0, 1),
                                                D::variable(slope, 2), D::variable(0.0, 3)});
    if (leaveFront<TraceMode::geometry>(lens, ray).status != TraceStatus::passed) return {};
    return ray;
}

}  // namespace

std::optional<StopStart::Row> StopStart::traced(const MonochromaticSystem& lens, double slope) {
    const auto ray = rayFromCentre(lens, slope);
    if (!ray) return {};
    const Vector3<Dual<4>>&x = ray->origin, &d = ray->direction;
    Row row{d.x.value, d.z.value, 0.0, slope, {}, {}};
    // In the plane: the component along (cosine, −sine).
    const auto turn = [&](std::size_t i) {
        return row.cosine * d.x.partials[i] - row.sine * d.z.partials[i];
    };
    const auto shift = [&](std::size_t i) {
        return row.cosine * x.x.partials[i] - row.sine * x.z.partials[i];
    };
    row.asideMm = row.cosine * x.x.value - row.sine * x.z.value;
    row.slopePerMm << -turn(0) / turn(2), -d.y.partials[1] / d.y.partials[3];
    row.asidePerMm << shift(0) + shift(2) * row.slopePerMm.x(),
        x.y.partials[1] + x.y.partials[3] * row.slopePerMm.y();
    if (!(row.slopePerMm.allFinite() && row.asidePerMm.allFinite())) return {};
    return row;
}

StopStart::StopStart(const MonochromaticSystem& lens, bool isAxial, double steepest) {
    const auto axis = rayFromCentre(lens, 0.0);
    if (!axis) return;  // no light passes along the axis
    const auto& [x, d] = *axis;
    const auto byBoth = [](const Dual<4>& onX, const Dual<4>& onY, std::size_t first) {
        return Eigen::Vector2d(onX.partials[first], onY.partials[first + 1]);
    };
    slopeByAperture_ = byBoth(d.x, d.y, 0) / d.z.value;
    slopeBySlope_ = byBoth(d.x, d.y, 2) / d.z.value;
    positionByAperture_ = byBoth(x.x, x.y, 0) - x.z.value * slopeByAperture_;
    positionBySlope_ = byBoth(x.x, x.y, 2) - x.z.value * slopeBySlope_;
    // A direction must tell a slope, as in lenses telecentric at their objects it does not.
    constexpr double leastTurn = 1e-3;
    const double sign = slopeBySlope_.x() > 0.0 ? 1.0 : -1.0;
    if (!isAxial || !(std::abs(slopeBySlope_.x()) * steepest > leastTurn)) return;

    constexpr int tracedRows = 256;
    constexpr double keptRows = 64.0;
    const auto fieldOf = [](const Row& row) { return std::atan2(row.sine, row.cosine); };
    std::vector<Row> found;
    for (int i = 0; i <= tracedRows; ++i) {
        const auto row = traced(lens, sign * steepest * i / tracedRows);
        // Where the field no longer grows the lens folds.
        if (!row || (!found.empty() && !(fieldOf(*row) > fieldOf(found.back())))) break;
        found.push_back(*row);
    }
    const double apart = fieldOf(found.back()) / keptRows;
    for (const Row& row : found)
        if (rows_.empty() || fieldOf(row) >= fieldOf(rows_.back()) + apart) rows_.push_back(row);
    if (rows_.size() < 2)
        rows_.clear();
    else
        lastRowsApart_ = fieldOf(rows_.back()) - fieldOf(rows_[rows_.size() - 2]);
}

StopStart::Place StopStart::placeOf(double farMm, double zMm) const {
    // How far the target is beside a row's ray, toward larger fields.
    const auto beside = [&](const Row& row) {
        return farMm * row.cosine - zMm * row.sine - row.asideMm;
    };
    std::size_t low = 0, count = rows_.size() - 1;  // the place lies in [low, low + count]
    while (count > 1) {
        const std::size_t half = count / 2;
        low = beside(rows_[low + half]) > 0.0 ? low + half : low;
        count -= half;
    }
    const Row &nearer = rows_[low], &farther = rows_[low + 1];
    const double here = beside(nearer), change = beside(farther) - here;
    // More than a right angle beyond the last row they seem to turn away from the target.
    constexpr double farOut = 1e6;
    return {nearer, farther, change < 0.0 ? -here / change : farOut};
}

StopStart::Guess StopStart::guess(const Eigen::Vector3d& target, AperturePoint aperture) const {
    const Eigen::Vector2d& a = aperture.mm;
    if (rows_.empty()) {
        const double z = target.z();
        return {(target.head<2>() - (positionByAperture_ + z * slopeByAperture_).cwiseProduct(a))
                    .cwiseQuotient(positionBySlope_ + z * slopeBySlope_),
                0.0};
    }
    // A ray beside the stop's centre meets the target if one through the centre, of the same
    // direction, meets the target moved back by what they are apart; which takes the direction.
    constexpr int rounds = 3;
    Eigen::Vector3d moved = target;
    Guess guess{};
    for (int i = 0; i < rounds; ++i) {
        const double far = moved.head<2>().norm();
        const Eigen::Vector2d e =
            far > 0.0 ? Eigen::Vector2d(moved.head<2>() / far) : Eigen::Vector2d(1.0, 0.0);
        const Eigen::Vector2d sideways(-e.y(), e.x()), inFrame(a.dot(e), a.dot(sideways));
        const auto [low, high, share] = placeOf(far, moved.z());
        guess.beyond = &high == &rows_.back() ? (share - 1.0) * lastRowsApart_ : 0.0;
        const auto between = [t = share](const auto& from, const auto& to) {
            return from + t * (to - from);
        };
        const Eigen::Vector2d beside =
            inFrame.cwiseProduct(between(low.slopePerMm, high.slopePerMm).eval());
        guess.slope = (between(low.slope, high.slope) + beside.x()) * e + beside.y() * sideways;
        const Eigen::Vector2d apart =
            inFrame.cwiseProduct(between(low.asidePerMm, high.asidePerMm).eval());
        const Eigen::Vector2d flat =
            apart.x() * between(low.cosine, high.cosine) * e + apart.y() * sideways;
        moved =
            target - Eigen::Vector3d(flat.x(), flat.y(), -apart.x() * between(low.sine, high.sine));
    }
    return guess;
}

}  // namespace etendue
