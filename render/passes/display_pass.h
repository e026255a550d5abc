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
  struct Wish {
    Display display = Display::kAces;
    ColorConfig color;
    DisplayBy by = DisplayBy::kSmaller;
    bool compute = false;  ///< by compute shaders
    bool operator==(const Wish&) const = default;
  };
  static Result<DisplayPass> create(const Wish& wish);
  /// Reads color; writes display, or sharp where edges follow. By compute shaders nobody reads what this and
  /// start_edges() write before gl::finish_compute().
  void start(const Targets& targets, float exposure, bool dither, bool edges_follow);
  /// Reads sharp; writes display. For compute.
  void start_edges(const Targets& targets);
  /// The same in main memory. `part`: what of sharp was written since the call before, where that is known.
  void smooth_edges(const Targets& targets, const std::optional<PixelBox>& part);
  bool is(const Wish& wish) const { return wish == wish_; }
  /// Whether by OpenColorIO's own text, not by the table.
  bool by_text() const { return table_.name() == 0; }

 private:
  gl::PixelProgram program_;
  gl::PixelProgram edges_;  ///< for compute
  gl::Texture table_;
  std::vector<std::uint8_t> sharp_;   ///< in main memory
  std::vector<std::uint8_t> smooth_;  ///< likewise, its edges smoothed
  std::vector<float> brightness_;
  Wish wish_;
};

}  // namespace slosh
