// Pictures for textures: PNG (libpng) and JPEG (libjpeg) to pixels. Nothing of them is taken on trust.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh::images {

inline constexpr int kLargestSide = 8192;             ///< pixels
inline constexpr std::size_t kMaxPixels = 64u << 20;  ///< of all images of one scene together

/// What a picture says of itself before it is unpacked.
struct Facts {
  const char* format = "";  ///< "PNG" or "JPEG"
  int width = 0;            ///< 1–kLargestSide
  int height = 0;
  std::size_t pixels() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Eight bits a channel as the file has them (sRGB or numbers: whoever reads them knows), rows from the top
/// down.
struct Pixels {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;  ///< 4 · width · height; alpha 255 where the picture has none
};

/// Reads the head alone. `name` begins errors. Errors: neither PNG nor JPEG, cut off in its head, larger than
/// kLargestSide.
Result<Facts> look_at(std::span<const std::uint8_t> bytes, const std::string& name);

/// Unpacks it: 16 bits become 8, palettes, grey and missing alpha are filled in; a PNG's gamma and colour
/// profile are passed over, as glTF has it. A bomb costs no more than its pixels: the size is known and
/// limited beforehand, a JPEG's passes over its picture are counted, what a PNG packs beside its pixels is
/// not unpacked. Errors: as look_at; cut off or damaged.
Result<Pixels> decode(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace slosh::images
