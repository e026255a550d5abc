// The numbers over the picture (Dear ImGui): rates, forces as strip charts, status in words.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "peer/hud/panels.h"
#include "peer/hud/rates.h"
#include "peer/hud/strip_chart.h"
#include "scenes/scene.h"
#include "sim/snapshot.h"

namespace slosh {

/// What the HUD says about the run as a whole.
struct HudFacts {
  std::string title;
  double spacing = 0.0;  ///< m
  std::size_t fluid_particles = 0;
  std::size_t boundary_particles = 0;
  bool shared = false;         ///< others may hold grips too
  bool may_change = true;      ///< pausing and starting again are this person's to do
  double picture_rate = 30.0;  ///< snapshots a simulated second, spaces the strip charts
};

/// A line for each StatusBit of `status`, with in how many steps it was set where that is known; empty when
/// none is.
std::string status_lines(std::uint32_t status, const std::array<std::uint64_t, 32>& steps);

/// On the drawing thread. record() once a snapshot, draw() inside Frame::hud.
class Hud {
 public:
  Hud(const Scene& scene, HudFacts facts);

  void record(const Snapshot& snapshot);
  void draw(const Rates& rates);
  /// Where the panels lie in what draw() drew last, in Dear ImGui's pixels.
  std::array<Rect, 2> panels() const { return {run_panel_, hands_panel_}; }

  bool paused = false;
  /// What the panels leave free where they can: what hands hold, in shares of the picture, y down.
  std::vector<Rect> keep_clear;

 private:
  struct Hand {
    std::string grip;
    StripChart force;   // N
    StripChart torque;  // N·m
    Wrench now;
  };
  std::uint32_t status() const;
  std::vector<PanelRow> run_rows(const Rates& rates, bool brief) const;
  void draw_run(const Rates& rates, const glm::vec2& picture, bool brief);
  void draw_hands(const glm::vec2& picture);
  void draw_hand(std::size_t device, float width) const;

  HudFacts facts_;
  std::vector<Hand> hands_;
  double time_ = 0.0;
  std::array<double, 32> status_until_ = [] {
    std::array<double, 32> never{};
    never.fill(-1.0);
    return never;
  }();  // simulated s, a StatusBit each
  Rect run_panel_;
  Rect hands_panel_{glm::vec2(-1.0f), glm::vec2(-1.0f)};
  bool in_a_row_ = false;  ///< the hands' panel
};

}  // namespace slosh
