// The cache of lens fits: a lens is fitted once for a domain, and loaded from then on.
#pragma once

#include <functional>
#include <string>

#include "lens/fit_file.h"

namespace etendue {

/// $XDG_CACHE_HOME/etendue/fits, or ~/.cache/etendue/fits (XDG Base Directory Specification).
/// Empty when the environment names neither.
std::filesystem::path fitCacheDirectory();

/// The same where XDG_CACHE_HOME is `cacheHome`.
std::filesystem::path fitCacheIn(const std::filesystem::path& cacheHome);

/// Where in `directory` the fit for `key` belongs.
std::filesystem::path fitCacheFile(const std::filesystem::path& directory, const FitKey& key);

/// The fit from `directory`, else a new one, which is then kept there. `notice` hears in a sentence
/// what takes time or went wrong: a file refused, a fit begun, a fit that could not be kept;
/// `progress` how far the fit is.
LensFit cachedFit(const Prescription& prescription, const FitDomain& domain,
                  const FitSettings& settings, const std::filesystem::path& directory,
                  const std::function<void(const std::string&)>& notice = {},
                  const FitProgress& progress = {});

}  // namespace etendue
