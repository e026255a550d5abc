// Scene-linear light to the eight bits of the screen.
#pragma once

#include "render/gl/pixel_program.h"
#include "render/passes/targets.h"
#include "render/renderer.h"

namespace slosh {

class DisplayPass {
 public:
  /// `compute`: by compute shaders.
  static Result<DisplayPass> create(Display display, const ColorConfig& color, bool compute);
  /// Reads color; writes display, or sharp where smooth_edges follows.
  void draw(const Targets& targets, float exposure, bool dither, bool edges_follow);
  /// Reads sharp; writes display. `on_cpu`: where a CPU draws.
  void smooth_edges(const Targets& targets, bool on_cpu);
  bool shows(Display display, const ColorConfig& color, bool compute) const {
    return display == display_ && color == color_ && compute == program_.on_compute();
  }

 private:
  gl::PixelProgram program_;
  gl::PixelProgram edges_;
  gl::Texture table_;
  std::vector<std::uint8_t> sharp_;  ///< in main memory
  std::vector<float> brightness_;
  Display display_ = Display::kAces;
  ColorConfig color_;
};

}  // namespace slosh
