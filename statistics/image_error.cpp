#include "statistics/image_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <stdexcept>

#include "statistics/statistics.h"

namespace etendue {

namespace {

void requireSameSize(const Picture& a, const Picture& b) {
    if (a.empty() || a.size() % 3 != 0 || a.size() != b.size())
        throw std::invalid_argument("pictures to compare must have one size");
}

double squared(double x) { return x * x; }

/// In double: sums over a picture would lose the small ones.
std::vector<double> pixelErrors(const Picture& picture, const Picture& reference) {
    std::vector<double> errors(picture.size() / 3);
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const double a = picture[i], r = reference[i];
        errors[i / 3] += squared(a - r) / (squared(r) + relMseFloor) / 3.0;
    }
    return errors;
}

double sumOf(const Picture& picture) {
    return std::accumulate(picture.begin(), picture.end(), 0.0);
}

/// Sums over all values.
struct Sums {
    double picture = 0.0, reference = 0.0;
};

/// In units of the reference's sum. If that is 0, nothing is a share of it, and this is NaN; but
/// the nothing of a picture that is black, too, is 0.
double asShare(double value, const Sums& sums) {
    if (sums.reference != 0.0) return value / sums.reference;
    return sums.picture == 0.0 && value == 0.0 ? 0.0 : std::nan("");
}

double meanOf(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

ImageErrors imageErrors(const Picture& picture, const Picture& reference) {
    requireSameSize(picture, reference);
    ImageErrors result;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const double a = picture[i], r = reference[i];
        result.mse += squared(a - r);
        result.mae += std::abs(a - r);
    }
    const Sums sums{sumOf(picture), sumOf(reference)};
    const auto count = static_cast<double>(picture.size());
    result.mse /= count;
    result.mae /= count;
    result.meanError = asShare(sums.picture - sums.reference, sums);

    std::vector<double> errors = pixelErrors(picture, reference);
    result.relMse = meanOf(errors);
    const auto kept = static_cast<std::ptrdiff_t>(errors.size() - errors.size() / 1000);
    if (kept < std::ssize(errors))
        std::nth_element(errors.begin(), errors.begin() + kept, errors.end());
    result.relMseTrimmed = meanOf({errors.begin(), errors.begin() + kept});
    return result;
}

std::vector<float> relativeSquaredErrors(const Picture& picture, const Picture& reference) {
    requireSameSize(picture, reference);
    const std::vector<double> errors = pixelErrors(picture, reference);
    std::vector<float> result(errors.size());
    std::ranges::transform(errors, result.begin(), [](double e) { return static_cast<float>(e); });
    return result;
}

MeanPicture meanPicture(const std::vector<Picture>& independent) {
    const auto count = static_cast<double>(independent.size());
    MeanPicture result;
    for (std::size_t i = 0; i < independent.front().size(); ++i) {
        double sum = 0.0, squares = 0.0;
        for (const Picture& picture : independent) sum += static_cast<double>(picture[i]);
        const double mean = sum / count;
        for (const Picture& picture : independent)
            squares += squared(static_cast<double>(picture[i]) - mean);
        const double variance = squares / (count * (count - 1.0));
        result.pixels.push_back(static_cast<float>(mean));
        result.variance.push_back(static_cast<float>(variance));
        result.relMse += variance / (squared(mean) + relMseFloor);
    }
    result.relMse /= static_cast<double>(result.pixels.size());
    return result;
}

double biasSquared(const Picture& picture1, const Picture& picture2, const Picture& reference1,
                   const Picture& reference2) {
    requireSameSize(picture1, picture2);
    requireSameSize(picture1, reference1);
    requireSameSize(picture1, reference2);
    double sum = 0.0;
    for (std::size_t i = 0; i < picture1.size(); ++i) {
        const double a1 = picture1[i], a2 = picture2[i], r1 = reference1[i], r2 = reference2[i];
        sum += (a1 - r1) * (a2 - r2);
    }
    return sum / static_cast<double>(picture1.size());
}

double meanErrorHalfWidth(const Picture& picture, const Picture& reference,
                          const Picture& pictureVariance, const Picture& referenceVariance) {
    constexpr double normalQuantile99 = 2.575829303548901;
    requireSameSize(picture, reference);
    // Of the sum over all values: pixels are independent, the channels of one at worst the same.
    const auto varianceOfSum = [&](const Picture& variance) {
        if (!variance.empty()) requireSameSize(picture, variance);
        double sum = 0.0;
        for (std::size_t i = 0; i + 2 < variance.size(); i += 3)
            sum += squared(std::sqrt(static_cast<double>(variance[i])) +
                           std::sqrt(static_cast<double>(variance[i + 1])) +
                           std::sqrt(static_cast<double>(variance[i + 2])));
        return sum;
    };
    const Sums sums{sumOf(picture), sumOf(reference)};
    const double ratio = asShare(sums.picture, sums);
    const double variance =
        varianceOfSum(pictureVariance) + squared(ratio) * varianceOfSum(referenceVariance);
    return normalQuantile99 * std::abs(asShare(std::sqrt(variance), sums));
}

double meanErrorHalfWidthByScatter(const Picture& picture, const Picture& reference) {
    requireSameSize(picture, reference);
    std::vector<double> differences(picture.size() / 3);
    for (std::size_t i = 0; i < picture.size(); ++i)
        differences[i / 3] += static_cast<double>(picture[i]) - static_cast<double>(reference[i]);
    if (differences.size() < 2) return std::nan("");
    const Summary summary = summarize(differences);
    const auto count = static_cast<double>(differences.size());
    const double errorOfSum = count * summary.standardError;
    return studentQuantile(0.99, count - 1.0) *
           std::abs(asShare(errorOfSum, {sumOf(picture), sumOf(reference)}));
}

}  // namespace etendue
