// Which key of the window does what.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/input.h"
#include "sim/math/result.h"

namespace slosh {

/// What a key may do in the window.
enum class WindowAction : std::uint8_t {
  kEnd,
  kAgain,
  kHelp,
  kCameraBack,
  kPause,
  kGrip,
  kSliders,
  kGiveBack,
  kStep,
  kSlower,
  kFaster,
  kPicture,
  kParticles,
  kAxes,
  kForces,
  kView1,
  kView2,
  kView3,
  kView4,
  kCount
};

struct WindowActionWords {
  WindowAction action;
  const char* name;  ///< as the settings have it
  const char* keys;  ///< by default, "+" between several
  const char* text;  ///< a few words
};
std::span<const WindowActionWords> window_actions();

/// "Space", "PageUp", "A", "7", "F5"; letters and digits by their US-layout place.
std::string name_of(Key key);
/// Upper and lower case are one. Shift, Ctrl and Alt go with other keys and with the mouse: they are none
/// here.
std::optional<Key> key_named(const std::string& name);

/// An action with keys of somebody's own choice; none: no key does it.
struct KeyChoice {
  WindowAction action;
  std::vector<Key> keys;
};
/// "pause=Space", "end=Escape+Q", "axes=" (no key). Errors: an unknown action or key, with the nearest.
Result<KeyChoice> parse_key_choice(const std::string& text);

class KeyBindings {
 public:
  /// Those that there are by default.
  KeyBindings();
  /// The same, but for `choices`, each as parse_key_choice() takes it. Errors: its; an action twice; a key
  /// that would do two things.
  static Result<KeyBindings> make(const std::vector<std::string>& choices);

  std::optional<WindowAction> action_of(Key key) const;
  const std::vector<Key>& keys_of(WindowAction action) const {
    return keys_[static_cast<std::size_t>(action)];
  }
  /// "Esc, Q"; "no key" where there is none.
  std::string shown(WindowAction action) const;

 private:
  std::array<std::vector<Key>, static_cast<std::size_t>(WindowAction::kCount)> keys_;
};

}  // namespace slosh
