// Tiles of a picture, the parts whose means are tested.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "statistics/picture_comparison.h"

namespace etendue {

/// Part of a picture, in one colour: the pixels from (x0, y0) up to but not (x1, y1).
struct Tile {
    int x0, y0, x1, y1;
    std::size_t color;
    int pixels() const { return (x1 - x0) * (y1 - y0); }
};

/// Row by row, each in R, G and B; those at the right and at the bottom may be smaller.
inline std::vector<Tile> tilesOf(int width, int height, int tileSize) {
    std::vector<Tile> tiles;
    for (int y = 0; y < height; y += tileSize)
        for (int x = 0; x < width; x += tileSize)
            for (std::size_t color = 0; color < 3; ++color)
                tiles.push_back(
                    {x, y, std::min(x + tileSize, width), std::min(y + tileSize, height), color});
    return tiles;
}

/// Of a picture that is `width` pixels wide.
inline double sumIn(const Tile& tile, const Picture& picture, int width) {
    double sum = 0.0;
    for (int y = tile.y0; y < tile.y1; ++y)
        for (int x = tile.x0; x < tile.x1; ++x)
            sum += static_cast<double>(
                picture[3 * static_cast<std::size_t>(y * width + x) + tile.color]);
    return sum;
}

}  // namespace etendue
