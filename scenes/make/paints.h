// Pictures of surfaces, drawn by formula: what the shipped scenes' tables and pool are covered with.
#pragma once

#include <cstdint>
#include <vector>

#include "scenes/scene.h"

namespace slosh::make {

constexpr double kWoodTile = 0.6;  ///< m that a side of wood_picture() covers
constexpr double kTiles = 0.2;     ///< m that a side of tile_picture() covers

/// JPEGs of square pictures that repeat without a seam. Planed boards that lie along u; four by four tiles.
std::vector<std::uint8_t> wood_picture();
std::vector<std::uint8_t> tile_picture();

/// Texture coordinates straight down onto each face, `tile` m a side of the picture.
void lay_flat(TriangleMesh& mesh, double tile);

}  // namespace slosh::make
