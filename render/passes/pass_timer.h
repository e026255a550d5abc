// How long each pass of a frame takes.
#pragma once

#include <epoxy/gl.h>

#include <chrono>
#include <string>
#include <vector>

#include "render/renderer.h"

namespace slosh {

/// By timer queries on a GPU, which nobody waits for before the frame is over. A renderer on the CPU does its
/// work tile by tile over several passes, and its queries with it: there each pass is finished and the wall
/// clock read.
class PassTimer {
 public:
  explicit PassTimer(bool software) : software_(software) {}
  ~PassTimer();
  PassTimer(const PassTimer&) = delete;
  PassTimer& operator=(const PassTimer&) = delete;

  void begin(const char* pass);
  void end();
  /// The passes since the last call, in order. Waits for the GPU.
  std::vector<PassTime> take();

 private:
  bool software_;
  std::chrono::steady_clock::time_point start_;  // of the pass
  std::vector<PassTime> times_;
  std::vector<GLuint> queries_;  // one a pass at most in a frame; kept
};

}  // namespace slosh
