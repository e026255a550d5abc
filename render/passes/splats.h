// Particles made ready for splatting, on the CPU: what is on screen, and which tiles of the picture it
// touches. No GL here.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render/frame.h"
#include "render/renderer.h"

namespace slosh {

/// Pixels a side of the tiles by which the fluid's full-picture passes are confined.
inline constexpr int kTileSize = 16;

/// How far from a particle it may be drawn, m: ours makes wide ellipsoids of spheres.
float splat_reach(float particle_radius, const RenderOptions& options);

/// An ellipsoid as the eye sees it: with u a point of the unit disc, the outline's point is (u.x outline.x,
/// u.x outline.y + u.y outline.z) from the centre in the picture's plane there, and its depth is the centre's
/// plus dot(tilt, u) ± depth_radius √(1 − u²). m.
struct SplatShape {
  glm::vec3 outline{0.0f};
  float depth_radius = 0.0f;
  glm::vec2 tilt{0.0f};
  glm::vec2 unused{0.0f};  ///< as std430 aligns it
};

/// The ellipsoid of points p about `center` (eye axes, m, in front of the eye) with pᵀ matrix⁻¹ p = 1; matrix
/// m², positive definite. To first order in its size over its distance, as the eye's perspective has it.
SplatShape shape_of(const glm::mat3& matrix, const glm::vec3& center);

struct Splats {
  std::vector<glm::vec4> spheres;        ///< eye position m, FluidSample::index()
  std::vector<std::uint32_t> particles;  ///< which of the frame's each sphere is
  std::vector<SplatShape> shapes;        ///< of the spheres, in place of a radius; empty: they are spheres
  std::vector<glm::vec4> all;            ///< spheres with volume, before hidden ones were left out
  std::vector<glm::vec4> back;           ///< those that the back depth needs; empty: all of them
  std::vector<glm::vec2> tiles;  ///< clip-space corners of triangles over the tiles that fluid may touch
  bool empty() const { return spheres.empty(); }
};

/// Leaves out particles that are not finite, not of one of the frame's first 16 fluids, nearer than the near
/// plane, beyond the far plane or outside the picture. `out` keeps its memory from frame to frame.
void prepare_splats(const Frame& frame, const RenderOptions& options, Splats& out);

/// Drops from `splats.spheres` those that no pixel of the front depth can show, and puts into `splats.back`
/// those that the back depth may show: inner particles are most of a fluid. The pictures stay bitwise
/// identical. Worth its while where a CPU draws.
void leave_out_hidden(const Frame& frame, const RenderOptions& options, Splats& splats);

}  // namespace slosh
