// From the splats' depths to the fluid's surface: the one place where ways to smooth it differ.
#pragma once

#include <memory>

#include "render/gl/pixel_program.h"
#include "render/passes/targets.h"
#include "render/renderer.h"

namespace slosh {

class SurfaceFilter {
 public:
  virtual ~SurfaceFilter() = default;
  /// Called when front is drawn, before run(): a filter that works in main memory fetches it here, so that
  /// the driver draws other passes while it works.
  virtual void fetch(const Targets& targets) { (void)targets; }
  /// By fragments or in main memory. Reads targets.front, writes targets.smooth by turns, both cleared to no
  /// fluid before where writes_tiles(). Returns the index of the one that holds the surface, −1 = front
  /// itself.
  virtual int run(const Targets& targets, const RenderOptions& options, const Frame& frame,
                  const gl::TileDraw& tiles);
  /// How many turns it takes, and turn `i` of them by itself, of which nobody reads before
  /// gl::finish_compute() where compute shaders draw: the first reads front, each writes smooth[i % 2].
  virtual int turns(const RenderOptions& options) const {
    (void)options;
    return 0;
  }
  virtual void start_turn(int i, const Targets& targets, const RenderOptions& options, const Frame& frame,
                          const gl::TileDraw& tiles);
  /// Only the tiles that fluid may cover are written by run().
  virtual bool writes_tiles() const { return true; }
};

/// `compute`: by compute shaders; else ours in main memory, with fewer taps where `fast`, the others by
/// fragments. Errors: a shader that the driver refuses.
Result<std::unique_ptr<SurfaceFilter>> make_surface_filter(Surface surface, bool fast, bool compute);

}  // namespace slosh
