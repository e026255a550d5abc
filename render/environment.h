// Light from far away: a user's picture of a room, or one of our own, made ready for diffuse and mirrored
// light. No GL here.
#pragma once

#include <array>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "sim/math/result.h"

namespace slosh {

/// Radiance by direction, scene-linear Rec.709, as a latitude–longitude picture: rows from straight up to
/// straight down, columns round the vertical; the picture's middle is −z.
struct Environment {
  int width = 0;  ///< >= 2
  int height = 0;
  std::vector<glm::vec3> radiance;  ///< width · height

  /// Bilinear. direction: unit, world.
  glm::vec3 from(const glm::vec3& direction) const;
  /// Mean over all directions.
  glm::vec3 mean() const;
};

/// Most pixels of a file, and the largest width that is kept: a wider one is averaged down.
inline constexpr long kMaxEnvironmentPixels = 1L << 26;
inline constexpr int kKeptEnvironmentWidth = 1024;

/// A Radiance picture (.hdr: RGBE, "32-bit_rle_rgbe", rows from the top), of any brightness: it is scaled so
/// that its mean is that of the renderer's own studio, and a scene stays exposed. Errors: a file that is
/// missing, cut off, damaged or no such picture, or one of more than kMaxEnvironmentPixels.
Result<std::shared_ptr<const Environment>> read_environment(const std::filesystem::path& file);

/// A photographer's studio with soft boxes and a window, made by this function.
std::shared_ptr<const Environment> make_studio_environment();

/// An environment made ready for a renderer (Debevec 1998; Ramamoorthi & Hanrahan 2001; Karis 2013).
struct LightProbe {
  static constexpr int kSharp = 512;   ///< texels a side
  static constexpr int kBlurred = 48;  ///< of each layer
  static constexpr int kLayers = 5;    ///< roughness 0.2, 0.4, … 1

  std::vector<glm::vec3> sharp;        ///< kSharp², octahedral.glsl
  std::vector<glm::vec3> blurred;      ///< kBlurred² · kLayers: by GGX, seen along the mirror's way
  std::array<glm::vec3, 9> diffuse{};  ///< spherical harmonics of irradiance / π
};

LightProbe make_light_probe(const Environment& environment);

}  // namespace slosh
