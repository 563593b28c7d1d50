#include "renderer/content_hash.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <cstdint>
#include <fstream>
#include <new>

#include "config/config.h"

namespace etendue {

struct ByteHasher::State {
    XXH3_state_t* xxh3 = XXH3_createState();
};

ByteHasher::ByteHasher() : state_(std::make_unique<State>()) {
    if (!state_->xxh3) throw std::bad_alloc();
    XXH3_128bits_reset(state_->xxh3);
}

ByteHasher::~ByteHasher() { XXH3_freeState(state_->xxh3); }

void ByteHasher::add(const void* bytes, std::size_t size) {
    XXH3_128bits_update(state_->xxh3, bytes, size);
}

std::string ByteHasher::digest() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_->xxh3);
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

std::string contentHash(const std::vector<std::filesystem::path>& files,
                        const std::vector<std::string>& strings) {
    ByteHasher hasher;
    // A length before each piece, so that no two lists run together to the same bytes.
    const auto add = [&](const std::string& bytes) {
        const std::uint64_t size = bytes.size();
        hasher.add(&size, sizeof size);
        hasher.add(bytes.data(), bytes.size());
    };
    for (const std::filesystem::path& file : files) {
        std::ifstream in(file, std::ios::binary);
        std::string bytes{std::istreambuf_iterator<char>(in), {}};
        if (!in) throw missingFileError(file);
        add(bytes);
    }
    for (const std::string& s : strings) add(s);
    return hasher.digest();
}

}  // namespace etendue
