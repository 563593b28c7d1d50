#include "renderer/content_hash.h"

#include <xxhash.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <memory>

#include "config/config.h"

namespace etendue {

std::string contentHash(const std::vector<std::filesystem::path>& files,
                        const std::vector<std::string>& strings) {
    const std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state(XXH3_createState(),
                                                                         &XXH3_freeState);
    XXH3_128bits_reset(state.get());
    // A length before each piece, so that no two lists run together to the same bytes.
    const auto add = [&](const std::string& bytes) {
        const std::uint64_t size = bytes.size();
        XXH3_128bits_update(state.get(), &size, sizeof size);
        XXH3_128bits_update(state.get(), bytes.data(), bytes.size());
    };
    for (const std::filesystem::path& file : files) {
        std::ifstream in(file, std::ios::binary);
        std::string bytes{std::istreambuf_iterator<char>(in), {}};
        if (!in) throw missingFileError(file);
        add(bytes);
    }
    for (const std::string& s : strings) add(s);
    const XXH128_hash_t hash = XXH3_128bits_digest(state.get());
    std::array<char, 33> text{};
    std::snprintf(text.data(), text.size(), "%016llx%016llx",
                  static_cast<unsigned long long>(hash.high64),
                  static_cast<unsigned long long>(hash.low64));
    return text.data();
}

}  // namespace etendue
