#include "tools/bench_reference.h"

#include <fmt/format.h>

#include <chrono>

#include "lens/fit_cache.h"
#include "renderer/content_hash.h"
#include "renderer/render.h"
#include "tools/bench_records.h"
#include "tools/version.h"

namespace etendue {

namespace {

constexpr int partCount = 16;
/// Far from those of any benchmark, which count from zero.
constexpr std::uint64_t firstSeed = 0x7265666572656e63;

std::string keyOf(const LoadedScene& loaded, const ReferenceSettings& settings) {
    return contentHash(
        {}, {loaded.hash, version, settings.estimator,
             fmt::format("{} {} {}", settings.seconds, loaded.film.width, loaded.film.height),
             loaded.camera->settings().isDispersive ? "dispersive" : "rgb"});
}

/// The parts of a reference, each with a seed of its own.
class Parts {
public:
    Parts(const LoadedScene& loaded, const ReferenceSettings& settings)
        : loaded_(loaded),
          filter_(loaded.film.filter, loaded.film.filterRadius),
          threads_(settings.threads) {
        EstimatorSettings estimator = loaded.estimator;
        estimator.kind = settings.estimator;
        estimator.techniques = {};
        estimator_ = makeEstimator(estimator);
        const FrameWindow window{loaded.film.width, loaded.film.height, 0, 0,
                                 loaded.film.width, loaded.film.height};
        films_.assign(partCount, Film(window, {}, loaded.film.color));
    }

    /// Gives every part `count` more samples; false if given up.
    bool add(std::uint32_t count, const std::function<bool()>& goOn) {
        for (std::size_t i = 0; i < films_.size(); ++i) {
            RenderSettings settings;
            settings.firstSample = samples_;
            settings.samples = count;
            settings.seed = firstSeed + i;
            settings.sampler = Sampler::sobol;
            settings.threads = threads_;
            const RenderResult result =
                render(*loaded_.scene, *loaded_.camera, *estimator_, filter_, films_[i], settings,
                       [&](const RenderProgress&) { return goOn(); });
            seconds_ += result.seconds;
            if (result.wasInterrupted || !goOn()) return false;
        }
        samples_ += count;
        return true;
    }

    std::uint32_t samples() const { return samples_; }
    double seconds() const { return seconds_; }

    Reference mean() const {
        Reference reference;
        std::vector<double> sum, squares;
        for (const Film& film : films_) {
            const std::vector<float> pixels = film.channels().front().pixels;
            sum.resize(pixels.size());
            squares.resize(pixels.size());
            for (std::size_t i = 0; i < pixels.size(); ++i) {
                sum[i] += pixels[i];
                squares[i] += static_cast<double>(pixels[i]) * pixels[i];
            }
        }
        constexpr double n = partCount;
        for (std::size_t i = 0; i < sum.size(); ++i) {
            const double mean = sum[i] / n;
            reference.picture.push_back(static_cast<float>(mean));
            reference.variance.push_back(
                static_cast<float>(std::max(0.0, squares[i] / n - mean * mean) / (n - 1.0)));
        }
        reference.samples = static_cast<std::uint64_t>(partCount) * samples_;
        reference.seconds = seconds_;
        return reference;
    }

private:
    const LoadedScene& loaded_;
    Filter filter_;
    int threads_;
    std::unique_ptr<Estimator> estimator_;
    std::vector<Film> films_;
    std::uint32_t samples_ = 0;  // of each part
    double seconds_ = 0.0;
};

/// Of the estimate, whose variance is known: the expectation of (a − r)² / (r² + 0.01).
double expectedRelMse(const Reference& reference) {
    double sum = 0.0;
    for (std::size_t i = 0; i < reference.picture.size(); ++i) {
        const double r = reference.picture[i];
        sum += reference.variance[i] / (r * r + 0.01);
    }
    return sum / static_cast<double>(reference.picture.size());
}

struct CacheFiles {
    CacheFiles(const std::filesystem::path& directory, const std::string& key)
        : picture(directory / (key + ".exr")),
          variance(directory / (key + ".variance.exr")),
          facts(directory / (key + ".jsonl")) {}
    std::filesystem::path picture, variance;
    std::filesystem::path facts;  // written last: it is there if all is
};

Picture pixelsOf(const std::filesystem::path& file) {
    return std::get<std::vector<float>>(readImage(file).pixels);
}

std::optional<Reference> cached(const CacheFiles& files, const std::string& key) {
    std::error_code error;
    if (!std::filesystem::exists(files.facts, error)) return {};
    const BenchRecords records = readBenchRecords(files.facts);
    if (records.references.empty() || records.references.front().key != key) return {};
    const BenchReference& facts = records.references.front();
    return Reference{pixelsOf(files.picture),
                     pixelsOf(files.variance),
                     facts.samples,
                     facts.seconds,
                     facts.relMse,
                     key};
}

void keep(const CacheFiles& files, const Reference& reference, const FilmSettings& film) {
    std::filesystem::create_directories(files.facts.parent_path());
    const FrameWindow window{film.width, film.height, 0, 0, film.width, film.height};
    writeExr(files.picture, window, {{{"R", "G", "B"}, reference.picture}}, {});
    writeExr(files.variance, window, {{{"R", "G", "B"}, reference.variance}}, {});
    appendRecord(files.facts, BenchReference{"", "", "", reference.key, reference.samples,
                                             reference.seconds, reference.relMse});
}

}  // namespace

std::filesystem::path referenceCacheDirectory() {
    const std::filesystem::path fits = fitCacheDirectory();
    return fits.empty() ? fits : fits.parent_path() / "references";
}

std::optional<Reference> referenceFor(const LoadedScene& loaded, const ReferenceSettings& settings,
                                      const std::filesystem::path& directory,
                                      const std::function<bool(double)>& goOn) {
    const std::string key = keyOf(loaded, settings);
    const CacheFiles files(directory, key);
    if (!directory.empty())
        if (auto reference = cached(files, key)) return reference;
    Parts parts(loaded, settings);
    const auto start = std::chrono::steady_clock::now();
    const auto listen = [&] {
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
        return goOn(std::min(1.0, spent.count() / settings.seconds));
    };
    // Each round costs half of what was spent before: enough of them to end near the time, few
    // enough that their number does not cost.
    while (parts.samples() == 0 || 1.25 * parts.seconds() < settings.seconds)
        if (!parts.add(std::max(1u, parts.samples() / 2), listen)) return {};
    Reference reference = parts.mean();
    reference.relMse = expectedRelMse(reference);
    reference.key = key;
    if (!directory.empty()) keep(files, reference, loaded.film);
    return reference;
}

}  // namespace etendue
