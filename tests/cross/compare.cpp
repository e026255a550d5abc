#include "tests/cross/compare.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tests/support/stirred_tank.h"

namespace slosh::testing {

namespace {

int failed = 0;

std::uint64_t hash_after(World& world, int steps, double hand_height, bool look) {
  Snapshot snapshot;
  for (int i = 0; i < steps; ++i) {
    step(world, hand_height);
    if (!look) continue;
    world.fill(snapshot);
    world.diagnostics();
  }
  return world.hash();
}

void restore_into(World& world, const World& from) {
  std::vector<std::uint8_t> bytes;
  expect_true("the state can be saved", static_cast<bool>(from.save(bytes)));
  const Result<bool> restored = world.restore(bytes);
  if (!restored) std::printf("  %s\n", restored.error().text().c_str());
  expect_true("and restored", static_cast<bool>(restored));
}

}  // namespace

int failures() {
  return failed;
}

void expect_at_most(const char* what, double value, double limit) {
  const bool fine = value <= limit;  // false for not-a-number
  failed += !fine;
  std::printf("  %-58s %-11.3g <= %-8.3g %s\n", what, value, limit, fine ? "ok" : "FAILED");
}

void expect_true(const char* what, bool fine) {
  failed += !fine;
  std::printf("  %-82s %s\n", what, fine ? "ok" : "FAILED");
}

World world_on(Backend backend, const Tank& tank, Plan plan) {
  Result<World> world = make_world(tank.scene, tank.sampled, std::move(plan), {1, backend});
  if (!world) {
    std::printf("%s\n", world.error().text().c_str());
    std::exit(1);
  }
  return std::move(world.value());
}

World world_on(Backend backend, const Tank& tank) {
  return world_on(backend, tank, make_plan(tank.scene, tank.sampled.spacing));
}

void step(World& world, double hand_height) {
  const HandleInput hand = hand_at(world.time(), hand_height);
  world.step({&hand, 1});
}

Tank shaken(Tank tank) {
  unsigned state = 7;
  const auto noise = [&] {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) / 8388608.0f - 1.0f;
  };
  for (glm::vec3& x : tank.sampled.fluid_positions)
    x = x * 0.97f + 1e-3f * glm::vec3(noise(), noise(), noise());
  for (glm::vec3& v : tank.sampled.fluid_velocities) v = 0.3f * glm::vec3(noise(), noise(), noise());
  return tank;
}

void compare_worlds(const World& cpu, const World& gpu, const Tolerance& tolerance) {
  const View a(cpu), b(gpu);
  double apart = 0.0, squares = 0.0;
  bool same_kinds = true;
  for (std::size_t p = 0; p < a.snapshot.positions.size(); ++p) {
    same_kinds &= a.snapshot.fluid_index[p] == b.snapshot.fluid_index[p];
    if (a.snapshot.fluid_index[p] == 255) continue;
    const double d = glm::distance(a.snapshot.positions[p], b.snapshot.positions[p]);
    apart = std::max(apart, d);
    squares += d * d;
  }
  expect_true("the same particles in the world", same_kinds && a.sums.particles == b.sums.particles);
  const double spacing = cpu.plan().spacing;
  expect_at_most("largest distance of a particle from itself / spacing", apart / spacing, tolerance.particle);
  const double particles = std::max<double>(a.sums.particles, 1.0);
  expect_at_most("its root mean square", std::sqrt(squares / particles) / spacing, tolerance.rest);
  const double speed = std::sqrt(2.0 * a.sums.kinetic_energy / a.sums.mass);
  expect_at_most("momentum / (mass rms speed)",
                 glm::length(a.sums.momentum - b.sums.momentum) / (a.sums.mass * speed), tolerance.rest);
  expect_at_most("kinetic energy", std::abs(b.sums.kinetic_energy / a.sums.kinetic_energy - 1.0),
                 tolerance.rest);
  expect_at_most("largest compression", std::abs(b.sums.max_compression - a.sums.max_compression),
                 tolerance.rest);
  for (std::size_t body = 0; body < a.snapshot.rigid.bodies.size(); ++body) {
    const Wrench& wa = a.snapshot.rigid.bodies[body].fluid;
    const Wrench& wb = b.snapshot.rigid.bodies[body].fluid;
    // Opposite walls cancel: the scale is that of the fluid's weight at least.
    const double scale = std::max(glm::length(wa.force), 9.81 * a.sums.mass);
    expect_at_most("force on a body / weight of the fluid", glm::length(wa.force - wb.force) / scale,
                   tolerance.rest);
    expect_at_most("torque on a body / (weight 0.1 m)", glm::length(wa.torque - wb.torque) / (0.1 * scale),
                   tolerance.rest);
  }
}

