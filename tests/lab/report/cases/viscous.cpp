// Torques and drags: what viscosity feels like.
#include <array>
#include <cmath>
#include <cstdio>

#include "sim/backend.h"
#include "tests/lab/report/error_case.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/surface.h"

namespace slosh::report {
namespace {

struct Spin {
  static constexpr double kRadius = 0.05, kShort = 0.06, kTall = 0.12, kBetween = kTall - kShort;  // m
  static constexpr std::array<glm::dvec2, 3> kShape{{{0.02, 1.2790}, {0.05, 0.5711}, {0.1, 0.2377}}};
  std::array<double, kShape.size()> torque{};
  double impulse = 0.0;

  // A glass filled to `height` with fluid of `viscosity` Pa·s that suddenly turns at `turning` rad/s until τ
  // is `until`.
  Spin(double height, double viscosity, double turning, double until, const Setting& setting, Cost& cost) {
    SceneBuilder b;
    b.add_fluid(1000.0, viscosity);
    const int glass = b.add_free("glass", glass_of(kRadius, height + 0.02, 0.02), 0.5);
    b.set_viscosity({glass}, viscosity);
    b.add_volume(filling_of(kRadius, height));
    b.add_stiff_grip(glass);
    b.set_domain({-0.2, -0.1, -0.2}, {0.2, 0.3, 0.2});
    Trial e(b.scene, setting, cost);
    e.handle(0).engaged = true;
    e.settle(0.3);
    e.run(0.1);
    const double scale = kRadius * kRadius * 1000.0 / viscosity, dt = e.world().plan().time_step;
    std::size_t next = 0;
    double last = 0.0, last_tau = 0.0;
    e.turn(glass, turning, until * scale, [&](double time, double now) {
      // The force of a step is that at its start: the glass has turned for one step less.
      const double tau = (time - dt) / scale;
      impulse += dt * now;
      while (next < kShape.size() && tau >= kShape[next].x) {
        torque[next] = glm::mix(last, now, (kShape[next].x - last_tau) / (tau - last_tau));
        ++next;
      }
      last = now;
      last_tau = tau;
    });
  }
};

// Two fillings of the same glass: the floor's part is in both, so the difference is what the wall between the
// two heights does to an infinitely long cylinder.
std::vector<Reading> spin_up(const Setting& setting, Cost& cost) {
  constexpr double kViscosity = 2.0, kTurning = 0.5;  // slow: nothing is thrown outwards
  const Spin low(Spin::kShort, kViscosity, kTurning, 0.6, setting, cost),
      high(Spin::kTall, kViscosity, kTurning, 0.6, setting, cost);
  std::vector<Reading> readings;
  for (std::size_t i = 0; i < Spin::kShape.size(); ++i) {
    const double expected = 4.0 * kPi * kViscosity * kTurning * Spin::kRadius * Spin::kRadius *
                            Spin::kShape[i].y * Spin::kBetween;
    readings.push_back({"torque at tau " + std::to_string(Spin::kShape[i].x).substr(0, 4), "N·m",
                        high.torque[i] - low.torque[i], expected, 0.0, i == 0});
  }
  readings.push_back({"impulse", "N·m·s", high.impulse - low.impulse,
                      0.5 * kPi * 1000.0 * kTurning * std::pow(Spin::kRadius, 4) * Spin::kBetween, 0.0,
                      false});
  return readings;
}

// The same for thin and thick fluid, slowly and ten times as fast; at τ = 0.05, and on for what a long step
// is behind.
std::vector<Reading> spin_up_all(const Setting& setting, Cost& cost) {
  std::vector<Reading> readings;
  for (const double turning : {0.5, 5.0}) {
    for (const double viscosity : {0.5, 1.0, 2.0, 5.0}) {
      const Spin low(Spin::kShort, viscosity, turning, 0.07, setting, cost),
          high(Spin::kTall, viscosity, turning, 0.07, setting, cost);
      char text[48];
      std::snprintf(text, sizeof text, "torque, %.1f Pa·s at %.1f rad/s", viscosity, turning);
      readings.push_back({text, "N·m", high.torque[1] - low.torque[1],
                          4.0 * kPi * viscosity * turning * Spin::kRadius * Spin::kRadius *
                              Spin::kShape[1].y * Spin::kBetween,
                          0.0, readings.empty()});
    }
  }
  return readings;
}

// A ball on the axis of a closed tube, moved up and down by a stiff hand: 6πμaU times the wall's factor.
template <int kPascalSeconds>
std::vector<Reading> stokes(const Setting& setting, Cost& cost) {
  constexpr double kBall = 0.012, kTube = 0.04, kViscosity = kPascalSeconds, kSpeed = 0.02, kWay = 0.024,
                   kFill = 0.12;
  constexpr double kWallFactor = 2.3697;  // at a radius ratio of 0.3
  SceneBuilder b;
  b.add_fluid(1000.0, kViscosity);
  const int tube = b.add_fixed("tube", glass_of(kTube, kFill + 0.03, 0.02));
  const int ball = b.add_free("ball", make::sphere(kBall, 24, 48), 0.05, {{0.0, 0.048, 0.0}, {1, 0, 0, 0}});
  b.set_viscosity({tube, ball}, kViscosity);
  b.add_volume(filling_of(kTube, kFill));
  b.add_grip(ball, 2e4, 100.0);
  b.set_domain({-0.2, -0.1, -0.2}, {0.2, 0.3, 0.2});
  Trial e(b.scene, setting, cost);
  HandleInput& hand = e.handle(0);
  hand.engaged = true;
  e.settle(0.5, true);
  // Each stroke in halves: the first has the start in it.
  const auto stroke = [&](double speed) {
    std::array<Average, 2> halves;
    const double from = hand.pose.position.y, begin = e.world().time();
    hand.twist.linear.y = speed;
    for (Average& half : halves) {
      e.run(0.5 * kWay / kSpeed, [&] {
        hand.pose.position.y = from + speed * (e.world().time() - begin);
        half.add(e.bodies().bodies[static_cast<std::size_t>(ball)].fluid.force.y);
      });
    }
    return std::array{halves[0].mean(), halves[1].mean()};
  };
  const auto up = stroke(kSpeed), down = stroke(-kSpeed);
  const double expected = 6.0 * kPi * kViscosity * kBall * kSpeed * kWallFactor;
  const double second = 0.5 * (down[1] - up[1]), first = 0.5 * (down[0] - up[0]);
  // Up is resisted downwards; half the difference has no buoyancy in it.
  return {{"drag", "N", second, expected, 0.0, true},
          {"drift over a stroke", "", (second - first) / expected, 0.0, 1.0, false}};
}

// That ball is turned about the tube's axis: 8πμa³Ω times the wall's factor. As light as a hundredth of the
// fluid and 20 times as heavy, in fluid that is stepped and, where the model has that, in fluid that is
// implicit viscosity: explicit steps at 1000 Pa·s are a hundred times as many.
std::vector<Reading> turned_ball(const Setting& setting, Cost& cost) {
  constexpr double kBall = 0.012, kTube = 0.04, kFill = 0.096, kTurning = 2.0;
  constexpr double kWallFactor = 1.0 + 0.7968 * 0.027;  // at a radius ratio of 0.3 (Brenner & Sonshine 1964)
  const make::Solid solid = make::sphere(kBall, 24, 48);
  constexpr double kStepped = 5.0;
  const bool solves = setting.solve_viscosity && corrects_gradients(setting.model);
  const auto torque_of = [&](double viscosity, double density) {
    SceneBuilder b;
    b.add_fluid(1000.0, viscosity);
    const int tube = b.add_fixed("tube", glass_of(kTube, kFill + 0.03, 0.02));
    const int ball = b.add_free("ball", solid, density * volume_of(solid), {{0.0, 0.048, 0.0}, {1, 0, 0, 0}});
    b.set_viscosity({tube, ball}, kFluidsViscosity);
    b.add_volume(filling_of(kTube, kFill));
    b.add_stiff_grip(ball);
    b.set_domain({-0.2, -0.1, -0.2}, {0.2, 0.3, 0.2});
    Trial e(b.scene, setting, cost);
    e.handle(0).engaged = true;
    e.settle(0.5, true);
    Average torque;
    e.turn(ball, kTurning, 0.4, [&](double time, double now) {
      if (time > 0.1) torque.add(now);
    });
    return torque.mean();
  };
  std::vector<Reading> readings;
  for (const double viscosity : {kStepped, 50.0, 1000.0}) {
    for (const double heavy : {0.01, 20.0}) {
      if (viscosity > kStepped && !solves) continue;
      char text[64];
      std::snprintf(text, sizeof text, "torque, %g Pa·s, %g of the density", viscosity, heavy);
      readings.push_back({text, "N·m", torque_of(viscosity, 1000.0 * heavy),
                          8.0 * kPi * viscosity * kTurning * std::pow(kBall, 3) * kWallFactor, 0.0,
                          readings.empty()});
    }
  }
  return readings;
}

// A ball of 24 mm goes 8 mm at 2 cm/s across a tank of water and stops, twice there and twice back. Its drag
// is 0.05 mN (Re 480); what is measured beyond that is a fluid that yields like sand. That turns round with
// the stroke, and what the water does by itself does not: one stroke alone reads up to 1 mN of that. Errors
// are shares of the ball's buoyancy.
std::vector<Reading> slow_ball(const Setting& setting, Cost& cost) {
  constexpr double kSide = 0.096, kHalf = 0.5 * kSide, kSpeed = 0.02, kWay = 0.008, kDrag = 0.05e-3;
  constexpr int kStrokes = 4;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.001);
  b.add_fixed("tank", tank_at_floor({kSide, 0.12, kSide}, 0.02));
  const make::Solid solid = make::sphere(0.012, 24, 48);
  const int ball = b.add_free("ball", solid, 0.05, {{-0.5 * kWay, 0.048, 0.0}, {1, 0, 0, 0}});
  b.add_volume(make::box({-kHalf, 0.0, -kHalf}, {kHalf, kSide, kHalf}));
  b.add_grip(ball, 2000.0, 10.0);
  b.set_domain({-0.15, -0.1, -0.15}, {0.15, 0.25, 0.15});
  Trial e(b.scene, setting, cost);
  HandleInput& hand = e.handle(0);
  hand.engaged = true;
  e.settle(1.0, true);
  const glm::dvec3 middle = hand.pose.position + glm::dvec3(0.5 * kWay, 0.0, 0.0);
  Average moving, left;  // of the strokes
  for (int stroke = 0; stroke < kStrokes; ++stroke) {
    const double to = stroke % 2 ? -1.0 : 1.0, begin = e.world().time();
    Average along, after;
    const auto resists = [&] {
      return -to * e.bodies().bodies[static_cast<std::size_t>(ball)].fluid.force.x;
    };
    hand.twist.linear = {to * kSpeed, 0.0, 0.0};
    e.run(kWay / kSpeed, [&] {
      const double way = std::min(kWay, kSpeed * (e.world().time() - begin));
      hand.pose.position = middle + glm::dvec3(to * (way - 0.5 * kWay), 0.0, 0.0);
      if (way > 0.5 * kWay) along.add(resists());
    });
    hand.twist.linear = glm::dvec3(0.0);
    e.run(0.8);
    e.run(0.2, [&] { after.add(resists()); });
    moving.add(along.median());
    left.add(after.median());
  }
  const double buoyancy = 1000.0 * kGravity * volume_of(solid);
  return {{"force, moving", "N", moving.mean(), kDrag, buoyancy, true},
          {"force left 0.9 s after", "N", left.mean(), 0.0, buoyancy, true}};
}

// A free slab without weight, kHeight thick, moves along itself as cos(ky), k = π/kHeight: its faces bear no
// stress and neither does the wave at them, so it dies as exp(−νk²t) and nothing but the viscosity has a part
// in it. Its ends bear none either and the wave does there; the middle third does not feel them (half as long
// a slab reads 1.7 to 2.6 % less, one half as long again the same).
std::vector<Reading> shear_wave(const Setting& setting, Cost& cost) {
  constexpr double kHeight = 0.08, kLength = 0.64, kWidth = 0.08, kViscosity = 5.0, kSpeed = 0.02;
  constexpr double kWave = kPi / kHeight, kRate = kViscosity / 1000.0 * kWave * kWave;
  SceneBuilder b;
  b.add_fluid(1000.0, kViscosity);
  b.add_volume(make::box({-0.5 * kLength, 0.0, -0.5 * kWidth}, {0.5 * kLength, kHeight, 0.5 * kWidth}));
  b.scene.gravity = glm::dvec3(0.0);
  b.set_domain({-0.4, -0.2, -0.3}, {0.4, 0.3, 0.3});
  SampledScene start = sampled_for(b.scene, setting);
  std::vector<double> shape;  // cos(ky) of each particle
  for (std::size_t i = 0; i < start.fluid_positions.size(); ++i) {
    shape.push_back(std::cos(kWave * static_cast<double>(start.fluid_positions[i].y)));
    start.fluid_velocities[i] = {static_cast<float>(kSpeed * shape.back()), 0.0f, 0.0f};
  }
  Trial e(b.scene, start, setting, cost);
  Snapshot before = e.picture();
  std::vector<glm::dvec2> logs;
  const double dt = e.world().plan().time_step;
  const auto inside = [&](std::size_t i, const glm::dvec3& from, const glm::dvec3& to) {
    return std::abs(to.x) > kLength / 6.0 ? Along{} : Along{{to.x - from.x, 0.0}, {shape[i], 0.0}};
  };
  e.run(1.5 / kRate, [&] {
    const Snapshot now = e.picture();
    const double speed = share_of_shape(before, now, inside) / dt;
    before = now;
    // What the sudden start makes of the lattice's own modes is gone by then.
    if (e.world().time() > 0.3 / kRate) logs.emplace_back(e.world().time(), std::log(std::max(speed, 1e-12)));
  });
  return {{"rate of decay", "1/s", -slope_of(logs), kRate, 0.0, true}};
}

}  // namespace

