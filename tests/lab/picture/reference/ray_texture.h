// Textures as the path tracer reads them: in main memory, full size, no mipmaps.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "render/frame.h"
#include "tests/lab/picture/reference/ray_scene.h"

namespace slosh::reference {

class RayTexture {
 public:
  explicit RayTexture(const TextureImage& image);
  /// Linear, 0–1 a channel; bilinear unless the sampling says nearest.
  glm::vec4 at(const glm::vec2& texcoord) const;

 private:
  glm::vec4 texel(long x, long y) const;

  int width_;
  int height_;
  bool srgb_;
  TextureSampling sampling_;
  std::vector<std::uint8_t> rgba_;
};

/// A mesh's look where a ray met it, its maps multiplied in.
struct SurfaceLook {
  MeshLook look;
  glm::vec3 normal{0.0f};  ///< as Hit's, bent by the normal map
  float open = 1.0f;       ///< share of the light from all around
  bool hole = false;       ///< there is nothing here
};
SurfaceLook look_at(const Hit& hit, const std::vector<RayTexture>& textures);

}  // namespace slosh::reference
