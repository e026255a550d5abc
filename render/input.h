// What a person did to the window since the last poll. Plain data: no GLFW types.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace slosh {

/// Keys the program may ask for; letters and digits by their US-layout place.
enum class Key : std::uint8_t {
  kEscape,
  kSpace,
  kEnter,
  kTab,
  kBackspace,
  kLeft,
  kRight,
  kUp,
  kDown,
  kPageUp,
  kPageDown,
  kHome,
  kEnd,
  kShift,
  kControl,
  kAlt,
  kA,
  kB,
  kC,
  kD,
  kE,
  kF,
  kG,
  kH,
  kI,
  kJ,
  kK,
  kL,
  kM,
  kN,
  kO,
  kP,
  kQ,
  kR,
  kS,
  kT,
  kU,
  kV,
  kW,
  kX,
  kY,
  kZ,
  k0,
  k1,
  k2,
  k3,
  k4,
  k5,
  k6,
  k7,
  k8,
  k9,
  kF1,
  kF2,
  kF3,
  kF4,
  kF5,
  kF6,
  kF7,
  kF8,
  kF9,
  kF10,
  kF11,
  kF12,
  kCount
};

enum class MouseButton : std::uint8_t { kLeft, kRight, kMiddle, kCount };

/// A key that went down, and what was held then.
struct KeyPress {
  Key key = Key::kEscape;
  bool shift = false;
};

/// State at the last poll. A headless context always reports the default state.
struct InputState {
  glm::vec2 mouse{0.0f};  ///< framebuffer pixels from the top left corner
  /// Pixels since the poll before; zero on the first, and while the pointer is outside the window without a
  /// drag
  glm::vec2 mouse_delta{0.0f};
  glm::vec2 scroll{0.0f};  ///< wheel notches since the poll before, +y away from the user
  std::array<bool, static_cast<std::size_t>(MouseButton::kCount)> buttons{};  ///< held
  std::array<bool, static_cast<std::size_t>(Key::kCount)> keys{};             ///< held
  /// What went down since the poll before, in that order: on a slow picture that may be several, and twice
  /// the same.
  std::vector<KeyPress> presses;
  bool hud_wants_mouse = false;     ///< the pointer is over a HUD panel: leave the camera alone
  bool hud_wants_keyboard = false;  ///< a HUD field is being typed into

  bool held(Key key) const { return keys[static_cast<std::size_t>(key)]; }
  bool held(MouseButton button) const { return buttons[static_cast<std::size_t>(button)]; }
};

}  // namespace slosh
