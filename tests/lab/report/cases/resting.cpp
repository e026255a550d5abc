// Tanks that stand, are accelerated or turn: the closed forms of hydrostatics.
#include <algorithm>
#include <cmath>
#include <memory>

#include "sim/instruments.h"
#include "tests/lab/report/error_case.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/still_fluid.h"
#include "tests/lab/report/surface.h"

namespace slosh::report {
namespace {

const glm::dvec3 kTankInner(0.2, 0.16, 0.2);
constexpr double kFill = 0.1;
constexpr double kWall = 0.05;

// What the fluid has inside, on the tank's axis: gauges at two of its depths, read by the run's own
// instruments.
struct Depths {
  static constexpr double kShallow = 0.03, kDeep = 0.07;  // m under the level of its mass at rest density

  Depths(Scene scene, const Trial& trial)
      : level(trial.fluid_mass() / (1000.0 * kTankInner.x * kTankInner.z)) {
    for (const double depth : {kShallow, kDeep}) scene.gauges.push_back({"", -1, {0.0, level - depth, 0.0}});
    instruments = std::make_unique<Instruments>(scene, trial.sampled());
  }
  void look(const World& world) {
    const Measurement& now = instruments->measure(world);
    shallow.add(now.pressures[0]);
    deep.add(now.pressures[1]);
  }
  static double at(double depth) { return 1000.0 * kGravity * depth; }

