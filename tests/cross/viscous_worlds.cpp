// Implicit viscosity on both backends: fluids of one and of two viscosities, a body that a hand holds and one
// that nobody does, more neighbours than a row has room for.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/cross/compare.h"
#include "tests/support/stirred_tank.h"

namespace slosh::testing {

namespace {

// Where a solve ends by its tolerance rounding may give one of the two a turn more: then they differ by what
// the tolerance leaves.
constexpr double kOneStep = 1e-5;
constexpr double kTenSteps = 1e-3;

Plan solving_plan(const Tank& tank) {
  const Plan plan = make_plan(tank.scene, tank.sampled.spacing);
  expect_true("the plan has implicit viscosity", plan.has(PassId::kImplicitViscosity));
  return plan;
}

void compare_drags(const World& cpu, const World& gpu) {
  double apart = 0.0, largest = 0.0;
  bool as_many = cpu.drags().size() == gpu.drags().size();
  for (std::size_t b = 0; as_many && b < cpu.drags().size(); ++b) {
    const Matrix6& m = cpu.drags()[b];
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        const double scale = std::sqrt(m[i][i] * m[j][j]);
        if (scale > 0.0) apart = std::max(apart, std::abs(gpu.drags()[b][i][j] - m[i][j]) / scale);
        largest = std::max(largest, m[i][j]);
      }
    }
  }
  expect_true("drag matrices are told", as_many && largest > 0.0);
  expect_at_most("drag matrices, of their diagonals", apart, 1e-5);
}

void compare_pulled(const char* name, const Tank& tank) {
  std::printf("%s, held paddle and free box, 100 steps\n", name);
  const Plan plan = solving_plan(tank);
  double weight = 0.0;
  glm::dvec3 mean[2]{}, at[2]{};
  int n = 0;
  for (const Backend backend : {Backend::kCpu, Backend::kCuda}) {
    World world = world_on(backend, tank, plan);
    weight = 9.81 * world.diagnostics().mass;
    BodySnapshot bodies;
    for (int i = 0; i < 100; ++i) {
      step(world, kPaddleHeight);
      world.fill(bodies);
      mean[n] += bodies.bodies[1].fluid.force / 100.0;
    }
    at[n++] = bodies.bodies[2].pose.position;
  }
  std::printf("  mean force on the paddle: CPU %.5f %.5f %.5f N, GPU %.5f %.5f %.5f N\n", mean[0].x,
              mean[0].y, mean[0].z, mean[1].x, mean[1].y, mean[1].z);
  expect_true("the fluid drags it", glm::length(mean[0]) > 0.01 * weight);
  expect_at_most("mean force on the paddle", glm::distance(mean[0], mean[1]) / glm::length(mean[0]), 1e-3);
  expect_at_most("where the box is at last, m", glm::distance(at[0], at[1]), 1e-5);
  compare_momenta(tank, plan, 50, 1e-6);
}

}  // namespace

void compare_viscous_step() {
  const Tank tank = shaken(thick_tank(50.0, 500.0));
  const Plan plan = solving_plan(tank);
  compare_steps("implicit viscosity, 50 Pa·s under 500", tank, plan, 1, kOneStep);
  World cpu = world_on(Backend::kCpu, tank, plan);
  World gpu = world_on(Backend::kCuda, tank, plan);
  step(cpu, kPaddleHeight);
  step(gpu, kPaddleHeight);
  compare_drags(cpu, gpu);
}

void compare_viscous() {
  struct Case {
    const char* name;
    double below, above;  // Pa·s
  };
  for (const Case& c :
       {Case{"implicit viscosity, 50 Pa·s", 50.0, 50.0}, Case{"implicit viscosity, 500 Pa·s", 500.0, 500.0},
        Case{"implicit viscosity, 50 Pa·s under 500", 50.0, 500.0}}) {
    const Tank calm = thick_tank(c.below, c.above);
    const Tank tank = shaken(calm);
    const Plan plan = solving_plan(tank);
    compare_steps(c.name, tank, plan, 1, kOneStep);
    compare_steps(c.name, tank, plan, 10, kTenSteps);
    World cpu = world_on(Backend::kCpu, tank, plan);
    World gpu = world_on(Backend::kCuda, tank, plan);
    step(cpu, kPaddleHeight);
    step(gpu, kPaddleHeight);
    compare_drags(cpu, gpu);
    compare_pulled(c.name, calm);
    repeat(c.name, calm, kPaddleHeight, 100);
  }
  Tank squeezed = thick_tank(50.0, 50.0);
  for (glm::vec3& x : squeezed.sampled.fluid_positions) x = x * 0.7f;
  compare_steps("implicit viscosity, more neighbours than a row has room for", squeezed,
                solving_plan(squeezed), 1, kOneStep);
}

}  // namespace slosh::testing
