// Whether two single pictures may have one mean, by what each says of its noise.
#pragma once

#include <cstddef>

#include "statistics/picture_comparison.h"

namespace etendue {

/// The tile and colour that differ the most.
struct TileZTest {
    double smallestP =
        1.0;             // over the tiles and the whole, each colour; to be compared with `level`
    double level = 0.0;  // per test, Šidák-corrected from 0.01 overall
    std::size_t tests = 0;
    int x = 0, y = 0, width = 0, height = 0;       // of the tile, in pixels
    int color = 0;                                 // 0 red, 1 green, 2 blue
    double difference = 0.0, standardError = 0.0;  // of its mean, picture − reference
    bool agree() const { return smallestP > level; }
};

/// `variance`: of each pixel's difference in each channel, independent of the others. Less to be
/// trusted than comparePictures(): a pixel that missed a rare bright path knows of no variance.
/// Differences that the rounding of floats explains count as none. std::invalid_argument for
/// pictures of two sizes.
TileZTest zTestOfTiles(const Picture& picture, const Picture& reference, const Picture& variance,
                       int width, int tileSize);

}  // namespace etendue