  double level;  // m
  std::unique_ptr<Instruments> instruments;
  Average shallow, deep;
};

// The weight is momentum conservation and right for any kernel; where the surface stands, and what the
// pressure is inside, is not.
std::vector<Reading> still_tank(const Setting& setting, Cost& cost) {
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  const int tank = b.add_fixed("tank", tank_at_floor(kTankInner, kWall));
  b.add_volume(make::box({-0.5 * kTankInner.x, 0.0, -0.5 * kTankInner.z},
                         {0.5 * kTankInner.x, kFill, 0.5 * kTankInner.z}));
  b.set_domain({-0.3, -0.2, -0.3}, {0.3, 0.4, 0.3});
  Trial t(b.scene, setting, cost);
  t.settle(0.6);
  t.run(0.1);
  Average down;
  Depths depths(b.scene, t);
  t.run(0.5, [&] {
    down.add(-t.bodies().bodies[static_cast<std::size_t>(tank)].fluid.force.y);
    if (t.bodies().tick % 10 == 0) depths.look(t.world());
  });
  // The sampler fills whole layers only: the level to expect is that of the mass there is.
  const double expected = t.fluid_mass() / (1000.0 * kTankInner.x * kTankInner.z);
  const double level = surface_level(t.picture(), {-0.5 * kTankInner.x, -0.5 * kTankInner.z},
                                     {0.5 * kTankInner.x, 0.5 * kTankInner.z}, setting.spacing);
  const double shallow = Depths::at(Depths::kShallow), deep = Depths::at(Depths::kDeep);
  return {{"level", "m", level, expected, 0.0, true},
          {"pressure at 70 mm", "Pa", depths.deep.mean(), deep, 0.0, true},
          {"pressure at 30 mm", "Pa", depths.shallow.mean(), shallow, 0.0, false},
          {"pressure gained from 30 to 70 mm", "Pa", depths.deep.mean() - depths.shallow.mean(),
           deep - shallow, 0.0, false},
          {"weight on the walls", "N", down.mean(), t.fluid_mass() * kGravity, 0.0, false},
          {"noise of the weight, rms", "", down.noise_share(), 0.0, 1.0, false}};
}

// Nothing moves syrup that stands: what goes up along a tank's axis comes down at its walls, and what all
// move by besides is what particles creep by.
std::vector<Reading> still_syrup(const Setting& setting, Cost& cost) {
  constexpr double kViscosity = 2.0, kSlow = 0.01;  // Pa·s, m/s
  SceneBuilder b = full_tank(setting.model, 1000.0, kViscosity);
  b.set_viscosity({0}, kViscosity);
  Trial t(b.scene, setting, cost);
  const Turnover moves = turnover(t);
  return {{"rise along the axis", "m/s", moves.axis, 0.0, kSlow, true},
          {"all of it, rms", "m/s", moves.all, 0.0, kSlow, false}};
}

// A tank of five bodies: each side carries ½ρgh²w, at a third of the depth above the floor.
std::vector<Reading> tank_faces(const Setting& setting, Cost& cost) {
  const double x = 0.5 * kTankInner.x, z = 0.5 * kTankInner.z, t = kWall;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  b.add_fixed("floor", make::box({-x - t, -t, -z - t}, {x + t, 0.0, z + t}));
  b.add_fixed("left", make::box({-x - t, 0.0, -z - t}, {-x, kTankInner.y, z + t}));
  b.add_fixed("right", make::box({0.0, 0.0, -z - t}, {t, kTankInner.y, z + t}),
              {{x, 0.0, 0.0}, {1, 0, 0, 0}});
  b.add_fixed("back", make::box({-x, 0.0, -z - t}, {x, kTankInner.y, -z}));
  b.add_fixed("front", make::box({-x, 0.0, z}, {x, kTankInner.y, z + t}));
  b.add_volume(make::box({-x, 0.0, -z}, {x, kFill, z}));
  b.set_domain({-0.3, -0.2, -0.3}, {0.3, 0.4, 0.3});
  Trial e(b.scene, setting, cost);
  e.settle(0.6);
  Average down, left, right, moment;
  e.run(0.5, [&] {
    const auto& bodies = e.bodies().bodies;
    down.add(-bodies[0].fluid.force.y);
    left.add(-bodies[1].fluid.force.x);
    right.add(bodies[2].fluid.force.x);
    moment.add(-bodies[2].fluid.torque.z);  // about the wall's lower edge
  });
  const double depth = e.fluid_mass() / (1000.0 * kTankInner.x * kTankInner.z);
  const double side = 0.5 * 1000.0 * kGravity * depth * depth * kTankInner.z;
  return {{"floor", "N", down.mean(), e.fluid_mass() * kGravity, 0.0, true},
          {"side walls, mean", "N", 0.5 * (left.mean() + right.mean()), side, 0.0, false},
          {"centre of pressure above the floor", "m", moment.mean() / right.mean(), depth / 3.0, 0.0, false}};
}

// Gravity leans by `across` m/s² along the tank: the surface leans by a/g. Fluid at rest lies in layers of a
// spacing, and at 1 m/s² the whole rise is three of them at 10 mm.
std::vector<Reading> leaning(double across, const Setting& setting, Cost& cost) {
  constexpr double kLength = 0.3, kWidth = 0.1, kDepth = 0.1;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  const int tank = b.add_fixed("tank", tank_at_floor({kLength, 0.24, kWidth}, 0.04));
  b.add_volume(make::box({-0.5 * kLength, 0.0, -0.5 * kWidth}, {0.5 * kLength, kDepth, 0.5 * kWidth}));
  b.scene.gravity = {across, -kGravity, 0.0};
  b.set_domain({-0.3, -0.2, -0.2}, {0.3, 0.5, 0.2});
  Trial e(b.scene, setting, cost);
  e.settle(2.0);
  // The height over each part of the length is counted in particles and freed of the compression under its
  // own weight, ρ/ρ⁰ = 1 + g·depth/k; the parts at the end walls are left out.
  constexpr int kParts = 12;
  Profile profile(kParts);
  Average side;
  e.run(0.5, [&] {
    side.add(e.bodies().bodies[static_cast<std::size_t>(tank)].fluid.force.x);
    if (e.bodies().tick % 10 == 0)
      profile.add(e.picture(), [&](const glm::vec3& p) { return p.x / kLength + 0.5; });
  });
  std::vector<glm::dvec2> heights;
  for (int i = 2; i < kParts - 2; ++i) {
    const double counted = profile.mean(i) * std::pow(setting.spacing, 3) / (kWidth * kLength / kParts);
    heights.emplace_back(((i + 0.5) / kParts - 0.5) * kLength,
                         counted / (1.0 + 0.5 * kGravity * counted / e.world().plan().stiffness));
  }
  return {{"slope", "", slope_of(heights), across / kGravity, 0.0, true},
          {"force along the tank", "N", side.mean(), e.fluid_mass() * across, 0.0, false}};
}

std::vector<Reading> slope(const Setting& setting, Cost& cost) {
  return leaning(4.0, setting, cost);
}
std::vector<Reading> gentle_slope(const Setting& setting, Cost& cost) {
  return leaning(1.0, setting, cost);
}

// The surface of a glass of fluid that turns rises as ω²r²/(2g).
std::vector<Reading> paraboloid(const Setting& setting, Cost& cost) {
  constexpr double kRadius = TurningGlass::kRadius, kTurning = TurningGlass::kTurning;
  TurningGlass glass(setting, cost);
  Trial& e = glass.trial();
  e.run(1.5, [&] { glass.turn(); });
  // The surface over circles around the axis; the outermost stands one and a half spacings off the wall.
  constexpr int kCircles = 5, kAngles = 8;
  std::vector<Average> level(kCircles);
  const double widest = kRadius - 1.5 * setting.spacing;
  e.run(0.5, [&] {
    glass.turn();
    if (e.bodies().tick % 10) return;
    const Snapshot picture = e.picture();
    for (int i = 0; i < kCircles * kAngles; ++i) {
      const double r = widest * (i / kAngles) / (kCircles - 1), angle = 2.0 * kPi * (i % kAngles) / kAngles;
      level[static_cast<std::size_t>(i / kAngles)].add(
          fluid_level(picture, {r * std::cos(angle), 0.0, r * std::sin(angle)}, kUp, setting.spacing));
    }
  });
  std::vector<glm::dvec2> heights;
  for (int i = 0; i < kCircles; ++i) {
    const double r = widest * i / (kCircles - 1);
    heights.emplace_back(r * r, level[static_cast<std::size_t>(i)].mean());
  }
  return {{"rise over r²", "1/m", slope_of(heights), kTurning * kTurning / (2.0 * kGravity), 0.0, true}};
}

}  // namespace

std::vector<ErrorCase> resting_cases() {
  return {
      {"still_tank",
       "A tank at rest",
       "level of its mass, weight on its walls",
       {0.02, 0.0125, 0.01, 0.008, 0.00625},
       2,
       still_tank},
      {"still_syrup",
       "Syrup at rest in a tank, 2 Pa·s",
       "it stands; in units of 1 cm/s",
       {0.0125, 0.01, 0.008},
       1,
       still_syrup},
      {"tank_faces",
       "Each wall of a tank of five slabs",
       "ρgh on the floor, ½ρgh²w on a side",
       {0.02, 0.0125, 0.01, 0.008},
       2,
       tank_faces},
      {"slope", "A tank accelerated at 4 m/s²", "surface slope a/g", {0.0125, 0.01, 0.0075}, 1, slope},
      {"slope_gentle",
       "A tank accelerated at 1 m/s²",
       "surface slope a/g",
       {0.0125, 0.01, 0.0075},
       1,
       gentle_slope},
      {"paraboloid",
       "A glass that turns at 16 rad/s",
       "surface ω²r²/(2g)",
       {0.01, 0.0075, 0.006},
       1,
       paraboloid},
  };
}

}  // namespace slosh::report
