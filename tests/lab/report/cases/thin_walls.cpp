// Vessels and bodies whose walls are one to three spacings thick, as the shipped scenes' are: what the fluid
// takes for their surface.
#include "tests/lab/report/error_case.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/surface.h"

namespace slosh::report {
namespace {

constexpr double kThinWall = 0.014;  // the shipped vessels'

// Where the surface stands in a glass says how wide the glass is for the fluid.
Reading level_in_glass(const Setting& setting, Cost& cost) {
  constexpr double kRadius = 0.06, kDepth = 0.08, kSquare = 0.03;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  b.add_fixed("glass", glass_of(kRadius, kDepth + 0.04, kThinWall));
  b.add_volume(filling_of(kRadius, kDepth));
  b.set_domain({-0.2, -0.2, -0.2}, {0.2, 0.5, 0.2});
  Trial t(b.scene, setting, cost);
  t.settle(0.6);
  t.run(0.1);
  Average level;
  t.run(0.3, [&] {
    if (t.bodies().tick % 10 == 0)
      level.add(surface_level(t.picture(), {-kSquare, -kSquare}, {kSquare, kSquare}, setting.spacing));
  });
  // The sampler fills whole particles only: the level to expect is that of the mass there is.
  return {
      "level in a glass", "m", level.mean(), t.fluid_mass() / (1000.0 * kPi * kRadius * kRadius), 0.0, true};
}

// What a plate under water is lifted by says how thick it is for the fluid.
Reading lift_of_plate(const Setting& setting, Cost& cost) {
  constexpr double kTank = 0.2, kFill = 0.13, kPlate = 0.1;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.1);
  b.add_fixed("tank", tank_at_floor({kTank, 0.25, kTank}, 0.05));
  const make::Solid solid = make::box({-0.5 * kPlate, -0.5 * kThinWall, -0.5 * kPlate},
                                      {0.5 * kPlate, 0.5 * kThinWall, 0.5 * kPlate});
  const int plate = b.add_fixed("plate", solid, {{0.0, 0.06, 0.0}, {1, 0, 0, 0}});
  b.add_volume(make::box({-0.5 * kTank, 0.0, -0.5 * kTank}, {0.5 * kTank, kFill, 0.5 * kTank}));
  b.set_domain({-0.3, -0.2, -0.3}, {0.3, 0.5, 0.3});
  Trial t(b.scene, setting, cost);
  t.settle(1.0);
  Average up;
  t.run(0.3, [&] { up.add(t.bodies().bodies[static_cast<std::size_t>(plate)].fluid.force.y); });
  return {"lift of a plate", "N", up.mean(), 1000.0 * kGravity * volume_of(solid), 0.0, true};
}

std::vector<Reading> thin_walls(const Setting& setting, Cost& cost) {
  return {level_in_glass(setting, cost), lift_of_plate(setting, cost)};
}

}  // namespace

std::vector<ErrorCase> thin_wall_cases() {
  return {{"thin_walls",
           "Walls of 14 mm: a glass, a plate",
           "level of its mass; ρgV",
           {0.01, 0.008, 0.00625},
           2,
           thin_walls}};
}

}  // namespace slosh::report
