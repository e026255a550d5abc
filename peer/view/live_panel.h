// Sliders over the picture for what can be changed while the world runs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace slosh {

/// What can be changed live, as it is.
struct LiveValues {
  bool may_change = false;          ///< viscosity and gravity are this person's to change
  double gravity_scale = 1.0;       ///< times the scene's, 0–2
  std::vector<double> viscosities;  ///< Pa·s, one a fluid
  bool may_pace = false;            ///< the world is this person's own: slow motion, single steps
  double pace = 1.0;                ///< simulated s a wall s at most
  int filter = 0;  ///< turns of the surface's filter, 0–64: 0 shows the balls that particles are
};

/// One value that somebody wants.
struct LiveWish {
  enum class Kind : std::uint8_t { kPace, kGravityScale, kViscosity, kFilter } kind = Kind::kPace;
  std::size_t fluid = 0;
  double value = 0.0;
};

/// On the drawing thread, inside Frame::hud.
class LivePanel {
 public:
  explicit LivePanel(std::vector<std::string> fluid_names) : fluid_names_(std::move(fluid_names)) {}

  bool shown = false;

  void draw(const LiveValues& now, double wall_seconds);
  /// What was asked for since the last call; of each value the newest, at most ten times a second while it is
  /// dragged.
  std::vector<LiveWish> take_wishes();

 private:
  struct Slider {
    float shown = 0.0f;
    bool active = false;
    double sent_at = -1.0;  // wall s
  };
  void slider(std::size_t id, const char* label, const char* pattern, float least, float most,
              bool logarithmic, double now, double wall_seconds, const LiveWish& wish);

  std::vector<std::string> fluid_names_;
  std::vector<Slider> sliders_;
  std::vector<LiveWish> wishes_;
};

}  // namespace slosh
