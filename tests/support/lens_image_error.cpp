#include "tests/support/lens_image_error.h"

#include <Eigen/QR>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "lens/fit_domain.h"
#include "lens/polynomial_lens.h"
#include "renderer/parallel.h"
#include "renderer/random.h"

namespace etendue {

namespace {

// Numbers in parentheses are the equations of docs/lens-image-error.md.

constexpr double nm = Wavelengths::rgbWavelengthNm;

ExitRay middleRay(const LensModel& lens) {
    const auto ray = lens.trace({{0.0, 0.0}}, {{0.0, 0.0}}, nm);
    if (!ray) throw std::invalid_argument("chart: no light in the middle of the picture");
    return *ray;
}

/// Of the camera's weight to its lens' throughput; a mean, since weights are floats.
double weightScale(const Camera& camera, const LensModel& lens) {
    const Vec2 middle{0.5f * static_cast<float>(camera.settings().width),
                      0.5f * static_cast<float>(camera.settings().height)};
    const SensorPoint sensor{sensorPointMm(camera.settings(), middle)};
    double sum = 0.0;
    int count = 0;
    RandomStream random(1, 0, 0, RandomDomain::test);
    for (int i = 0; i < 4096; ++i) {
        const Vec2 u = random.next2();
        const auto ray = camera.sampleRay(middle, u, {});
        const auto exit = lens.trace(sensor, lens.sampleAperture({u.x, u.y}), nm);
        if (!ray || !exit) continue;
        sum += static_cast<double>(ray->weight) / exit->throughput;
        ++count;
    }
    if (count == 0) throw std::invalid_argument("chart: no light in the middle of the picture");
    return sum / count;
}

/// A little wider than the field, as rays from the edge of the picture and from half way there see
/// it.
double leastCosineOf(const LensPair& pair) {
    constexpr int steps = 16;
    const Vec2 size{static_cast<float>(pair.view.width), static_cast<float>(pair.view.height)};
    const std::array<double, steps> places = [] {
        std::array<double, steps> result{};
        for (int i = 0; i < steps; ++i) result[static_cast<std::size_t>(i)] = i / (steps - 1.0);
        return result;
    }();
    double least = middleRay(*pair.traced).direction.z();
    const auto look = [&](double x, double y) {
        const Vec2 film{static_cast<float>(x) * size.x, static_cast<float>(y) * size.y};
        const SensorPoint sensor{sensorPointMm(pair.tracedCamera->settings(), film)};
        for (const double u : places)
            for (const double v : places) {
                const auto ray = pair.traced->trace(
                    sensor, pair.traced->sampleAperture({0.999 * u, 0.999 * v}), nm);
                if (ray) least = std::min(least, ray->direction.z());
            }
    };
    for (const double far : {0.0, 0.125, 0.25})
        for (const double along : places) {
            look(far, along);
            look(along, far);
        }
    return std::cos(std::min(std::numbers::pi, 1.05 * std::acos(least) + 0.01));
}

/// Film and aperture points of one pixel: a Kronecker sequence by the powers of the root of
/// x⁵ = x + 1 (Roberts 2018), shifted at random.
class PixelPoints {
public:
    PixelPoints(std::uint64_t seed, std::size_t pixel, std::uint32_t replicate) {
        RandomStream random(seed, static_cast<std::uint32_t>(pixel), replicate, RandomDomain::test);
        for (double& s : shift_) s = static_cast<double>(random.next());
    }
    std::array<double, 4> operator[](int point) const {
        constexpr double root = 1.1673039782614187;
        std::array<double, 4> u{};
        double step = 1.0;
        for (std::size_t i = 0; i < 4; ++i) {
            step /= root;
            const double at = shift_[i] + step * point;
            u[i] = at - std::floor(at);
        }
        return u;
    }

private:
    std::array<double, 4> shift_{};
};

/// What the rays of one pixel add up to.
struct PixelSums {
    double firstOrder = 0.0, exact = 0.0, remainder = 0.0;
    double steepest = 0.0, heaviest = 0.0, weight = 0.0, shiftSquared = 0.0;
    int blocked = 0, otherwise = 0, both = 0;
};

class Predictor {
public:
    explicit Predictor(const LensPair& pair)
        : pair_(pair),
          tracedScale_(weightScale(*pair.tracedCamera, *pair.traced)),
          fittedScale_(weightScale(*pair.fittedCamera, *pair.fitted)) {}

    PixelSums pixel(std::size_t index, std::uint32_t replicate, int points,
                    std::uint64_t seed) const {
        const auto width = static_cast<std::size_t>(pair_.view.width);
        const PixelPoints at(seed, index, replicate);
        const CameraSettings& settings = pair_.tracedCamera->settings();
        PixelSums sums;
        for (int i = 0; i < points; ++i) {
            const std::array<double, 4> u = at[i];
            const Vec2 film{static_cast<float>(static_cast<double>(index % width) + u[0]),
                            static_cast<float>(static_cast<double>(index / width) + u[1])};
            const SensorPoint sensor{sensorPointMm(settings, film)};
            const AperturePoint aperture = pair_.traced->sampleAperture({u[2], u[3]});
            addRays(pair_.traced->trace(sensor, aperture, nm),
                    pair_.fitted->trace(sensor, aperture, nm), sums);
        }
        return sums;
    }

