// A picture in main memory, and PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "sim/math/result.h"

namespace slosh {

/// Eight-bit sRGB with alpha, rows from the top down, no padding.
struct Image {
  int width = 0;                   ///< pixels
  int height = 0;                  ///< pixels
  std::vector<std::uint8_t> rgba;  ///< 4 · width · height
};

/// One float a pixel, rows from the top down: an intermediate buffer of the renderer, for tests.
struct FloatImage {
  int width = 0;
  int height = 0;
  int channels = 1;
  std::vector<float> values;  ///< channels · width · height

  float at(int x, int y, int channel = 0) const {
    return values[static_cast<std::size_t>(channels) * (static_cast<std::size_t>(y) * width + x) + channel];
  }
};

/// Two pictures of one height, `left` at the left.
Image side_by_side(const Image& left, const Image& right);

/// Writes `image` as a PNG, alpha included, and returns the path. Errors: an empty or inconsistent image, a
/// file that cannot be written. A file that could not be written whole is removed.
Result<std::filesystem::path> write_png(const std::filesystem::path& path, const Image& image);

/// Reads any PNG as RGBA8. Errors: a missing or damaged file.
Result<Image> read_png(const std::filesystem::path& path);

}  // namespace slosh