void compare_steps(const char* name, const Tank& tank, const Plan& plan, int steps,
                   const Tolerance& tolerance) {
  std::printf("%s, %d step(s)\n", name, steps);
  World cpu = world_on(Backend::kCpu, tank, plan);
  World gpu = world_on(Backend::kCuda, tank, plan);
  for (int i = 0; i < steps; ++i) {
    step(cpu, 0.09);
    step(gpu, 0.09);
  }
  compare_worlds(cpu, gpu, tolerance);
}

void compare_momenta(const Tank& tank, const Plan& plan, int steps, double tolerance) {
  World gpu = world_on(Backend::kCuda, tank, plan);
  const double dt = plan.time_step;
  double worst = 0.0;
  Snapshot now;
  Diagnostics before = gpu.diagnostics();
  for (int i = 0; i < steps; ++i) {
    const glm::dvec3 handed = before.clamp_impulse;  // walls have it from the step before
    step(gpu, kPaddleHeight);
    gpu.fill(now);
    const Diagnostics after = gpu.diagnostics();
    glm::dvec3 given = dt * before.mass * tank.scene.gravity;
    for (const BodyState& body : now.rigid.bodies) given -= dt * body.fluid.force;
    given += handed - after.clamp_impulse;
    worst =
        std::max(worst, glm::length(after.momentum - before.momentum - given) / (dt * 9.81 * before.mass));
    before = after;
  }
  expect_at_most("momentum identity, worst step / (weight dt)", worst, tolerance);
  expect_true("no solve was cut short", (gpu.take_status() & kStatusViscosityCut) == 0);
}

void compare_restored(const char* name, const Tank& tank, double hand_height, const Tolerance& tolerance) {
  std::printf("%s, saved after 100 steps and restored\n", name);
  World whole = world_on(Backend::kCuda, tank);
  for (int i = 0; i < 100; ++i) step(whole, hand_height);
  World again = world_on(Backend::kCuda, tank);
  for (int i = 0; i < 7; ++i) step(again, hand_height);
  restore_into(again, whole);
  expect_true("the same hash at once", again.hash() == whole.hash());
  for (int i = 0; i < 100; ++i) {
    step(whole, hand_height);
    step(again, hand_height);
  }
  expect_true("the same hash 100 steps later", again.hash() == whole.hash());
  // From one backend to the other, both ways, then one step each.
  World cpu = world_on(Backend::kCpu, tank);
  restore_into(cpu, whole);
  step(cpu, hand_height);
  step(whole, hand_height);
  compare_worlds(cpu, whole, tolerance);
  World gpu = world_on(Backend::kCuda, tank);
  restore_into(gpu, cpu);
  step(cpu, hand_height);
  step(gpu, hand_height);
  compare_worlds(cpu, gpu, tolerance);
}

void repeat(const char* name, const Tank& tank, double hand_height, int steps) {
  std::printf("%s, %d steps on the GPU, repeated\n", name, steps);
  World first = world_on(Backend::kCuda, tank);
  const std::uint64_t once = hash_after(first, steps, hand_height, false);
  World second = world_on(Backend::kCuda, tank);
  expect_true("the same hash again", once == hash_after(second, steps, hand_height, false));
  World watched = world_on(Backend::kCuda, tank);
  expect_true("the same hash when looked at after every step",
              once == hash_after(watched, steps, hand_height, true));
  // Two worlds on one GPU at a time: blocks are scheduled differently.
  World left = world_on(Backend::kCuda, tank);
  World right = world_on(Backend::kCuda, tank);
  for (int i = 0; i < steps; ++i) {
    step(left, hand_height);
    step(right, hand_height);
  }
  expect_true("the same hash beside another world", left.hash() == once && right.hash() == once);
  step(left, hand_height);
  expect_true("another hash one step later", left.hash() != once);
}

}  // namespace slosh::testing
