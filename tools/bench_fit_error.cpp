#include "tools/bench_fit_error.h"

#include <numeric>

#include "renderer/render.h"
#include "statistics/picture_comparison.h"
#include "statistics/statistics.h"

namespace etendue {

namespace {

std::optional<Picture> pictureOf(const LoadedScene& loaded, const FitErrorSettings& settings,
                                 int seed, const std::function<bool()>& goOn) {
    Film film({loaded.film.width, loaded.film.height, 0, 0, loaded.film.width, loaded.film.height},
              {}, loaded.film.color);
    EstimatorSettings estimator = loaded.estimator;
    estimator.kind = "pt";
    RenderSettings render;
    render.samples = settings.samples;
    render.seed = static_cast<std::uint64_t>(seed);
    render.threads = settings.threads;
    const RenderResult result =
        etendue::render(*loaded.scene, *loaded.camera, *makeEstimator(estimator),
                        Filter(loaded.film.filter, loaded.film.filterRadius), film, render,
                        [&](const RenderProgress&) { return goOn(); });
    if (result.wasInterrupted) return {};
    return film.channels().front().pixels;
}

using Matrix = std::vector<std::vector<double>>;

/// Mean over the pixels of d_i d_j / (r² + 0.01), of different i and j; the rest is zero.
Matrix productsOf(const std::vector<Picture>& differences, const Picture& reference) {
    const std::size_t count = differences.size();
    Matrix products(count, std::vector<double>(count));
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = 0; j < i; ++j) {
            double sum = 0.0;
            for (std::size_t p = 0; p < reference.size(); ++p) {
                const double r = reference[p];
                sum += static_cast<double>(differences[i][p]) * differences[j][p] / (r * r + 0.01);
            }
            products[i][j] = products[j][i] = sum / static_cast<double>(reference.size());
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
    return {mean, {mean - halfWidth, mean + halfWidth}};
}

}  // namespace

std::optional<FitImageError> fitImageError(const LoadedScene& traced, const LoadedScene& fitted,
                                           const FitErrorSettings& settings,
                                           const std::function<bool()>& goOn) {
    const auto count = static_cast<std::size_t>(settings.seeds);
    std::vector<Picture> differences;
    Picture reference;
    for (int seed = 0; seed < settings.seeds; ++seed) {
        const std::optional<Picture> exact = pictureOf(traced, settings, seed, goOn);
        std::optional<Picture> picture =
            exact ? pictureOf(fitted, settings, seed, goOn) : std::nullopt;
        if (!picture) return {};
        reference.resize(exact->size());
        for (std::size_t i = 0; i < exact->size(); ++i) {
            (*picture)[i] -= (*exact)[i];
            reference[i] += (*exact)[i] / static_cast<float>(count);
        }
        differences.push_back(std::move(*picture));
    }
    return errorOf(productsOf(differences, reference));
}

}  // namespace etendue
