// A batter is told by the torque that it takes to stir it: what the robot of Luo et al. (arXiv 2407.01755)
// tells the share of water and the level by. In creeping flow the torque goes with the viscosity, whatever
// the stirrer; of a rod in a round vessel it has a closed form.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/lab/report/error_case.h"
#include "tests/lab/report/scene_builder.h"

namespace slosh::report {
namespace {

constexpr double kPotRadius = 0.05, kStirRodRadius = 0.03, kUnderStirrer = 0.012;  // m
constexpr double kStirring = 2.0;                                                  // rad/s
constexpr double kKnownBatter = 4.0;                                               // Pa·s

/// What turns, and what of the pot above its foot the batter fills up to `height` beside it.
struct Stirrer {
  make::Solid (*solid)(double top);
  make::Solid (*around)(double height);
};

make::Solid stirring_rod(double top) {
  return make::lathe(
      {{0.0, kUnderStirrer}, {kStirRodRadius, kUnderStirrer}, {kStirRodRadius, top}, {0.0, top}}, 96);
}
make::Solid batter_round_rod(double height) {
  return make::lathe({{kStirRodRadius, kUnderStirrer},
                      {kPotRadius, kUnderStirrer},
                      {kPotRadius, height},
                      {kStirRodRadius, height}},
                     96);
}

constexpr double kBladeWide = 0.032, kBladeHalf = 0.004, kBladeTop = 0.06;  // m

/// Four blades side by side and a shaft that stands on them.
make::Solid stirring_blades(double top) {
  const make::Solid across =
      make::box({-kBladeWide, kUnderStirrer, -kBladeHalf}, {kBladeWide, kBladeTop, kBladeHalf});
  const make::Solid front =
      make::box({-kBladeHalf, kUnderStirrer, kBladeHalf}, {kBladeHalf, kBladeTop, kBladeWide});
  const make::Solid back =
      make::box({-kBladeHalf, kUnderStirrer, -kBladeWide}, {kBladeHalf, kBladeTop, -kBladeHalf});
  const make::Solid shaft =
      make::lathe({{0.0, kBladeTop}, {kBladeHalf, kBladeTop}, {kBladeHalf, top}, {0.0, top}}, 24);
  return make::merged(make::merged(across, shaft), make::merged(front, back));
}

/// A quarter of the pot between two blades; what is beyond their ends it flows into when it settles.
make::Solid between_blades() {
  constexpr int kSteps = 24;
  const double from = std::asin(kBladeHalf / kPotRadius), to = 0.5 * kPi - from;
  std::vector<glm::dvec2> corners{{kBladeHalf, kBladeHalf}};
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = from + (to - from) * i / kSteps;
    corners.emplace_back(kPotRadius * std::cos(angle), kPotRadius * std::sin(angle));
  }
  make::Solid solid;
  for (const double y : {kUnderStirrer, kBladeTop})
    for (const glm::dvec2& c : corners) solid.points.emplace_back(c.x, y, c.y);
  const auto count = static_cast<unsigned>(corners.size());
  for (unsigned i = 0; i < count; ++i) {
    const unsigned next = (i + 1) % count;
    solid.triangles.emplace_back(i, next + count, next);
    solid.triangles.emplace_back(i, i + count, next + count);
    if (i == 0 || next == 0) continue;
    solid.triangles.emplace_back(0u, i, next);
    solid.triangles.emplace_back(count, next + count, i + count);
  }
  return solid;
}
make::Solid batter_round_blades(double height) {
  make::Solid all = make::lathe(
      {{kBladeHalf, kBladeTop}, {kPotRadius, kBladeTop}, {kPotRadius, height}, {kBladeHalf, height}}, 96);
  for (int i = 0; i < 4; ++i) {
    const glm::dquat turn = glm::angleAxis(0.5 * kPi * i, kUp);
    all = make::merged(std::move(all), make::transformed(between_blades(), glm::mat4_cast(turn)));
  }
  return all;
}

constexpr Stirrer kStirringRod{stirring_rod, batter_round_rod},
    kStirringBlades{stirring_blades, batter_round_blades};

/// N·m that a motor gives, which turns `stirrer` in a pot filled to `height`, once the batter flows evenly.
double torque_to_stir(const Stirrer& stirrer, double height, double viscosity, const Setting& setting,
                      Cost& cost) {
  // The pot's own time, R²/(j² ν), is 0.2 s in the thinnest.
  constexpr double kEven = 0.6, kRead = 0.4;  // s
  SceneBuilder b;
  b.add_fluid(1000.0, viscosity);
  const int pot = b.add_fixed("pot", glass_of(kPotRadius, height + 0.03, 0.02));
  const int turned = b.add_free("stirrer", stirrer.solid(height + 0.03), 0.3);
  b.set_viscosity({pot, turned}, viscosity);
  b.add_volume(filling_of(kPotRadius, kUnderStirrer));
  b.add_volume(stirrer.around(height));
  b.scene.stiffness = kGravity * 0.1 / 0.04;  // the plan's rule, of the deepest
  b.set_domain({-0.2, -0.1, -0.2}, {0.2, 0.3, 0.2});
  Joint motor;
  motor.name = "motor";
  motor.body = turned;
  motor.motor_speed = kStirring;
  motor.motor_limit = 10.0;
  b.scene.joints.push_back(motor);
  Trial e(b.scene, setting, cost);
  e.settle(0.5);
  e.run(kEven);
  Average torque;
  e.run(kRead, [&] { torque.add(e.bodies().joints[0].motor); });
  return torque.mean();
}

// The difference of two fillings: what floor and foot do is in both. From these two a third is told.
void read_levels(std::vector<Reading>& readings, const Setting& setting, Cost& cost) {
  constexpr double kLow = 0.06, kMiddle = 0.08, kHigh = 0.1, kR1 = kStirRodRadius * kStirRodRadius,
                   kR2 = kPotRadius * kPotRadius;
  const auto at = [&](double height) {
    return torque_to_stir(kStirringRod, height, kKnownBatter, setting, cost);
  };
  const double low = at(kLow), high = at(kHigh);
  const double expected = 4.0 * kPi * kKnownBatter * kStirring * kR1 * kR2 / (kR2 - kR1) * (kHigh - kLow);
  readings.push_back({"torque of a rod, 4 Pa·s", "N·m", high - low, expected, 0.0, true});
  readings.push_back({"level told", "m", kLow + (at(kMiddle) - low) / (high - low) * (kHigh - kLow), kMiddle,
                      kMiddle - kLow, false});
}

std::vector<Reading> stirred_batter(const Setting& setting, Cost& cost) {
  std::vector<Reading> readings;
  read_levels(readings, setting, cost);
  const auto of = [&](double viscosity) {
    return torque_to_stir(kStirringBlades, 0.08, viscosity, setting, cost);
  };
  const double known = of(kKnownBatter);
  for (const int viscosity : {1, 2, 8}) {
    readings.push_back({"viscosity told, " + std::to_string(viscosity) + " Pa·s", "Pa·s",
                        kKnownBatter * of(viscosity) / known, static_cast<double>(viscosity), 0.0, true});
  }
  return readings;
}

}  // namespace

std::vector<ErrorCase> stirring_cases() {
  return {{"stirred_batter",
           "Batters of 1 to 8 Pa·s are told by the torque that stirs them",
           "torque ∝ μ; 4πμΩR₁²R₂²/(R₂²−R₁²)",
           {0.00667, 0.005, 0.004},
           1,
           stirred_batter}};
}

}  // namespace slosh::report
