// Scene-linear light to the eight bits of the screen.
#pragma once

#include <optional>

#include "render/gl/pixel_program.h"
#include "render/passes/kept_picture.h"
#include "render/passes/targets.h"
#include "render/renderer.h"

namespace slosh {

class DisplayPass {
 public:
  /// `compute`: by compute shaders.
  static Result<DisplayPass> create(Display display, const ColorConfig& color, bool compute);
  /// Reads color; writes display, or sharp where smooth_edges follows.
  void draw(const Targets& targets, float exposure, bool dither, bool edges_follow);
  /// Reads sharp; writes display. `on_cpu`: where a CPU draws; then `part` may say what of sharp was written
  /// since the call before.
  void smooth_edges(const Targets& targets, bool on_cpu, const std::optional<PixelBox>& part = std::nullopt);
  bool shows(Display display, const ColorConfig& color, bool compute) const {
    return display == display_ && color == color_ && compute == program_.on_compute();
  }

 private:
  gl::PixelProgram program_;
  gl::PixelProgram edges_;
  gl::Texture table_;
  std::vector<std::uint8_t> sharp_;   ///< in main memory
  std::vector<std::uint8_t> smooth_;  ///< likewise, its edges smoothed
  std::vector<float> brightness_;
  Display display_ = Display::kAces;
  ColorConfig color_;
};

}  // namespace slosh
