// Where the viewer looks from, on its way to a device's thread.
#pragma once

#include <glm/gtc/quaternion.hpp>

#include "net/triple_buffer.h"

namespace slosh {

/// One thread publishes, the device's takes; neither waits.
class CameraView {
 public:
  void publish(const glm::dquat& axes) {
    if (axes == last_) return;
    last_ = axes;
    buffer_.back() = axes;
    buffer_.publish();
  }
  /// The newest, or null when nothing came since the last call.
  const glm::dquat* news() { return buffer_.update() ? &buffer_.front() : nullptr; }

 private:
  TripleBuffer<glm::dquat> buffer_;
  glm::dquat last_{0.0, 0.0, 0.0, 0.0};  // the publisher's
};

}  // namespace slosh
