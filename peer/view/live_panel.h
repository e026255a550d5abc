// Sliders over the picture for what can be changed while the world runs.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "peer/view/hud/panels.h"

namespace slosh {

/// The springs of a grip.
struct LiveGrip {
  double stiffness = 1.0;  ///< times the scene's, 0.05–4
  double of_scene = 0.0;   ///< N/m
  double of_device = 0.0;  ///< N/m that the device holds at most; 0: no hand of this person's feels it
  bool may_set = true;     ///< its stiffness is this person's to change
};

/// What can be changed live, as it is.
struct LiveValues {
  bool may_change = false;          ///< viscosity and gravity are this person's to change
  double gravity_scale = 1.0;       ///< times the scene's, 0–2
  std::vector<double> viscosities;  ///< Pa·s, one a fluid
  std::vector<LiveGrip> grips;      ///< one a grip, or none where their stiffness is not to change
  bool may_pace = false;            ///< the world is this person's own: slow motion, single steps
  double pace = 1.0;                ///< simulated s a wall s at most
  int filter = 0;  ///< turns of the surface's filter, 0–64: 0 shows the balls that particles are
};

/// One value that somebody wants.
struct LiveWish {
  enum class Kind : std::uint8_t {
    kPace,
    kGravityScale,
    kViscosity,
    kGripStiffness,
    kFilter
  } kind = Kind::kPace;
  std::size_t index = 0;  ///< fluid or grip
  double value = 0.0;
};

/// What a slider for it shows beside its value: "= 500 N/m", and what the device makes of it where that is
/// less.
std::string grip_text(const LiveGrip& grip);

/// On the drawing thread, inside Frame::hud.
class LivePanel {
 public:
  LivePanel(std::vector<std::string> fluid_names, std::vector<std::string> grip_names)
      : fluid_names_(std::move(fluid_names)), grip_names_(std::move(grip_names)) {}

  bool shown = false;

  /// At the top on the right, or on the left where a panel of `taken` lies there.
  void draw(const LiveValues& now, double wall_seconds, std::span<const Rect> taken);
  /// Where it lies in what draw() drew last, in Dear ImGui's pixels.
  const Rect& panel() const { return panel_; }
  /// What was asked for since the last call; of each value the newest, at most ten times a second while it is
  /// dragged.
  std::vector<LiveWish> take_wishes();

 private:
  struct Slider {
    float shown = 0.0f;
    bool active = false;
    bool unsent = false;    // moved since sent_at
    double sent_at = -1.0;  // wall s
  };
  struct Row {
    std::size_t id;
    std::string label;
    const char* pattern;
    float least, most;
    bool logarithmic;
    double now;
    LiveWish wish;
  };
  struct Size {
    float letters = 1.0f;  // times their size
    float slider = 0.0f;   // px wide
    glm::vec2 panel{0.0f};
  };
  std::vector<Row> rows_of(const LiveValues& now) const;
  /// Letters as large as leave the panel within a third of the picture.
  static Size size_of(const std::vector<Row>& rows, const glm::vec2& picture);
  void slider(const Row& row, float width, double wall_seconds);

  std::vector<std::string> fluid_names_;
  std::vector<std::string> grip_names_;
  Rect panel_;
  std::vector<Slider> sliders_;
  std::vector<LiveWish> wishes_;
};

}  // namespace slosh
