// What can be done in the window, said in the window: hints until they were followed, all keys on H, short
// notices.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "peer/settings/key_bindings.h"
#include "peer/view/hud/panels.h"

namespace slosh {

/// What the guide has to know of the moment.
struct GuideFacts {
  bool can_grab = false;       ///< hands are lent: the mouse may take them
  bool mouse_is_hand = false;  ///< --device mouse: the pointer is the handle
  bool shared = false;         ///< others may hold grips too
  bool may_change = false;     ///< pausing, starting again, viscosity and gravity
  bool may_pace = false;       ///< slow motion and single steps
  bool paused = false;
  std::size_t hands = 0;  ///< that anything is felt of
  double pace = 1.0;
  bool holding = false;           ///< a thing is held with the mouse right now
  bool taken = false;             ///< hands were taken and not given back
  std::string over;               ///< what a press would take, in words; empty = nothing
  std::optional<glm::vec2> mark;  ///< framebuffer pixels: a ring is drawn about what is held or may be
};

/// On the drawing thread; draw() inside Frame::hud.
class WindowGuide {
 public:
  explicit WindowGuide(KeyBindings keys = {}) : keys_(std::move(keys)) {}

  bool show_all = false;

  /// What was done once needs no hint any more.
  enum class Used { kGrab, kTilt, kGiveBack, kKeys };
  void note(Used used) { used_[static_cast<std::size_t>(used)] = true; }
  /// A line that stays for some seconds.
  void say(std::string text, double wall_seconds);

  /// `taken`: other panels, which the line at the bottom keeps clear of.
  void draw(const GuideFacts& facts, double wall_seconds, std::span<const Rect> taken);
  /// The line at the bottom: what matters now and was not done yet; empty when there is nothing to say.
  std::string hint(const GuideFacts& facts) const;
  /// Every key that does something here, a line each.
  static std::string all_keys(const GuideFacts& facts, const KeyBindings& keys = {});

 private:
  KeyBindings keys_;
  bool used_[4] = {};
  std::string said_;
  double until_ = 0.0;  // wall s
  glm::vec2 hint_at_{-1.0f};
};

}  // namespace slosh
