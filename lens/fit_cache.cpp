#include "lens/fit_cache.h"

#include <cstdlib>
#include <iomanip>
#include <sstream>

#include "lens/hash.h"

namespace etendue {

std::filesystem::path fitCacheDirectory() {
    const char* cache = std::getenv("XDG_CACHE_HOME");
    if (cache && std::filesystem::path(cache).is_absolute()) return fitCacheIn(cache);
    const char* home = std::getenv("HOME");
    if (home && *home) return fitCacheIn(std::filesystem::path(home) / ".cache");
    return {};
}

std::filesystem::path fitCacheIn(const std::filesystem::path& cacheHome) {
    return cacheHome / "etendue" / "fits";
}

std::filesystem::path fitCacheFile(const std::filesystem::path& directory, const FitKey& key) {
    const FitDomain& d = key.domain;
    const FitSettings& s = key.settings;
    std::ostringstream all;
    all << std::hexfloat;
    for (const double number :
         {d.sensorHalfSizeMm.x(), d.sensorHalfSizeMm.y(), d.imageRadiusMm, d.sensorDistanceMm,
          d.apertureRadiusMm, d.shortestWavelengthNm, d.longestWavelengthNm, d.sensorTravelMm})
        all << number << ' ';
    for (const int number : {static_cast<int>(s.form), static_cast<int>(s.basis), s.terms, s.degree,
                             s.raysPerCandidate, s.refinements, s.clip.terms, s.clip.degree,
                             static_cast<int>(s.clip.rays), key.algorithm})
        all << number << ' ';
    std::ostringstream name;
    name << std::hex << std::setfill('0') << std::setw(16) << key.prescriptionHash << '-'
         << std::setw(16) << fnv1a(all.str()) << ".json";
    return directory / name.str();
}

LensFit cachedFit(const Prescription& prescription, const FitDomain& domain,
                  const FitSettings& settings, const std::filesystem::path& directory,
                  const std::function<void(const std::string&)>& notice,
                  const FitProgress& progress) {
    const auto tell = [&](const std::string& sentence) {
        if (notice) notice(sentence);
    };
    const FitKey key = fitKey(prescription, domain, settings);
    const std::filesystem::path file = fitCacheFile(directory, key);
    std::error_code failed;
    if (!directory.empty() && std::filesystem::exists(file, failed)) {
        FitFileContent content = readFitFile(file, key);
        if (content.fit) return *std::move(content.fit);
        tell(content.refusal + "; it is fitted again");
    }
    tell("fitting " + prescription.name);
    LensFit fit = fitLens(prescription, domain, settings, progress);
    if (directory.empty()) return fit;
    try {
        std::filesystem::create_directories(directory, failed);
        removeStaleParts(directory);
        writeFitFile(file, fit);
    } catch (const std::runtime_error& error) {
        tell(std::string("the fit is not kept: ") + error.what());
    }
    return fit;
}

}  // namespace etendue
