// Bodies that are cut, on both.
#include <algorithm>
#include <cstdio>

#include "tests/cross/compare.h"

namespace slosh::testing {
namespace {

const glm::dvec3 kHalf(0.03, 0.02, 0.03);  // m, of the block

SurfaceSamples block_samples(double apart) {
  SurfaceSamples samples;
  samples.apart = static_cast<float>(apart);
  samples.particle_volume = static_cast<float>(apart * apart * apart);
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (double a = 0.5 * apart; a < 2.0 * kHalf[u]; a += apart) {
      for (double b = 0.5 * apart; b < 2.0 * kHalf[v]; b += apart) {
        for (const double side : {-1.0, 1.0}) {
          glm::dvec3 at(0.0), normal(0.0);
          at[u] = a - kHalf[u], at[v] = b - kHalf[v], at[axis] = side * kHalf[axis];
          normal[axis] = side;
          samples.positions.emplace_back(at);
          samples.normals.emplace_back(normal);
        }
      }
    }
  }
  return samples;
}

DistanceField block_field(float cell) {
  DistanceField field{glm::vec3(-kHalf) - 6.0f * cell, cell, {}, {}};
  field.size = glm::ivec3(glm::round(2.0 * kHalf / static_cast<double>(cell))) + 13;
  field.distance.resize(static_cast<std::size_t>(field.size.x) * field.size.y * field.size.z);
  for_each_node(field.view(), [&](float, const glm::vec3& p, int node) {
    const glm::vec3 off = glm::abs(p) - glm::vec3(kHalf);
    field.distance[static_cast<std::size_t>(node)] =
        glm::length(glm::max(off, glm::vec3(0.0f))) + std::min(std::max({off.x, off.y, off.z}), 0.0f);
  });
  return field;
}

// The stirred tank with a block in it that may become three.
Tank block_tank() {
  constexpr int kPieces = 3;
  Tank tank = stirred_tank(ParticleModel::kCorrected);
  Body block;
  block.name = "block";
  block.motion = BodyMotion::kFree;
  block.mesh = static_cast<int>(tank.scene.meshes.size());
  block.pose = {{0.04, 0.07, 0.0}, glm::angleAxis(0.3, glm::dvec3(0, 1, 0))};
  block.twist = {{0.05, 0.1, 0.0}, {1.0, 0.0, 2.0}};
  const glm::dvec3 size = 2.0 * kHalf;
  block.mass.mass = 800.0 * size.x * size.y * size.z;
  for (int i = 0; i < 3; ++i)
    block.mass.inertia[i][i] = block.mass.mass / 12.0 * (glm::dot(size, size) - size[i] * size[i]);
  block.pieces = kPieces;
  const int first = static_cast<int>(tank.scene.bodies.size());
  tank.scene.meshes.push_back(box_mesh(-kHalf, kHalf));
  for (int number = 0; number < kPieces; ++number) {
    tank.scene.bodies.push_back(block);
    tank.sampled.surfaces.push_back(block_samples(tank.sampled.spacing));
    tank.sampled.distance_fields.push_back(block_field(static_cast<float>(0.5 * tank.sampled.spacing)));
    block.pieces = 0;
    block.piece_of = first;
    block.starts_away = true;
  }
  SampledScene& s = tank.sampled;
  std::size_t kept = 0;
  for (std::size_t p = 0; p < s.fluid_positions.size(); ++p) {
    const glm::dvec3 at = transform_point(inverse(block.pose), glm::dvec3(s.fluid_positions[p]));
    if (glm::all(glm::lessThan(glm::abs(at), kHalf + 0.6 * s.spacing))) continue;
    s.fluid_positions[kept] = s.fluid_positions[p];
    s.fluid_velocities[kept] = s.fluid_velocities[p];
    s.fluid_index[kept++] = s.fluid_index[p];
  }
  s.fluid_positions.resize(kept);
  s.fluid_velocities.resize(kept);
  s.fluid_index.resize(kept);
  return shaken(tank);
}

}  // namespace

void compare_cut() {
  std::printf("a block that is cut\n");
  const Tank tank = block_tank();
  const std::size_t block = tank.scene.bodies.size() - 3;
  World cpu = world_on(Backend::kCpu, tank);
  World gpu = world_on(Backend::kCuda, tank);
  expect_true("particles are clamped", cpu.plan().clamps_penetration());
  step(cpu, 0.09);
  step(gpu, 0.09);
  const auto both = [&](const char* what, auto&& change) {
    const bool done = static_cast<bool>(change(cpu)) && static_cast<bool>(change(gpu));
    expect_true(what, done);
    step(cpu, 0.09);
    step(gpu, 0.09);
    compare_worlds(cpu, gpu, 1e-5);
  };
  const auto feels = [&](std::size_t body) {
    BodySnapshot now;
    cpu.fill(now);
    return glm::length(now.bodies[body].fluid.force) > 0.01;
  };
  both("it is cut", [&](World& world) { return world.cut(block, {{1.0, 0.3, 0.2}, 0.005}); });
  both("so is a part", [&](World& world) { return world.cut(block + 1, {{0.0, 0.2, 1.0}, 0.0}); });
  for (int i = 0; i < 20; ++i) step(cpu, 0.09);
  for (const std::size_t piece : {block, block + 1, block + 2}) expect_true("it feels fluid", feels(piece));
  std::vector<std::uint8_t> saved;
  expect_true("it is saved", static_cast<bool>(cpu.save(saved)));
  World restored = world_on(Backend::kCuda, tank);
  expect_true("and restored where it was whole", static_cast<bool>(restored.restore(saved)));
  step(cpu, 0.09);
  step(restored, 0.09);
  compare_worlds(cpu, restored, 1e-5);
}

}  // namespace slosh::testing
