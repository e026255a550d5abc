// What is lifted, what floats and what rises.
#include <cmath>

#include "tests/lab/report/error_case.h"
#include "tests/lab/report/reference/released_ball.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/surface.h"

namespace slosh::report {
namespace {

// A fixed solid of size `across` in the middle of a tank of water: ρgV.
// `hollow`: the water is laid around a box of that size.
std::vector<Reading> lift(const make::Solid& solid, double across, bool hollow, const Setting& setting,
                          Cost& cost) {
  const double inner = 2.4 * across, depth = 2.4 * across, w = 0.5 * inner;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.1);
  b.add_fixed("tank", tank_at_floor({inner, depth + 0.1, inner}, 0.04));
  const int body = b.add_fixed("body", solid, {{0.0, 0.5 * depth, 0.0}, {1, 0, 0, 0}});
  // The sampler takes fluid out of a body by itself only where that is little of its volume.
  const double r = hollow ? 0.5 * across : 0.0, low = 0.5 * depth - r, high = 0.5 * depth + r;
  if (!hollow) {
    b.add_volume(make::box({-w, 0.0, -w}, {w, depth, w}));
  } else {
    b.add_volume(make::box({-w, 0.0, -w}, {w, low, w}));
    b.add_volume(make::box({-w, high, -w}, {w, depth, w}));
    b.add_volume(make::box({-w, low, -w}, {-r, high, w}));
    b.add_volume(make::box({r, low, -w}, {w, high, w}));
    b.add_volume(make::box({-r, low, -w}, {r, high, -r}));
    b.add_volume(make::box({-r, low, r}, {r, high, w}));
    b.scene.stiffness = kGravity * depth / 0.04;  // the plan's rule for the whole depth, not for one block's
  }
  b.set_domain({-inner, -0.3, -inner}, {inner, 2.0 * depth + 0.1, inner});
  Trial e(b.scene, setting, cost);
  e.settle(1.0);
  Average up;
  e.run(0.4, [&] { up.add(e.bodies().bodies[static_cast<std::size_t>(body)].fluid.force.y); });
  return {{"buoyancy", "N", up.mean(), 1000.0 * kGravity * volume_of(solid), 0.0, true},
          {"noise, rms", "", up.noise_share(), 0.0, 1.0, false}};
}

std::vector<Reading> box(const Setting& setting, Cost& cost) {
  constexpr double kHalf = 0.04;
  return lift(make::box(glm::dvec3(-kHalf), glm::dvec3(kHalf)), 2.0 * kHalf, true, setting, cost);
}

std::vector<Reading> sphere(const Setting& setting, Cost& cost) {
  constexpr double kRadius = 0.025;
  return lift(make::sphere(kRadius, 24, 48), 2.0 * kRadius, false, setting, cost);
}

// A slab of half the water's density floats with half its height in the water, where it is put: let fall from
// 2 cm above it still bobbed by 0.6 mm after three seconds (4 mm). The level is read where it is.
std::vector<Reading> draft(const Setting& setting, Cost& cost) {
  constexpr double kSide = 0.08, kHeight = 0.04, kShare = 0.5, kTank = 0.2, kDepth = 0.08;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  b.add_fixed("tank", tank_at_floor({kTank, 0.2, kTank}, 0.04));
  const make::Solid solid =
      make::box({-0.5 * kSide, -0.5 * kHeight, -0.5 * kSide}, {0.5 * kSide, 0.5 * kHeight, 0.5 * kSide});
  const int slab =
      b.add_free("slab", solid, kShare * 1000.0 * volume_of(solid), {{0.0, kDepth, 0.0}, {1, 0, 0, 0}});
  b.add_volume(make::box({-0.5 * kTank, 0.0, -0.5 * kTank}, {0.5 * kTank, kDepth, 0.5 * kTank}));
  b.set_domain({-0.4, -0.3, -0.4}, {0.4, 0.6, 0.4});
  Trial e(b.scene, setting, cost);
  e.run(3.0);
  Average bottom, level;
  e.run(1.0, [&] {
    const BodyState& body = e.bodies().bodies[static_cast<std::size_t>(slab)];
    bottom.add(body.center_of_mass.y - 0.5 * kHeight);
    if (e.bodies().tick % 20 == 0) {
      // On the side that the slab has not drifted to.
      const double edge = 0.5 * kTank, from = body.center_of_mass.x > 0.0 ? -edge : edge - 0.04;
      level.add(surface_level(e.picture(), {from, -edge}, {from + 0.04, edge}, setting.spacing));
    }
  });
  return {{"draft", "m", level.mean() - bottom.mean(), kShare * kHeight, 0.0, true}};
}

// A ball of half the water's density, let go under water: (ρ_f − ρ_s) g / (ρ_s + ½ρ_f), 5 % less by the
// tank's walls and the ball's boundary layer.
std::vector<Reading> released(const Setting& setting, Cost& cost) {
  constexpr double kRadius = 0.02, kShare = 0.5, kTank = 0.16, kDepth = 0.16, kHeight = 0.07, kTime = 0.06;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.001);
  b.add_fixed("tank", tank_at_floor({kTank, 0.24, kTank}, 0.04));
  const make::Solid solid = make::sphere(kRadius, 24, 48);
  const int ball =
      b.add_free("ball", solid, kShare * 1000.0 * volume_of(solid), {{0.0, kHeight, 0.0}, {1, 0, 0, 0}});
  b.add_volume(make::box({-0.5 * kTank, 0.0, -0.5 * kTank}, {0.5 * kTank, kDepth, 0.5 * kTank}));
  b.add_grip(ball, 5e3, 20.0);
  b.set_domain({-0.4, -0.3, -0.4}, {0.4, 0.6, 0.4});
  Trial e(b.scene, setting, cost);
  e.handle(0).engaged = true;
  e.settle(1.0, true);
  e.run(0.1);
  e.handle(0).engaged = false;
  const double begin = e.world().time();
  const double before = e.bodies().bodies[static_cast<std::size_t>(ball)].twist.linear.y;
  e.run(kTime);
  const double gained = e.bodies().bodies[static_cast<std::size_t>(ball)].twist.linear.y - before;
  const double expected = mean_acceleration(
      {.radius = kRadius, .share = kShare, .width = kTank, .to_floor = kHeight, .to_level = kDepth - kHeight},
      kGravity, kTime);
  return {{"acceleration", "m/s²", gained / (e.world().time() - begin), expected, 0.0, true}};
}

}  // namespace

std::vector<ErrorCase> buoyancy_cases() {
  return {
      {"buoyancy_box", "A box of 80 mm under water", "ρgV", {0.016, 0.01, 0.008}, 1, box},
      {"buoyancy_sphere", "A ball of 50 mm under water", "ρgV", {0.01, 0.00714, 0.005, 0.004}, 2, sphere},
      {"draft",
       "A slab of half the water's density floats",
       "half its height",
       {0.013, 0.01, 0.008},
       1,
       draft},
      {"released",
       "A ball of half the water's density is let go",
       "added mass in the tank, Basset's force",
       {0.01, 0.008, 0.00667},
       1,
       released},
  };
}

}  // namespace slosh::report
