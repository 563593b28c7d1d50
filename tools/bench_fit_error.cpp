#include "tools/bench_fit_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/render.h"
#include "statistics/image_error.h"
#include "statistics/statistics.h"

namespace etendue {

namespace {

std::optional<Picture> pictureOf(const LoadedScene& loaded, const FitErrorSettings& settings,
                                 int seed, const std::function<bool()>& goOn) {
    Film film(loaded.film.fullFrame(), {}, loaded.film.color);
    RenderSettings render;
    render.samples = settings.samples;
    render.seed = static_cast<std::uint64_t>(seed);
    render.threads = settings.threads;
    const RenderResult result = etendue::render(
        *loaded.scene, *loaded.camera, *makeEstimator(withKind(loaded.estimator, "pt")),
        Filter(loaded.film.filter, loaded.film.filterRadius), film, render,
        [&](const RenderProgress&) { return goOn(); });
    if (result.wasInterrupted) return {};
    return film.channels().front().pixels;
}

using Matrix = std::vector<std::vector<double>>;

/// Which values count: all but the 0.1 % where the pictures of any seed differ most, relatively.
/// There a path was bright by chance and has met another thing, which a mean of squares would be
/// made of.
std::vector<bool> countingValues(const std::vector<Picture>& differences,
                                 const Picture& reference) {
    std::vector<float> largest(reference.size());
    for (std::size_t p = 0; p < reference.size(); ++p) {
        for (const Picture& d : differences) largest[p] = std::max(largest[p], std::abs(d[p]));
        largest[p] /= std::sqrt(reference[p] * reference[p] + static_cast<float>(relMseFloor));
    }
    std::vector<float> sorted = largest;
    const auto kept = sorted.begin() +
                      static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), kept, sorted.end());
    std::vector<bool> counts(reference.size());
    for (std::size_t p = 0; p < reference.size(); ++p) counts[p] = largest[p] <= *kept;
    return counts;
}

/// Mean over the values that count of d_i d_j / (r² + 0.01), of different i and j; the rest is
/// zero.
Matrix productsOf(const std::vector<Picture>& differences, const Picture& reference) {
    const std::vector<bool> counts = countingValues(differences, reference);
    const auto all = static_cast<double>(std::count(counts.begin(), counts.end(), true));
    const std::size_t seeds = differences.size();
    Matrix products(seeds, std::vector<double>(seeds));
    for (std::size_t i = 0; i < seeds; ++i)
        for (std::size_t j = 0; j < i; ++j) {
            double sum = 0.0;
            for (std::size_t p = 0; p < reference.size(); ++p) {
                if (!counts[p]) continue;
                const double r = reference[p];
                sum += static_cast<double>(differences[i][p]) * differences[j][p] /
                       (r * r + relMseFloor);
            }
            products[i][j] = products[j][i] = sum / all;
        }
    return products;
}

/// The mean over the pairs, its error by leaving out one seed at a time (jackknife): a bootstrap
/// would pair seeds with themselves.
FitImageError errorOf(const Matrix& products) {
    const double n = static_cast<double>(products.size());
    std::vector<double> ofSeed;
    double all = 0.0;
    for (const std::vector<double>& row : products) {
        ofSeed.push_back(std::accumulate(row.begin(), row.end(), 0.0));
        all += ofSeed.back();
    }
    std::vector<double> without;
    for (const double own : ofSeed) without.push_back((all - 2.0 * own) / ((n - 1.0) * (n - 2.0)));
    const double standardError = (n - 1.0) * summarize(without).standardError;
    const double halfWidth = studentQuantile(0.95, n - 1.0) * standardError;
    const double mean = all / (n * (n - 1.0));
    return {mean, {mean - halfWidth, mean + halfWidth}, 0.0};
}

}  // namespace

std::optional<std::vector<Picture>> fitErrorPictures(const LoadedScene& loaded,
                                                     const FitErrorSettings& settings,
                                                     const std::function<bool()>& goOn) {
    std::vector<Picture> pictures;
    for (int seed = 0; seed < settings.seeds; ++seed) {
        std::optional<Picture> picture = pictureOf(loaded, settings, seed, goOn);
        if (!picture) return {};
        pictures.push_back(*std::move(picture));
    }
    return pictures;
}

FitImageError fitImageError(const std::vector<Picture>& exact, const std::vector<Picture>& fitted,
                            const FitErrorSettings& settings) {
    const auto count = static_cast<float>(exact.size());
    Picture reference(exact.front().size());
    std::vector<Picture> differences = fitted;
    for (std::size_t s = 0; s < exact.size(); ++s)
        for (std::size_t i = 0; i < reference.size(); ++i) {
            differences[s][i] -= exact[s][i];
            reference[i] += exact[s][i] / count;
        }
    FitImageError error = errorOf(productsOf(differences, reference));
    // About their own mean the pictures vary by (n − 1) / n of their variance.
    for (const Picture& picture : exact)
        error.noiseOfOneSample += imageErrors(picture, reference).relMseTrimmed * settings.samples /
                                  static_cast<double>(exact.size() - 1);
    return error;
}

}  // namespace etendue
