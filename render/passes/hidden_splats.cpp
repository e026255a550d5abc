// Which splats are wholly behind (or, for the back depth, wholly before) others.
//
// The picture is cut into cells of a quarter of a splat's radius. A cell that lies wholly inside a splat's
// disc is no deeper there than that splat's centre, so a splat whose nearest point is behind the nearest such
// centre in every cell it touches cannot be seen. The mirror image of this holds for the back depth.
#include <algorithm>
#include <cmath>

#include "render/passes/splats.h"

namespace slosh {
namespace {

/// A splat's disc in cells. An ellipse in the picture becomes a circle when cells are scaled with it.
struct Disc {
  glm::vec2 center;  ///< cells
  glm::vec2 radius;  ///< cells
};

class CellGrid {
 public:
  CellGrid(glm::ivec2 count, float empty)
      : count_(count), depth_(static_cast<std::size_t>(count.x) * count.y, empty) {}

  /// Calls visit(depth&) for each cell the disc touches; stops when it returns false.
  template <class Visit>
  void each_touched(const Disc& disc, Visit visit) {
    const glm::ivec2 low = clamp_cell(disc.center - disc.radius - kMargin);
    const glm::ivec2 high = clamp_cell(disc.center + disc.radius + kMargin);
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        if (!visit(depth_[static_cast<std::size_t>(y) * count_.x + x])) return;
      }
    }
  }

  /// Calls visit(depth&) for each cell that lies wholly inside the disc.
  template <class Visit>
  void each_covered(const Disc& disc, Visit visit) {
    const glm::ivec2 low = clamp_cell(disc.center - disc.radius);
    const glm::ivec2 high = clamp_cell(disc.center + disc.radius);
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        const glm::vec2 middle = glm::vec2(x, y) + 0.5f - disc.center;
        const glm::vec2 farthest = (glm::abs(middle) + 0.5f + kMargin) / disc.radius;
        if (glm::dot(farthest, farthest) < 1.0f) visit(depth_[static_cast<std::size_t>(y) * count_.x + x]);
      }
    }
  }

 private:
  /// Cells by which rounding on the GPU may move an edge.
  static constexpr float kMargin = 0.05f;

  glm::ivec2 clamp_cell(const glm::vec2& at) const {
    return glm::ivec2(glm::clamp(glm::floor(at), glm::vec2(0.0f), glm::vec2(count_ - 1)));
  }

  glm::ivec2 count_;
  std::vector<float> depth_;
};

}  // namespace

void leave_out_hidden(const Frame& frame, const RenderOptions& options, Splats& splats) {
  splats.back.clear();
  if (splats.spheres.empty()) return;
  const glm::mat4& projection = frame.view.projection;
  const float radius = options.splat_scale * frame.particle_radius;
  const glm::vec2 scale(projection[0][0], projection[1][1]);
  const glm::vec2 shift(projection[2][0], projection[2][1]);

  // Finer cells find more hidden splats but cost more here than they save there (bench_render).
  float farthest = 0.0f;
  for (const glm::vec4& sphere : splats.spheres) farthest = std::max(farthest, -sphere.z);
  const float smallest = 0.5f * static_cast<float>(options.height) * std::abs(scale.y) * radius / farthest;
  const float cell = std::max(0.25f * smallest, 1.5f);
  const glm::vec2 cells = glm::vec2(options.width, options.height) / cell;
  const glm::ivec2 count = glm::max(glm::ivec2(glm::ceil(cells)), glm::ivec2(1));

  const auto disc_of = [&](const glm::vec4& sphere) {
    const float depth = -sphere.z;
    const glm::vec2 center = (glm::vec2(sphere) * scale / depth - shift + 1.0f) * 0.5f * cells;
    return Disc{center, glm::abs(radius * scale / depth) * 0.5f * cells};
  };
  CellGrid front(count, kNoFluidDepth);
  CellGrid back(count, 0.0f);
  for (const glm::vec4& sphere : splats.spheres) {
    const Disc disc = disc_of(sphere);
    const float depth = -sphere.z;
    front.each_covered(disc, [&](float& nearest) { nearest = std::min(nearest, depth); });
    back.each_covered(disc, [&](float& deepest) { deepest = std::max(deepest, depth); });
  }

  // A hair's breadth for the depth bits that carry the fluid's index.
  const float slack = 1.0f + 1e-5f;
  for (const glm::vec4& sphere : splats.spheres) {
    const float far_side = -sphere.z + radius;
    bool shows = false;
    back.each_touched(disc_of(sphere), [&](float deepest) { return !(shows = far_side * slack >= deepest); });
    if (shows) splats.back.push_back(sphere);
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < splats.spheres.size(); ++i) {
    const glm::vec4 sphere = splats.spheres[i];
    const float near_side = -sphere.z - radius;
    bool shows = false;
    front.each_touched(disc_of(sphere),
                       [&](float nearest) { return !(shows = near_side <= nearest * slack); });
    if (!shows) continue;
    splats.spheres[kept] = sphere;
    splats.particles[kept++] = splats.particles[i];
  }
  splats.spheres.resize(kept);
  splats.particles.resize(kept);
}

}  // namespace slosh
