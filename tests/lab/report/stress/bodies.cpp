// Bodies of all weights, in fluids of all kinds, on each other.
#include <algorithm>
#include <cmath>

#include "sim/math/format.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/stress/scenes.h"
#include "tests/lab/report/surface.h"
#include "tests/lab/report/watch.h"

namespace slosh::report {
namespace {

// A box of 4 cm and so much of the fluid's density falls a little way onto a tank of it. What it can gain is
// its fall; a rotation of more than one turn a second it cannot keep up in a fluid like that.
Stress floating(double share, double viscosity, const Setting& setting, Cost& cost) {
  constexpr double kEdge = 0.04;
  const double mass = share * 1000.0 * kEdge * kEdge * kEdge;
  SceneBuilder b;
  b.add_fluid(1000.0, viscosity);
  const int tank = b.add_fixed("tank", tank_at_floor({0.16, 0.2, 0.16}, 0.03));
  const int box = b.add_free("box", make::box(glm::dvec3(-0.5 * kEdge), glm::dvec3(0.5 * kEdge)), mass,
                             {{0.0, 0.115, 0.0}, {1, 0, 0, 0}});
  b.set_viscosity({tank, box}, viscosity);
  b.add_volume(make::box({-0.08, 0.0, -0.08}, {0.08, 0.08, 0.08}));
  b.set_domain({-0.4, -0.3, -0.4}, {0.4, 1.0, 0.4});
  Trial t(b.scene, setting, cost);
  Watch watch(t, b.scene);
  double fastest = 0.0, spinning = 0.0;
  const auto look = [&] {
    const Twist& twist = t.bodies().bodies[static_cast<std::size_t>(box)].twist;
    fastest = std::max(fastest, glm::length(twist.linear));
    spinning = std::max(spinning, glm::length(twist.angular));
  };
  watch.run(1.0, look);
  fastest = spinning = 0.0;
  watch.run(0.5, look);
  Stress found = watch.found(share > 1.0 ? 0.02 : 0.0);
  if (!(fastest < 0.3)) found.broken = format("the box still goes at %.2g m/s", fastest);
  if (!(spinning < 2.0 * kPi)) found.broken = format("the box spins at %.2g rad/s", spinning);
  return found;
}

template <int kPerMille>
Stress in_water(const Setting& s, Cost& c) {
  return floating(1e-3 * kPerMille, 0.001, s, c);
}
template <int kPerMille>
Stress in_honey(const Setting& s, Cost& c) {
  return floating(1e-3 * kPerMille, 10.0, s, c);
}
Stress in_tar(const Setting& s, Cost& c) {
  return floating(0.5, 1000.0, s, c);
}

// Cubes of 2 cm in a column: after the time they stand where they stood.
Stress stack(int count, double seconds, const Setting& setting, Cost& cost) {
  constexpr double kEdge = 0.02;
  SceneBuilder b;
  b.add_fixed("table", make::box({-0.2, -0.04, -0.2}, {0.2, 0.0, 0.2}));
  for (int i = 0; i < count; ++i) {
    b.add_free("cube", make::box(glm::dvec3(-0.5 * kEdge), glm::dvec3(0.5 * kEdge)), 0.02,
               {{0.0, (i + 0.5) * kEdge, 0.0}, {1, 0, 0, 0}});
  }
  b.set_domain(glm::dvec3(-1.0), glm::dvec3(1.0));
  Trial t(b.scene, setting, cost);
  t.run(seconds);
  Stress found;
  found.finite = all_finite(t.world());
  double drift = 0.0;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 now = t.bodies().bodies[static_cast<std::size_t>(i + 1)].center_of_mass;
    drift = std::max(drift, glm::distance(now, {0.0, (i + 0.5) * kEdge, 0.0}));
  }
  if (!(drift <= 1e-4)) found.broken = format("a cube moved by %.2g mm", 1e3 * drift);
  return found;
}

Stress stack_3(const Setting& s, Cost& c) {
  return stack(3, 3.0, s, c);
}
Stress stack_10(const Setting& s, Cost& c) {
  return stack(10, 5.0, s, c);
}

// Boxes dropped in a heap, `a_side` by `a_side` a layer, each turned and shifted a little: none goes through
// the table or the walls around it, they come to rest, and the table then carries their weight without
// trembling. What it carries follows from their momentum.
Stress heap(int count, int a_side, double seconds, const Setting& setting, Cost& cost) {
  constexpr double kEdge = 0.04, kMass = 0.06;
  const double half = 0.5 * a_side * 0.055 + 0.01;
  SceneBuilder b;
  b.add_fixed("bin", tank_at_floor({2.0 * half, 0.4, 2.0 * half}, 0.03));
  for (int i = 0; i < count; ++i) {
    const int layer = i / (a_side * a_side), row = i / a_side % a_side, column = i % a_side;
    const double shift = 0.004 * std::sin(12.9898 * i), turn = 0.3 * std::sin(78.233 * i);
    b.add_free("box", make::box(glm::dvec3(-0.5 * kEdge), glm::dvec3(0.5 * kEdge)), kMass,
               {{0.055 * (column - 0.5 * (a_side - 1)) + shift, 0.035 + 0.06 * layer,
                 0.055 * (row - 0.5 * (a_side - 1)) - shift},
                glm::angleAxis(turn, glm::normalize(glm::dvec3(1.0, 2.0 * shift / 0.004, 0.5)))});
  }
  b.set_domain(glm::dvec3(-1.0), glm::dvec3(1.0, 2.0, 1.0));
  Trial t(b.scene, setting, cost);
  double fastest = 0.0, lowest = 1.0, furthest = 0.0, before = 0.0, squares = 0.0;
  int steps = 0;
  const double weight = count * kMass * kGravity * t.world().plan().time_step;
  const auto look = [&] {
    double now = 0.0;
    fastest = 0.0;
    for (int i = 1; i <= count; ++i) {
      const BodyState& body = t.bodies().bodies[static_cast<std::size_t>(i)];
      now += kMass * body.twist.linear.y;
      fastest = std::max(fastest, glm::length(body.twist.linear));
      lowest = std::min(lowest, body.center_of_mass.y);
      furthest = std::max({furthest, std::abs(body.center_of_mass.x), std::abs(body.center_of_mass.z)});
    }
    if (steps++ > 0) squares += (now - before) / weight * ((now - before) / weight);
    before = now;
  };
  t.run(seconds);
  double most = 0.0;
  t.run(0.5, [&] {
    look();
    most = std::max(most, fastest);
  });
  const double trembling = std::sqrt(squares / std::max(steps - 1, 1));
  Stress found;
  found.finite = all_finite(t.world());
  if (!(trembling < 1e-4))
    found.broken = format("the load on the table trembles by %.2g %%", 1e2 * trembling);
  if (!(most < 1e-3)) found.broken = format("a box still goes at %.2g m/s", most);
  if (!(lowest > 0.45 * kEdge && furthest < half - 0.45 * kEdge))
    found.broken = "a box is in the table or a wall";
  return found;
}

Stress heap_30(const Setting& s, Cost& c) {
  return heap(30, 3, 1.0, s, c);
}
Stress heap_200(const Setting& s, Cost& c) {
  return heap(200, 6, 1.5, s, c);
}

// A shot of 60 m/s at a wall of 1 cm: a quarter of a metre a step.
Stress bullet(const Setting& setting, Cost& cost) {
  SceneBuilder b;
  b.add_fixed("wall", make::box({0.5, -0.5, -0.5}, {0.51, 0.5, 0.5}));
  const int shot = b.add_free("shot", make::sphere(0.01, 12, 24), 0.03);
  b.scene.bodies[static_cast<std::size_t>(shot)].twist.linear = {60.0, 0.0, 0.0};
  b.scene.gravity = glm::dvec3(0.0);
  b.set_domain(glm::dvec3(-2.0), glm::dvec3(2.0));
  Trial t(b.scene, setting, cost);
  t.run(0.05);
  Stress found;
  found.finite = all_finite(t.world());
  if (t.bodies().bodies[static_cast<std::size_t>(shot)].center_of_mass.x > 0.5)
    found.broken = "it went through";
  return found;
}

// A lid that fits is pressed into a full vessel: nowhere to go.
Stress press(const Setting& setting, Cost& cost) {
  const Scene scene = press_scene();
  Trial t(scene, setting, cost);
  t.handle(0).engaged = true;
  t.handle(0).twist.linear.y = -0.12;
  Watch watch(t, scene);
  watch.run(0.5, [&] { t.handle(0).pose.position.y -= 0.12 * t.world().plan().time_step; });
  t.handle(0).twist = {};
  watch.run(0.5);
  Stress found = watch.found();
  const double off = 0.8 * setting.spacing;
  found.lost_share = share_outside(t.picture(), Pose{},
                                   {{-0.06 - off, -off, -0.06 - off}, {0.06 + off, 0.2, 0.06 + off}, true});
  return found;
}

}  // namespace

