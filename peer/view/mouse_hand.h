// From mouse movements in the window to where the mouse device's handle should be.
#pragma once

#include "peer/haptics/mouse_device.h"
#include "peer/view/orbit_camera.h"
#include "render/input.h"

namespace slosh {

/// Moves in the picture's plane with the mouse, in depth with the wheel, and turns with the right button
/// held. On the window's thread.
class MouseHand {
 public:
  explicit MouseHand(const Pose& start) : wanted_(start) {}

  /// True when the handle is to move.
  bool follow(const InputState& input, const OrbitCamera& camera, int picture_height) {
    if (input.hud_wants_mouse || input.held(MouseButton::kLeft)) return false;
    // A pixel at the handle's own depth, so that the handle stays under the pointer.
    const double depth = glm::max(glm::dot(wanted_.position - camera.eye(), camera.forward()), 0.01);
    const double metres = camera.height_at_target() * depth / camera.distance() / glm::max(picture_height, 1);
    const glm::dvec2 moved(input.mouse_delta);
    if (input.held(MouseButton::kRight)) {
      const glm::dvec3 turn = kTurnPerPixel * (moved.x * camera.up() + moved.y * camera.right());
      wanted_.orientation = rotate_by(wanted_.orientation, turn);
    } else {
      wanted_.position += metres * (moved.x * camera.right() - moved.y * camera.up());
    }
    wanted_.position += kDepthPerNotch * camera.distance() * input.scroll.y * camera.forward();
    return moved != glm::dvec2(0.0) || input.scroll.y != 0.0f;
  }
  const Pose& wanted() const { return wanted_; }

 private:
  static constexpr double kTurnPerPixel = 0.006;   // rad
  static constexpr double kDepthPerNotch = 0.015;  // of the eye's distance
  Pose wanted_;
};

}  // namespace slosh