    double normDifference() const { return std::abs(fittedScale_ / tracedScale_ - 1.0); }

private:
    void addRays(const std::optional<ExitRay>& traced, const std::optional<ExitRay>& fitted,
                 PixelSums& sums) const {
        const Chart& chart = pair_.chart;
        const double w = traced ? tracedScale_ * traced->throughput : 0.0;
        const double v = fitted ? fittedScale_ * fitted->throughput : 0.0;
        const double before = traced ? w * chart.radiance(traced->direction) : 0.0;
        const double after = fitted ? v * chart.radiance(fitted->direction) : 0.0;
        sums.exact += after - before;
        sums.heaviest = std::max(sums.heaviest, w);
        sums.weight += w;
        if (!traced) ++sums.blocked;
        if (traced.has_value() != fitted.has_value()) {
            ++sums.otherwise;
            sums.firstOrder += after - before;
        }
        if (!traced || !fitted) return;
        ++sums.both;
        const Eigen::Vector3d off = fitted->direction - traced->direction;
        const Eigen::Vector3d gradient = chart.gradient(traced->direction);
        const auto& bySensor = traced->directionBySensor;
        sums.firstOrder +=
            w * gradient.dot(off) + (v - w) * chart.radiance(traced->direction);  // (3)
        sums.remainder += w * chart.mostSecondOrder(traced->direction, fitted->direction) +
                          std::abs(v - w) * gradient.norm() * off.norm();
        sums.steepest = std::max(sums.steepest, w * (gradient.transpose() * bySensor).norm());
        sums.shiftSquared += bySensor.colPivHouseholderQr().solve(off).squaredNorm();
    }

    const LensPair& pair_;
    double tracedScale_, fittedScale_;
};

}  // namespace

LensPair makeLensPair(const ChartView& view, int terms) {
    const Prescription prescription = loadPrescription(view.lensFile);
    DomainRequest request;
    request.sensorSizeMm = view.pixelMm() * Eigen::Vector2d(view.width, view.height);
    request.focusDistanceMm = view.focusDistanceMm;
    request.fNumber = view.fNumber;
    request.shortestWavelengthNm = request.longestWavelengthNm = nm;
    const FitDomain domain = fitDomain(prescription, request);
    FitSettings settings;
    settings.terms = terms;
    if (isAnamorphic(prescription)) settings.basis = PolynomialBasis::twoPlane;

    LensPair pair{view, fitLens(prescription, domain, settings), {}, {}, {}, {}, {}};
    pair.traced = std::make_shared<TracedLens>(lensOf(prescription, domain));
    pair.fitted =
        std::make_shared<PolynomialLens>(prescription, pair.fit, Aperture(domain.apertureRadiusMm));
    CameraSettings camera;
    camera.width = view.width;
    camera.height = view.height;
    camera.sensorWidthMm = view.sensorWidthMm;
    pair.tracedCamera = std::make_unique<Camera>(pair.traced, camera);
    pair.fittedCamera = std::make_unique<Camera>(pair.fitted, camera);
    const double fieldPerMm = middleRay(*pair.traced).directionBySensor.col(0).norm();
    pair.chart.wavenumber =
        2.0 * std::numbers::pi / (view.periodPixels * view.pixelMm() * fieldPerMm);
    pair.chart.leastCosine = leastCosineOf(pair);
    return pair;
}

PredictionSet predict(const LensPair& pair, int replicates, int points, std::uint64_t seed) {
    const Predictor predictor(pair);
    const auto pixels = static_cast<std::size_t>(pair.view.width * pair.view.height);
    PredictionSet set;
    PixelSums all;
    for (int r = 0; r < replicates; ++r) {
        std::vector<PixelSums> sums(pixels);
        parallelFor(pixels, hardwareThreads(), [&](std::size_t i) {
            sums[i] = predictor.pixel(i, static_cast<std::uint32_t>(r), points, seed);
        });
        Prediction& map = set.replicates.emplace_back();
        for (const PixelSums& s : sums) {
            map.firstOrder.push_back(s.firstOrder / points);
            map.exact.push_back(s.exact / points);
            map.remainder.push_back(s.remainder / points);
            all.steepest = std::max(all.steepest, s.steepest);
            all.heaviest = std::max(all.heaviest, s.heaviest);
            all.weight += s.weight;
            all.shiftSquared += s.shiftSquared;
            all.blocked += s.blocked;
            all.otherwise += s.otherwise;
            all.both += s.both;
        }
    }
    const double rays = 1.0 * replicates * points * static_cast<double>(pixels);
    set.facts = {.steepest = all.steepest,
                 .heaviest = all.heaviest,
                 .meanWeight = all.weight / (rays - all.blocked),
                 .shiftRmsMm = std::sqrt(all.shiftSquared / all.both),
                 .normDifference = predictor.normDifference(),
                 .decidedOtherwise = all.otherwise / rays};
    return set;
}

std::vector<PixelMap> PredictionSet::maps(PixelMap Prediction::*map, std::size_t from,
                                          std::size_t to) const {
    std::vector<PixelMap> result;
    for (std::size_t i = from; i < to; ++i) result.push_back(replicates[i].*map);
    return result;
}

StatedBound statedBound(const LensPair& pair, const ChartFacts& facts) {
    constexpr double mmPerMicrometre = 1e-3;
    const FitErrors& stated = pair.fit.errors;
    const auto bound = [&](double ErrorSummary::*kind) {  // (4)
        return facts.steepest * mmPerMicrometre * stated.sensorMicrometres.*kind +
               Chart::brightest * (facts.meanWeight * stated.throughputRelative.*kind +
                                   facts.heaviest * facts.normDifference);
    };
    // Of all the pixels each ray decided otherwise is in, the worst is where they are all in few.
    const double otherwise =
        pair.fit.clipErrors.wronglyAccepted + pair.fit.clipErrors.wronglyBlocked;
    StatedBound result;
    result.rms = bound(&ErrorSummary::rms) +
                 Chart::brightest * facts.heaviest * std::sqrt(otherwise);  // (5)
    result.most = bound(&ErrorSummary::most);
    return result;
}

}  // namespace etendue
