#include "render/passes/splats.h"

#include <algorithm>
#include <cmath>

#include "render/passes/frame_block.h"
#include "render/passes/particle_cells.h"
#include "render/shader_math.h"

namespace slosh {
namespace {

/// Reach of a splat that smooth_centers shapes, over that of the sphere it was.
constexpr float kWidest = 2.15f;

/// Which tiles are touched, a flag a tile.
class TileGrid {
 public:
  TileGrid(int width, int height)
      : picture_(width, height),
        count_((width + kTileSize - 1) / kTileSize, (height + kTileSize - 1) / kTileSize),
        touched_(static_cast<std::size_t>(count_.x) * count_.y, 0) {}

  /// Pixels from the bottom left; clipped to the picture.
  void touch(const glm::vec2& low, const glm::vec2& high) {
    const glm::ivec2 first = glm::clamp(glm::ivec2(low) / kTileSize, glm::ivec2(0), count_ - 1);
    const glm::ivec2 last = glm::clamp(glm::ivec2(high) / kTileSize, glm::ivec2(0), count_ - 1);
    for (int y = first.y; y <= last.y; ++y) {
      std::fill(&touched_[index(first.x, y)], &touched_[index(last.x, y)] + 1, std::uint8_t{1});
    }
  }

  /// Two triangles for each run of touched tiles in a row.
  void append_triangles(std::vector<glm::vec2>& out) const {
    for (int y = 0; y < count_.y; ++y) {
      for (int x = 0; x < count_.x; ++x) {
        if (!touched_[index(x, y)]) continue;
        const int start = x;
        while (x < count_.x && touched_[index(x, y)]) ++x;
        const glm::vec2 low = clip(start, y);
        const glm::vec2 high = clip(x, y + 1);
        for (const glm::vec2& corner : {low, {high.x, low.y}, high, low, high, {low.x, high.y}})
          out.push_back(corner);
      }
    }
  }

 private:
  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * count_.x + x; }
  glm::vec2 clip(int x, int y) const {
    return 2.0f * glm::vec2(glm::min(glm::ivec2(x, y) * kTileSize, picture_)) / glm::vec2(picture_) - 1.0f;
  }

  glm::ivec2 picture_;
  glm::ivec2 count_;
  std::vector<std::uint8_t> touched_;
};

}  // namespace

SplatShape shape_of(const glm::mat3& matrix, const glm::vec3& center) {
  const shader::EllipsoidOutline shape = shader::ellipsoid_outline(matrix, center);
  return {shape.outline, shape.depth_radius, shape.tilt, {}};
}

float splat_reach(float particle_radius, const RenderOptions& options) {
  return options.splat_scale * particle_radius * (options.surface == Surface::kOurs ? kWidest : 1.0f);
}

void prepare_splats(const Frame& frame, const RenderOptions& options, Splats& out) {
  out.spheres.clear();
  out.particles.clear();
  out.shapes.clear();
  out.back.clear();
  out.tiles.clear();
  const std::size_t count = std::min(frame.particles.size(), frame.particle_fluid.size());
  const std::size_t fluids = std::min(frame.fluids.size(), kMaxFluidLooks);
  const float radius = splat_reach(frame.particle_radius, options);
  if (count == 0 || fluids == 0 || !(radius > 0.0f) || !std::isfinite(radius)) return;

  const glm::mat4& projection = frame.view.projection;
  const glm::vec2 scale(projection[0][0], projection[1][1]);
  const glm::vec2 shift(projection[2][0], projection[2][1]);
  const glm::vec2 half_picture = 0.5f * glm::vec2(options.width, options.height);
  TileGrid tiles(options.width, options.height);
  for (std::size_t i = 0; i < count; ++i) {
    const FluidSample sample = fluid_sample(frame.particle_fluid[i]);
    if (sample.fluid >= fluids) continue;
    const glm::vec3 eye(frame.view.view * glm::vec4(frame.particles[i], 1.0f));
    const float depth = -eye.z;
    // Written so that a NaN fails each comparison.
    if (!(depth > frame.view.near_plane && depth < frame.view.far_plane)) continue;
    const glm::vec2 center = glm::vec2(eye) * scale / depth - shift;
    const glm::vec2 reach = glm::abs(radius * scale / depth);
    if (!(std::abs(center.x) < 1.0f + reach.x && std::abs(center.y) < 1.0f + reach.y)) continue;
    out.spheres.emplace_back(eye, sample.index());
    out.particles.push_back(static_cast<std::uint32_t>(i));
    const glm::vec2 low = glm::max((center - reach + 1.0f) * half_picture, glm::vec2(0.0f));
    tiles.touch(low, glm::min((center + reach + 1.0f) * half_picture, 2.0f * half_picture));
  }
  tiles.append_triangles(out.tiles);
}

}  // namespace slosh
