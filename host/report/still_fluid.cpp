#include "host/report/still_fluid.h"

#include <cmath>

#include "host/report/surface.h"

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
