// Scene-linear light to the eight bits of the screen.
#pragma once

#include "render/gl/objects.h"
#include "render/passes/targets.h"
#include "render/renderer.h"

namespace slosh {

class DisplayPass {
 public:
  static Result<DisplayPass> create(Display display, const ColorConfig& color);
  /// Reads color; writes display, or sharp where smooth_edges follows.
  void draw(const Targets& targets, float exposure, bool dither, bool edges_follow);
  /// Reads sharp; writes display. `on_cpu`: where a CPU draws.
  void smooth_edges(const Targets& targets, bool on_cpu);
  bool shows(Display display, const ColorConfig& color) const {
    return display == display_ && color == color_;
  }

 private:
  gl::Program program_;
  gl::Program edges_;
  gl::Texture table_;
  std::vector<std::uint8_t> sharp_;  ///< in main memory
  std::vector<float> brightness_;
  gl::VertexArray no_vertices_;
  Display display_ = Display::kAces;
  ColorConfig color_;
};

}  // namespace slosh
