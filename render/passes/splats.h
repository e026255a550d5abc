// Particles made ready for splatting, on the CPU: what is on screen, and which tiles of the picture it
// touches. No GL here.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "render/frame.h"
#include "render/renderer.h"

namespace slosh {

/// Pixels a side of the tiles by which the fluid's full-picture passes are confined.
inline constexpr int kTileSize = 16;

struct Splats {
  std::vector<glm::vec4> spheres;  ///< eye position m, index into Frame::fluids
  std::vector<glm::vec4> back;     ///< those that the back depth needs; empty: all of them
  std::vector<glm::vec2> tiles;    ///< clip-space corners of triangles over the tiles that fluid may touch
  bool empty() const { return spheres.empty(); }
};

/// Leaves out particles that are not finite, not of one of the frame's first 16 fluids, nearer than the near
/// plane, beyond the far plane or outside the picture. `out` keeps its memory from frame to frame.
void prepare_splats(const Frame& frame, const RenderOptions& options, Splats& out);

/// Drops from `splats.spheres` those that no pixel of the front depth can show, and puts into `splats.back`
/// those that the back depth may show: inner particles are most of a fluid. The pictures stay the same to the
/// bit. Worth its while where a CPU draws.
void leave_out_hidden(const Frame& frame, const RenderOptions& options, Splats& splats);

}  // namespace slosh
