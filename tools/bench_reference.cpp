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

std::string keyOf(const LoadedScene& loaded, const BenchReferenceSettings& settings) {
    return contentHash(
        {}, {loaded.hash, version, settings.estimator,
             fmt::format("{} {} {}", settings.seconds, loaded.film.width, loaded.film.height),
             loaded.camera->settings().isDispersive ? "dispersive" : "rgb"});
}

/// The parts of a reference, each with a seed of its own.
class Parts {
public:
    Parts(const LoadedScene& loaded, const BenchReferenceSettings& settings)
        : loaded_(loaded),
          filter_(loaded.film.filter, loaded.film.filterRadius),
          threads_(settings.threads) {
        estimator_ = makeEstimator(withKind(loaded.estimator, settings.estimator));
        films_.assign(partCount, Film(loaded.film.fullFrame(), {}, loaded.film.color));
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
        std::vector<Picture> pictures;
        for (const Film& film : films_) pictures.push_back(film.channels().front().pixels);
        return {meanPicture(pictures), std::uint64_t{partCount} * samples_, seconds_, {}};
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

struct CacheFiles {
    CacheFiles(const std::filesystem::path& directory, const std::string& key)
        : picture(directory / (key + ".exr")),
          variance(directory / (key + ".variance.exr")),
          facts(directory / (key + ".jsonl")) {}
    std::filesystem::path picture, variance;
    std::filesystem::path facts;  // written last: it is there if all is
};

Picture pixelsOf(const std::filesystem::path& file, const FilmSettings& film) {
    Image image = readImage(file);
    if (image.width != film.width || image.height != film.height || image.channels != 3)
        throw InputError(fmt::format("{}: expected {} × {} pixels in colour", file.string(),
                                     film.width, film.height));
    return std::get<std::vector<float>>(std::move(image.pixels));
}

/// Empty if it is not there. Throws if it is, but cannot be read.
std::optional<Reference> cached(const CacheFiles& files, const std::string& key,
                                const FilmSettings& film) {
    std::error_code error;
    if (!std::filesystem::exists(files.facts, error)) return {};
    const BenchRecords records = readBenchRecords(files.facts);
    if (records.references.empty() || records.references.front().key != key) return {};
    const BenchReference& facts = records.references.front();
    return Reference{{pixelsOf(files.picture, film), pixelsOf(files.variance, film), facts.relMse},
                     facts.samples,
                     facts.seconds,
                     key};
}

void keep(const CacheFiles& files, const Reference& reference, const FilmSettings& film) {
    std::error_code failed;  // which writing tells
    std::filesystem::create_directories(files.facts.parent_path(), failed);
    std::filesystem::remove(files.facts);  // of pictures that could not be read
    writeExr(files.picture, film.fullFrame(), {{{"R", "G", "B"}, reference.mean.pixels}}, {});
    writeExr(files.variance, film.fullFrame(), {{{"R", "G", "B"}, reference.mean.variance}}, {});
    appendRecord(files.facts, BenchReference{"", "", "", reference.key, reference.samples,
                                             reference.seconds, reference.mean.relMse});
}

std::optional<Reference> renderReference(const LoadedScene& loaded,
                                         const BenchReferenceSettings& settings,
                                         const std::function<bool(double)>& goOn) {
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
    return parts.mean();
}

}  // namespace

std::filesystem::path referenceCacheDirectory() {
    const std::filesystem::path fits = fitCacheDirectory();
    return fits.empty() ? fits : fits.parent_path() / "references";
}

std::optional<Reference> referenceFor(const LoadedScene& loaded,
                                      const BenchReferenceSettings& settings,
                                      const std::filesystem::path& directory,
                                      const std::function<bool(double)>& goOn,
                                      const std::function<void(const std::string&)>& notice) {
    const auto tell = [&](const std::string& sentence) {
        if (notice) notice(sentence);
    };
    const std::string key = keyOf(loaded, settings);
    const CacheFiles files(directory, key);
    try {
        if (!directory.empty())
            if (auto reference = cached(files, key, loaded.film)) return reference;
    } catch (const std::exception& error) {
        tell(std::string(error.what()) + "; the reference is rendered again");
    }
    std::optional<Reference> reference = renderReference(loaded, settings, goOn);
    if (!reference) return {};
    reference->key = key;
    try {
        if (!directory.empty()) keep(files, *reference, loaded.film);
    } catch (const std::exception& error) {
        tell(std::string("the reference is not kept: ") + error.what());
    }
    return reference;
}

}  // namespace etendue
