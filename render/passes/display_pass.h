// Scene-linear light to the eight bits of the screen.
#pragma once

#include "render/gl/objects.h"
#include "render/passes/targets.h"
#include "render/renderer.h"

namespace slosh {

class DisplayPass {
 public:
  static Result<DisplayPass> create(Display display);
  /// Reads color; writes display.
  void draw(const Targets& targets, float exposure);
  Display display() const { return display_; }

 private:
  gl::Program program_;
  gl::Texture table_;
  gl::VertexArray no_vertices_;
  Display display_ = Display::kAces;
};

}  // namespace slosh
