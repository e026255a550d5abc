#include "tests/lab/report/still_fluid.h"

#include <cmath>

#include "tests/lab/report/surface.h"

namespace slosh::report {

SceneBuilder full_tank(ParticleModel model, double density, double viscosity) {
  constexpr double kTank = 0.16;
  SceneBuilder b;
  b.scene.model = model;
  b.add_fluid(density, viscosity);
  b.add_fixed("tank", tank_at_floor({kTank, kTank + 0.08, kTank}, 0.04));
  b.add_volume(make::box({-0.5 * kTank, 0.0, -0.5 * kTank}, {0.5 * kTank, kTank, 0.5 * kTank}));
  b.set_domain({-0.4, -0.3, -0.4}, {0.4, 0.6, 0.4});
  return b;
}

namespace {

SceneBuilder turning_glass() {
  constexpr double kThick = 0.02, kViscosity = 0.5;
  SceneBuilder b;
  b.add_fluid(1000.0, kViscosity);
  const int glass =
      b.add_free("glass", glass_of(TurningGlass::kRadius, TurningGlass::kDepth + 0.06, kThick), 0.5);
  b.set_viscosity({glass}, kViscosity);
  b.scene.bodies[static_cast<std::size_t>(glass)].twist.angular = {0.0, TurningGlass::kTurning, 0.0};
  b.add_volume(filling_of(TurningGlass::kRadius, TurningGlass::kDepth));
  b.add_stiff_grip(glass);
  b.set_domain({-0.2, -0.1, -0.2}, {0.2, 0.3, 0.2});
  return b;
}

SampledScene turning_sampled(const SceneBuilder& b, const Setting& setting) {
  SampledScene start = sampled_for(b.scene, setting);
  const glm::vec3 turning(0.0f, static_cast<float>(TurningGlass::kTurning), 0.0f);
  for (std::size_t i = 0; i < start.fluid_positions.size(); ++i)
    start.fluid_velocities[i] = glm::cross(turning, start.fluid_positions[i]);
  return start;
}

}  // namespace

TurningGlass::TurningGlass(const Setting& setting, Cost& cost)
    : TurningGlass(turning_glass(), setting, cost) {}

TurningGlass::TurningGlass(const SceneBuilder& b, const Setting& setting, Cost& cost)
    : trial_(b.scene, turning_sampled(b, setting), setting, cost) {
  trial_.handle(0).engaged = true;
  trial_.handle(0).twist.angular.y = kTurning;
}

void TurningGlass::turn() {
  trial_.handle(0).pose.orientation = glm::angleAxis(kTurning * trial_.world().time(), kUp);
}

Turnover turnover(Trial& trial) {
  trial.settle(1.0);
  trial.run(0.3);
  const Snapshot before = trial.picture();
  const double begin = trial.world().time();
  trial.run(0.1);
  const Snapshot after = trial.picture();
  const double time = trial.world().time() - begin;
  Average squares, up;
  for (std::size_t i = 0; i < after.positions.size(); ++i) {
    if (after.fluid_index[i] == kRetired) continue;
    const glm::dvec3 p(after.positions[i]);
    const glm::dvec3 v = (p - glm::dvec3(before.positions[i])) / time;
    squares.add(glm::dot(v, v));
    if (std::hypot(p.x, p.z) < 0.05 && p.y > 0.03 && p.y < 0.13) up.add(v.y);
  }
  return {std::sqrt(squares.mean()), up.mean()};
}

}  // namespace slosh::report
