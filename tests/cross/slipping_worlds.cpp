// Free-slip walls in thick fluid, on both backends: explicit and implicit viscosity, of one and of two
// viscosities.
#include "sim/viscosity/wall_drag.h"
#include "tests/cross/compare.h"
#include "tests/support/stirred_tank.h"

namespace slosh::testing {

namespace {

constexpr double kOneStep = 1e-5;
constexpr double kTenSteps = 1e-3;

// Its walls' normals lean as if they were bent, so that every term of a mirror is at work.
Tank slipping_tank(double below, double above) {
  Tank tank = stirred_tank(kFreeSlip);
  tank.scene.fluids[0].dynamic_viscosity = below;
  tank.scene.fluids[1].dynamic_viscosity = above;
  SurfaceSamples& walls = tank.sampled.surfaces[0];
  for (std::size_t i = 0; i < walls.normals.size(); ++i) {
    const glm::vec3& p = walls.positions[i];
    walls.normals[i] = glm::normalize(walls.normals[i] + glm::vec3(2.0f * p.z, p.x - p.z, 1.5f * p.x));
  }
  return tank;
}

}  // namespace

void compare_slipping() {
  struct Case {
    const char* name;
    double below, above;  // Pa·s
    bool solved;
  };
  for (const Case& c : {Case{"free-slip walls, 2 Pa·s", 2.0, 2.0, false},
                        Case{"free-slip walls, 2 Pa·s under 5", 2.0, 5.0, false},
                        Case{"free-slip walls, implicit viscosity, 50 Pa·s", 50.0, 50.0, true},
                        Case{"free-slip walls, implicit viscosity, 50 Pa·s under 500", 50.0, 500.0, true}}) {
    const Tank tank = shaken(slipping_tank(c.below, c.above));
    const Plan plan = make_plan(tank.scene, tank.sampled.spacing, c.solved);
    expect_true("walls mirror what is beside them", drag_layer(tank.scene, plan) == DragLayer::kSurface);
    expect_true("implicit viscosity or not, as asked", plan.has(PassId::kImplicitViscosity) == c.solved);
    compare_steps(c.name, tank, plan, 1, kOneStep);
    compare_steps(c.name, tank, plan, 10, kTenSteps);
  }
}

}  // namespace slosh::testing
