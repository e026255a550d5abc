// The numbers over the picture (Dear ImGui): rates, forces as strip charts, status in words.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "peer/view/hud/hud_layout.h"
#include "peer/view/hud/panels.h"
#include "peer/view/hud/rates.h"
#include "peer/view/hud/strip_chart.h"
#include "scenes/scene.h"
#include "sim/snapshot.h"

namespace slosh {

/// What the HUD says about the run as a whole.
struct HudFacts {
  std::string title;
  double spacing = 0.0;  ///< m
  std::size_t fluid_particles = 0;
  std::size_t boundary_particles = 0;
  /// Snapshots hold all of the fluid, so that what is not in them has left the world: not over a network,
  /// where what nobody sees is left out.
  bool counts_fluid = false;
  bool walls_hold = true;      ///< Plan::walls_hold
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
  /// Likewise; empty without a task.
  Rect task_panel() const { return task_panel_; }

  /// Whether the panels have their places: from the first picture on, anew where its size changes.
  bool placed() const { return layout_.has_value(); }

  bool paused = false;
  /// What the panels leave free where they can when they get their places: what hands hold and are going
  /// to, in shares of the picture, y down.
  std::vector<Rect> keep_clear;

 private:
  struct Hand {
    std::string grip;
    StripChart force;   // N
    StripChart torque;  // N·m
    Wrench now;
  };
  std::uint32_t status() const;
  std::vector<PanelRow> run_rows(const Rates& rates) const;
  void add_what_left(const Rates& rates, std::vector<PanelRow>& rows) const;
  std::string warnings(const Rates& rates) const;
  void lay_out(const glm::vec2& picture);
  void draw_run(const Rates& rates, const glm::vec2& picture);
  void draw_hands(const glm::vec2& picture);
  void draw_task(const TaskLines& task, const glm::vec2& picture);
  void draw_hand(std::size_t device, float width) const;
  void draw_short_hand(std::size_t device, float width) const;

  HudFacts facts_;
  std::vector<Hand> hands_;
  double time_ = 0.0;
  std::uint64_t left_ = 0;  // fluid particles, by the newest snapshot
  std::array<double, 32> status_until_ = [] {
    std::array<double, 32> never{};
    never.fill(-1.0);
    return never;
  }();  // simulated s, a StatusBit each
  Rect run_panel_;
  Rect hands_panel_;
  Rect task_panel_;
  std::optional<HudLayout> layout_;
  glm::vec2 laid_out_for_{0.0f};  // px
  LetterSize laid_out_in_;
};

}  // namespace slosh
