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
  /// Called when front is drawn, before run(): a filter that works in main memory fetches it here, so that
  /// the driver draws other passes while it works.
  virtual void fetch(const Targets& targets) { (void)targets; }
  /// Reads targets.front, writes targets.smooth by turns, both cleared to no fluid before where on_gpu().
  /// Returns the index of the one that holds the surface, −1 = front itself.
  virtual int run(const Targets& targets, const RenderOptions& options, const Frame& frame,
                  const TileDraw& tiles) = 0;
  virtual bool on_gpu() const { return true; }
};

/// `on_cpu`: the quickest way where a CPU draws. Errors: a shader that the driver refuses.
Result<std::unique_ptr<SurfaceFilter>> make_surface_filter(Surface surface, bool on_cpu);

}  // namespace slosh
