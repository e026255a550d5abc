// The numbers over the picture (Dear ImGui): rates, forces as strip charts, status in words.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "peer/hud/rates.h"
#include "scenes/scene.h"
#include "sim/snapshot.h"

namespace slosh {

/// What the HUD says about the run as a whole.
struct HudFacts {
  std::string title;
  double spacing = 0.0;  ///< m
  std::size_t fluid_particles = 0;
  std::size_t boundary_particles = 0;
  bool shared = false;         ///< others may hold grips too: the help says how to take one
  bool may_change = true;      ///< pausing and starting again are this person's to do: the help says how
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

  bool paused = false;
  bool show_help = false;
  bool mouse_hand = false;  ///< the mouse holds a handle: the help says so

 private:
  struct Chart {
    std::string grip;
    std::vector<float> force;  // N, a ring
    std::vector<float> torque;
    float top_force = 1.0f;  // N, the largest so far
    Wrench now;
  };
  void draw_run(const Rates& rates, bool brief) const;
  void draw_numbers(const Rates& rates) const;
  void draw_chart(std::size_t device) const;
  void draw_help() const;

  HudFacts facts_;
  std::vector<Chart> charts_;
  std::size_t next_ = 0;
  double time_ = 0.0;
  std::uint32_t status_ = 0;
};

}  // namespace slosh