std::vector<ErrorCase> viscous_cases() {
  return {
      {"spin_up",
       "A cylinder of 2 Pa·s that suddenly turns",
       "S(τ) of the long cylinder",
       {0.01, 0.00714, 0.005},
       1,
       spin_up},
      {"spin_up_all",
       "That cylinder, thin and thick, slow and fast",
       "S(τ) of the long cylinder",
       {0.00714, 0.005},
       1,
       spin_up_all},
      {"stokes",
       "A ball moved slowly on a tube's axis, 5 Pa·s",
       "6πμaU, times 2.37 for the tube",
       {0.008, 0.006, 0.005},
       1,
       stokes<5>},
      {"stokes_honey",
       "A ball on that axis in 50 Pa·s",
       "6πμaU, times 2.37 for the tube",
       {0.008, 0.006},
       1,
       stokes<50>},
      {"slow_ball",
       "A ball moved at 2 cm/s through water",
       "drag at Re 480",
       {0.008, 0.006, 0.0048, 0.004},
       2,
       slow_ball},
      {"turned_ball",
       "A ball turned in a tube",
       "8πμa³Ω times the wall's factor",
       {0.008, 0.006, 0.004},
       1,
       turned_ball},
      {"shear_wave",
       "A shear wave dies in a free slab, 5 Pa·s",
       "exp(−νk²t)",
       {0.01, 0.008, 0.00571},
       1,
       shear_wave},
  };
}

}  // namespace slosh::report
