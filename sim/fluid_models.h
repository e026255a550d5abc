// Models of the fluid's wrench on held bodies, made from what a step gives anyway.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenes/scene.h"
#include "sim/bodies/wrench_identifier.h"
#include "sim/math/fluid_wrench.h"
#include "sim/world.h"

namespace slosh {

/// Watches the bodies that somebody asks for, step by step, and gives a FluidWrenchModel of each. Changes
/// nothing in the world, and costs what a few 6×6 products cost. One thread.
class FluidModels {
 public:
  explicit FluidModels(const Scene& scene);

  /// After a step of `world`, whose bodies are `now`. `wanted` has one entry a body; who is not wanted is not
  /// watched, and begins anew when wanted again. Sets `out` to one model of each body that is wanted and
  /// free, in the order of the bodies; to nothing in a world without fluid. Allocates nothing once `out` has
  /// grown.
  void after_step(const World& world, const BodySnapshot& now, std::span<const char> wanted,
                  std::vector<FluidWrenchModel>& out);
  /// The world went somewhere else: everything begins anew.
  void restart();

 private:
  struct Watched {
    bool free = false, point = false;
    WrenchBounds bounds;  // all but `up` are set when the watching begins
    bool watched = false;
    bool with_drag = false;  // readings have one
    WrenchIdentifier identifier;
  };
  std::vector<Watched> bodies_;
  double density_ = 0.0;  // kg/m³, of the heaviest fluid
};

}  // namespace slosh
