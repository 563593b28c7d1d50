#include "renderer/sobol.h"

#include <boost/random/sobol.hpp>
#include <vector>

namespace etendue {

namespace {

/// v_k of every dimension: the point of index 2^k.
std::array<std::array<std::uint32_t, sobolDimensions>, 32> directionNumbers() {
    // Boost counts its points in the order of Gray's code, from the second on: the one numbered
    // 2^k is that of index 2^k ⊕ 2^(k−1).
    boost::random::sobol_engine<std::uint32_t, 32> engine(sobolDimensions);
    std::array<std::array<std::uint32_t, sobolDimensions>, 32> directions{};
    for (std::size_t k = 0; k < 32; ++k) {
        engine.seed((std::uint32_t{1} << k) - 1);
        for (std::size_t d = 0; d < sobolDimensions; ++d)
            directions[k][d] = engine() ^ (k > 0 ? directions[k - 1][d] : 0u);
    }
    return directions;
}

std::array<SobolTable, sobolDimensions> makeTables() {
    const auto directions = directionNumbers();
    std::array<SobolTable, sobolDimensions> tables{};
    for (std::size_t d = 0; d < sobolDimensions; ++d)
        for (std::size_t byte = 0; byte < 4; ++byte)
            for (std::size_t value = 0; value < 256; ++value)
                for (std::size_t bit = 0; bit < 8; ++bit)
                    if (value >> bit & 1) tables[d][byte][value] ^= directions[8 * byte + bit][d];
    return tables;
}

}  // namespace

const std::array<SobolTable, sobolDimensions>& sobolTables() {
    static const std::array<SobolTable, sobolDimensions> tables = makeTables();
    return tables;
}

}  // namespace etendue
