#include "scenes/make/paints.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
// After cstdio, which it needs.
#include <jpeglib.h>

namespace slosh::make {
namespace {

constexpr int kBoards = 6;
constexpr int kQuality = 85;

std::uint32_t scrambled(std::uint32_t x) {
  x = (x ^ (x >> 16)) * 0x7feb352du;
  x = (x ^ (x >> 15)) * 0x846ca68bu;
  return x ^ (x >> 16);
}

/// 0–1, of a point of a lattice.
double chance(int x, int y, int salt) {
  const std::uint32_t key = static_cast<std::uint32_t>(x) * 73856093u ^
                            static_cast<std::uint32_t>(y) * 19349663u ^
                            static_cast<std::uint32_t>(salt) * 83492791u;
  return scrambled(key) / 4294967295.0;
}

/// Value noise of `cells` lattice cells over a tile, which it repeats with. u, v: 0–1; 0–1.
double noise(double u, double v, glm::ivec2 cells, int salt) {
  const double x = u * cells.x, y = v * cells.y;
  const int left = static_cast<int>(std::floor(x)), low = static_cast<int>(std::floor(y));
  const auto at = [&](int dx, int dy) {
    const auto turn = [](int k, int n) { return (k % n + n) % n; };
    return chance(turn(left + dx, cells.x), turn(low + dy, cells.y), salt);
  };
  const double a = glm::smoothstep(0.0, 1.0, x - left), b = glm::smoothstep(0.0, 1.0, y - low);
  return glm::mix(glm::mix(at(0, 0), at(1, 0), a), glm::mix(at(0, 1), at(1, 1), a), b);
}

/// sRGB, 0–1.
glm::dvec3 wood(double u, double v) {
  const int board = static_cast<int>(v * kBoards);
  const double across = v * kBoards - board;  // of the board, 0–1
  const double shifted = u + chance(board, 0, 1);
  // Growth rings cut lengthwise: stripes along the board that wander, closer together towards one side.
  const double wander = noise(shifted, v, {3, 12}, 2) + 0.4 * noise(shifted, v, {9, 36}, 3);
  const double rings = (2.0 + 3.0 * chance(board, 0, 4)) * (across + 0.35 * wander + 0.4 * across * across);
  const double ring = 0.5 + 0.5 * std::sin(2.0 * glm::pi<double>() * rings);
  const double fibre = noise(shifted, v, {16, 256}, 5);
  const double pores = glm::smoothstep(0.74, 0.95, noise(shifted, v, {40, 384}, 6));
  glm::dvec3 color = glm::mix(glm::dvec3(0.64, 0.47, 0.32), glm::dvec3(0.57, 0.40, 0.265), ring * ring);
  color *= 0.90 + 0.12 * chance(board, 0, 7) + 0.10 * (fibre - 0.5) - 0.16 * pores;
  const double edge = std::min(across, 1.0 - across);
  return color * glm::mix(0.55, 1.0, glm::smoothstep(0.0, 0.022, edge));
}

/// sRGB, 0–1: glazed, with light joints.
glm::dvec3 tile(double u, double v) {
  const glm::dvec2 at = 4.0 * glm::dvec2(u, v);
  const glm::ivec2 which = glm::ivec2(at);
  const glm::dvec2 edge = glm::min(glm::fract(at), 1.0 - glm::fract(at));
  const double glazed = glm::smoothstep(0.015, 0.035, std::min(edge.x, edge.y));
  const glm::dvec3 color = glm::dvec3(0.66, 0.82, 0.84) * (0.92 + 0.1 * chance(which.x, which.y, 8));
  return glm::mix(glm::dvec3(0.90, 0.91, 0.89), color, glazed);
}

std::vector<std::uint8_t> packed(int side, glm::dvec3 (*color_at)(double u, double v)) {
  jpeg_compress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg.err = jpeg_std_error(&errors);
  jpeg_create_compress(&jpeg);
  unsigned char* file = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&jpeg, &file, &size);
  jpeg.image_width = jpeg.image_height = static_cast<JDIMENSION>(side);
  jpeg.input_components = 3;
  jpeg.in_color_space = JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, kQuality, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  std::vector<std::uint8_t> row(static_cast<std::size_t>(3 * side));
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const glm::dvec3 color = glm::clamp(color_at((x + 0.5) / side, (y + 0.5) / side), 0.0, 1.0);
      for (int c = 0; c < 3; ++c)
        row[static_cast<std::size_t>(3 * x + c)] = static_cast<std::uint8_t>(std::lround(255.0 * color[c]));
    }
    JSAMPROW line = row.data();
    jpeg_write_scanlines(&jpeg, &line, 1);
  }
  jpeg_finish_compress(&jpeg);
  std::vector<std::uint8_t> bytes(file, file + size);
  jpeg_destroy_compress(&jpeg);
  std::free(file);
  return bytes;
}

}  // namespace

std::vector<std::uint8_t> wood_picture() {
  return packed(512, wood);
}

std::vector<std::uint8_t> tile_picture() {
  return packed(256, tile);
}

void lay_flat(TriangleMesh& mesh, double tile) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 p = mesh.positions[i] / static_cast<float>(tile);
    const glm::vec3 n = glm::abs(mesh.normals[i]);
    mesh.texcoords.push_back(n.y > 0.5f   ? glm::vec2(p.x, p.z)
                             : n.x > 0.5f ? glm::vec2(p.z, p.y)
                                          : glm::vec2(p.x, p.y));
  }
}

}  // namespace slosh::make