std::vector<StressCase> body_stress() {
  return {
      {"light_001", "A box of 0.01 times water's density", 0.01, true, true, in_water<10>},
      {"light_1", "A box of 0.1 times", 0.01, true, true, in_water<100>},
      {"light_5", "A box of 0.5 times", 0.01, true, true, in_water<500>},
      {"heavy_20", "A box of 20 times", 0.01, true, true, in_water<20000>},
      {"honey_1", "A box of 0.1 times in 10 Pa·s", 0.01, true, true, in_honey<100>},
      {"honey_5", "A box of 0.5 times in 10 Pa·s", 0.01, true, true, in_honey<500>},
      {"honey_20", "A box of 20 times in 10 Pa·s", 0.01, true, true, in_honey<20000>},
      {"tar", "A box of 0.5 times in 1000 Pa·s", 0.01, false, true, in_tar},
      {"stack_3", "Three cubes on each other", 0.01, true, false, stack_3},
      {"stack_10", "Ten cubes on each other", 0.01, true, false, stack_10},
      {"heap", "Thirty boxes in a heap", 0.01, true, false, heap_30},
      {"heap_200", "Two hundred boxes in a heap", 0.01, false, false, heap_200},
      {"bullet", "A shot at a thin wall", 0.01, true, false, bullet},
      {"press", "A lid pressed into a full vessel", 0.01, true, true, press},
  };
}

}  // namespace slosh::report
