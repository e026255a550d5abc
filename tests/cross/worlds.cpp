#include "tests/cross/worlds.h"

#include <cmath>

#include "tests/support/stirred_tank.h"

namespace slosh::testing {

Tank stirred_tank(ParticleModel model) {
  Tank tank = stirred_tank(0.1);
  tank.scene.model = model;
  return tank;
}

HandleInput hand_at(double time, double height) {
  constexpr double kSway = 2.0 * 3.14159265358979323846;  // rad/s
  HandleInput hand;
  hand.engaged = true;
  hand.pose.position = {-0.05 * std::cos(kSway * time), height, 0.01 * std::sin(20.0 * time)};
  hand.twist.linear = {0.05 * kSway * std::sin(kSway * time), 0.0, 0.2 * std::cos(20.0 * time)};
  return hand;
}

Tank probed_tank() {
  Tank tank = make_tank({});
  Body probe;
  probe.name = "probe";
  probe.motion = BodyMotion::kFree;
  probe.point_probe = true;
  probe.mass.mass = 0.02;
  probe.pose.position = {-0.05, 0.05, 0.0};
  tank.scene.bodies.push_back(probe);
  tank.sampled.surfaces.emplace_back();
  tank.sampled.distance_fields.emplace_back();
  add_grip(tank, 1);
  tank.scene.grips[0].rotational_stiffness = tank.scene.grips[0].rotational_damping = 0.0;
  return tank;
}

Tank pool(double particles) {
  TankOptions options;
  // As deep as a fifth of its side.
  const double side_count = std::cbrt(5.0 * particles);
  options.spacing = 1.0 / std::round(side_count);
  options.inner = {1.0, 0.4, 1.0};
  options.fill = options.spacing * std::round(particles * std::pow(options.spacing, 2));
  Tank tank = make_tank(options);
  return tank;
}

}  // namespace slosh::testing
