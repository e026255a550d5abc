// Materials, gravity, sizes and odd starts.
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/math/format.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/watch.h"

namespace slosh::report {
namespace {

Scene dam(double viscosity, double speed = 0.0) {
  SceneBuilder b;
  b.add_fluid(1000.0, viscosity);
  const int tank = b.add_fixed("tank", tank_at_floor({0.2, 0.4, 0.1}, 0.03));
  b.set_viscosity({tank}, viscosity);
  const int volume = b.add_volume(make::box({-0.1, 0.0, -0.05}, {0.0, 0.1, 0.05}));
  b.scene.fluid_volumes[static_cast<std::size_t>(volume)].velocity = {speed, 0.0, 0.0};
  b.set_domain({-0.4, -0.4, -0.4}, {0.4, 2.0, 0.4});
  return b.scene;
}

// A column falls: its kinetic energy is never above the height that it can lose.
template <int kMilliPascalSeconds>
Stress viscous_dam(const Setting& setting, Cost& cost) {
  const Scene scene = dam(1e-3 * kMilliPascalSeconds);
  Trial t(scene, setting, cost);
  const Diagnostics start = t.world().diagnostics();
  Watch watch(t, scene, start.mass * kGravity * start.center.y);
  watch.run(0.3);
  return watch.found();
}

// Thrown at a wall: what is lost went over it.
template <int kSpeed>
Stress thrown(const Setting& setting, Cost& cost) {
  const Scene scene = dam(0.05, kSpeed);
  Trial t(scene, setting, cost);
  const Diagnostics start = t.world().diagnostics();
  Watch watch(t, scene, start.kinetic_energy + start.mass * kGravity * start.center.y);
  watch.run(0.5);
  return watch.found();
}

// A tank at rest whose size, gravity or fluid is far from a kitchen's: it must carry its weight.
Stress rest(Scene scene, double period, const Setting& setting, Cost& cost) {
  Trial t(scene, setting, cost);
  t.settle(0.4);
  Watch watch(t, scene);
  Average down;
  watch.run(period, [&] { down.add(-t.bodies().bodies[0].fluid.force.y); });
  Stress found = watch.found();
  const double weight = t.fluid_mass() * glm::length(scene.gravity);
  const double off = weight > 0.0 ? down.mean() / weight - 1.0 : down.mean();
  if (!(std::abs(off) < 0.02)) found.broken = format("the floor carries %.3g times the weight", 1.0 + off);
  return found;
}

Scene tank_of(double spacing, double gravity, double density) {
  SceneBuilder b;
  // The same cell Reynolds number at every size, ν ~ s·√(g s).
  b.add_fluid(density, 5e-5 * density * std::pow(spacing / 0.01, 1.5));
  const double side = 6.0 * spacing;
  b.add_fixed("tank", tank_at_floor({2.0 * side, 16.0 * spacing, 2.0 * side}, 4.0 * spacing));
  b.add_volume(make::box({-side, 0.0, -side}, {side, 8.0 * spacing, side}));
  b.scene.gravity = {0.0, -gravity, 0.0};
  b.set_domain(glm::dvec3(-40.0 * spacing), glm::dvec3(40.0 * spacing));
  return b.scene;
}

Stress gravity_100(const Setting& s, Cost& c) {
  return rest(tank_of(0.01, 100.0 * kGravity, 1000.0), 0.1, s, c);
}
Stress gravity_0(const Setting& s, Cost& c) {
  return rest(tank_of(0.01, 0.0, 1000.0), 0.3, s, c);
}
Stress tiny(const Setting& s, Cost& c) {
  return rest(tank_of(0.001, kGravity, 1000.0), 0.1, s, c);
}
Stress large(const Setting& s, Cost& c) {
  return rest(tank_of(0.1, kGravity, 1000.0), 1.5, s, c);
}
Stress mercury(const Setting& s, Cost& c) {
  return rest(tank_of(0.01, kGravity, 13600.0), 0.4, s, c);
}

// A metre of water at 2 cm: fifty layers.
Stress deep(const Setting& setting, Cost& cost) {
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  b.add_fixed("tank", tank_at_floor({0.2, 1.2, 0.2}, 0.08));
  b.add_volume(make::box({-0.1, 0.0, -0.1}, {0.1, 1.0, 0.1}));
  b.set_domain({-0.6, -0.6, -0.6}, {0.6, 2.0, 0.6});
  return rest(b.scene, 0.5, setting, cost);
}

// A light fluid on one a thousand times as dense stays there.
Stress layers(const Setting& setting, Cost& cost) {
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  b.add_fluid(1.0, 5e-5);
  b.add_fixed("tank", tank_at_floor({0.1, 0.16, 0.1}, 0.04));
  b.add_volume(make::box({-0.05, 0.0, -0.05}, {0.05, 0.05, 0.05}), 0);
  b.add_volume(make::box({-0.05, 0.05, -0.05}, {0.05, 0.09, 0.05}), 1);
  b.set_domain(glm::dvec3(-0.4), glm::dvec3(0.4));
  Trial t(b.scene, setting, cost);
  t.settle(0.3);
  Watch watch(t, b.scene);
  watch.run(0.3);
  Stress found = watch.found();
  const Snapshot picture = t.picture();
  glm::dvec2 height(0.0), count(0.0);
  for (std::size_t i = 0; i < picture.positions.size(); ++i) {
    if (picture.fluid_index[i] > 1) continue;
    height[picture.fluid_index[i]] += picture.positions[i].y;
    count[picture.fluid_index[i]] += 1.0;
  }
  if (!(height.y / count.y > height.x / count.x + 0.02)) found.broken = "the light fluid is not on top";
  return found;
}

// What a start may be: `change` damages the sampled fluid.
template <class Change>
Stress started(Change change, const Setting& setting, Cost& cost, double most_lost) {
  const Scene scene = tank_of(0.01, kGravity, 1000.0);
  SampledScene fluid = sampled_for(scene, setting);
  change(fluid);
  fluid.fluid_velocities.resize(fluid.fluid_positions.size(), glm::vec3(0.0f));
  fluid.fluid_index.resize(fluid.fluid_positions.size(), 0);
  Trial t(scene, fluid, setting, cost);
  Watch watch(t, scene);
  watch.run(1.0);
  Stress found = watch.found(most_lost);
  const Diagnostics after = t.world().diagnostics();
  if (after.particles + after.retired != t.world().fluid_count())
    found.broken = "particles are unaccounted for";
  if (after.max_speed > 3.0) found.broken = format("still at %.1f m/s after a second", after.max_speed);
  return found;
}

Stress doubled(const Setting& s, Cost& c) {
  return started(
      [](SampledScene& fluid) {
        auto& p = fluid.fluid_positions;
        p.resize(p.size() / 2);
        p.insert(p.end(), p.begin(), p.end());
        fluid.fluid_velocities.resize(p.size());
        fluid.fluid_index.resize(p.size());
      },
      s, c, 0.0);
}
Stress far_away(const Setting& s, Cost& c) {
  return started([](SampledScene& fluid) { fluid.fluid_positions[7] = {1e6f, 0.0f, 0.0f}; }, s, c, 0.001);
}
Stress not_a_number(const Setting& s, Cost& c) {
  return started(
      [](SampledScene& fluid) {
        fluid.fluid_positions[11].y = std::numeric_limits<float>::quiet_NaN();
        fluid.fluid_velocities[13].x = std::numeric_limits<float>::infinity();
      },
      s, c, 0.003);
}
template <int kCount>
Stress few(const Setting& s, Cost& c) {
  return started(
      [](SampledScene& fluid) {
        fluid.fluid_positions.resize(kCount);
        fluid.fluid_velocities.resize(kCount);
        fluid.fluid_index.resize(kCount);
      },
      s, c, 0.0);
}

// Ten times the plan's step: no method holds that; it must be finite and say so.
Stress long_step(const Setting& setting, Cost& cost) {
  Setting longer = setting;
  longer.step_share = 10.0;
  const Scene scene = dam(0.001);
  Trial t(scene, longer, cost);
  Watch watch(t, scene);
  watch.run(1.0);
  return watch.found();
}

// Filled to the last particle that there is room for, taken away, and filled again, ten times a second.
Stress filled_anew(const Setting& setting, Cost& cost) {
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  b.add_fixed("tank", tank_at_floor({0.16, 1.0, 0.16}, 0.03));
  b.add_volume(make::box({-0.08, 0.0, -0.08}, {0.08, 0.05, 0.08}));
  b.add_volume(make::box({-0.03, 0.1, -0.03}, {0.03, 0.16, 0.03}));
  b.scene.fluid_volumes.back().starts_away = true;
  b.scene.fluid_volumes.back().fillings = 3;
  b.set_domain({-0.4, -0.3, -0.4}, {0.4, 3.0, 0.4});
  Trial t(b.scene, setting, cost);
  Watch watch(t, b.scene);
  const std::size_t filling = thing_count(b.scene) - 1;
  int filled = 0, refused = 0;
  for (int i = 0; i < 20; ++i) {
    watch.run(0.1);
    const bool came = static_cast<bool>(t.world().appear(filling));
    (came ? filled : refused) += 1;
    if (!came && !t.world().take_away(filling)) return {.broken = "what is full cannot be emptied"};
  }
  Stress found = watch.found(0.01);
  if (filled < 5 || refused < 2) found.broken = "it was hardly ever filled, or never full";
  return found;
}

}  // namespace

std::vector<StressCase> fluid_stress() {
  return {
      {"viscosity_0", "A dam of 0 Pa·s breaks", 0.01, true, true, viscous_dam<0>},
      {"viscosity_1", "A dam of 1 Pa·s", 0.01, true, true, viscous_dam<1000>},
      {"viscosity_50", "A dam of 50 Pa·s", 0.01, true, true, viscous_dam<50000>},
      {"viscosity_1000", "A dam of 1000 Pa·s", 0.01, true, true, viscous_dam<1000000>},
      {"viscosity_100000", "A dam of 100 000 Pa·s", 0.01, true, true, viscous_dam<100000000>},
      {"viscosity_1e6", "A dam of 1 000 000 Pa·s", 0.01, false, true, viscous_dam<1000000000>},
      {"thrown_2", "Water thrown at a wall at 2 m/s", 0.01, true, true, thrown<2>},
      {"thrown_10", "Water thrown at a wall at 10 m/s", 0.01, true, true, thrown<10>},
      {"gravity_100", "A tank under 100 g", 0.01, true, true, gravity_100},
      {"gravity_0", "A tank without gravity", 0.01, true, true, gravity_0},
      {"spacing_1mm", "A tank of 12 mm", 0.001, true, true, tiny},
      {"spacing_100mm", "A tank of 1.2 m, 10 cm between particles", 0.1, true, true, large},
      {"mercury", "A tank of mercury", 0.01, true, true, mercury},
      {"deep", "A metre of water", 0.02, true, true, deep},
      {"layers_1000", "A fluid on one a thousand times as dense", 0.01, true, true, layers},
      {"doubled", "Every particle twice in one place", 0.01, true, true, doubled},
      {"far_away", "One particle 1000 km away", 0.01, true, true, far_away},
      {"not_a_number", "Particles that are not numbers", 0.01, true, true, not_a_number},
      {"particles_0", "A tank of no particles", 0.01, true, true, few<0>},
      {"particles_1", "One particle", 0.01, true, true, few<1>},
      {"particles_2", "Two", 0.01, true, true, few<2>},
      {"particles_10", "Ten", 0.01, true, true, few<10>},
      {"filled_anew", "Filled, emptied and filled again ten times a second", 0.01, true, true, filled_anew},
      {"step_10", "Ten times the plan's time step", 0.01, true, true, long_step},
  };
}

}  // namespace slosh::report
