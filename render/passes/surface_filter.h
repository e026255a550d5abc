// From the splats' depths to the fluid's surface: the one place where ways to smooth it differ.
#pragma once

#include <memory>

#include "render/gl/objects.h"
#include "render/passes/targets.h"
#include "render/renderer.h"

namespace slosh {

/// The tiles of the picture that fluid may cover, ready to be drawn by a program with tiles.vert.
struct TileDraw {
  const gl::VertexArray* vertices = nullptr;
  GLsizei corners = 0;
  void operator()() const;
};

class SurfaceFilter {
 public:
  virtual ~SurfaceFilter() = default;
  /// Reads targets.front, writes targets.smooth by turns, both cleared to no fluid before. Returns the index
  /// of the one that holds the surface, −1 = front itself.
  virtual int run(const Targets& targets, const RenderOptions& options, const Frame& frame,
                  const TileDraw& tiles) = 0;
};

/// `fast`: fewer taps, for a CPU. Errors: a shader that the driver refuses.
Result<std::unique_ptr<SurfaceFilter>> make_surface_filter(Surface surface, bool fast);

}  // namespace slosh
