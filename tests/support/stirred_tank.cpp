#include "tests/support/stirred_tank.h"

#include <cmath>

namespace slosh::testing {

void clear_box(SampledScene& s, const glm::vec3& center, const glm::vec3& half) {
  std::size_t kept = 0;
  for (std::size_t p = 0; p < s.fluid_positions.size(); ++p) {
    if (glm::all(glm::lessThanEqual(glm::abs(s.fluid_positions[p] - center), half))) continue;
    s.fluid_positions[kept] = s.fluid_positions[p];
    s.fluid_velocities[kept] = s.fluid_velocities[p];
    s.fluid_index[kept++] = s.fluid_index[p];
  }
  s.fluid_positions.resize(kept);
  s.fluid_velocities.resize(kept);
  s.fluid_index.resize(kept);
}

void add_grip(Tank& tank, int body) {
  Grip grip;
  grip.name = "hand";
  grip.body = body;
  tank.scene.grips.push_back(grip);
}

int add_probe(Tank& tank, const glm::dvec3& position) {
  Body probe;
  probe.name = "probe";
  probe.motion = BodyMotion::kFree;
  probe.point_probe = true;
  probe.mass.mass = 0.02;
  probe.pose.position = position;
  tank.scene.bodies.push_back(probe);
  tank.sampled.surfaces.emplace_back();
  tank.sampled.distance_fields.emplace_back();
  return static_cast<int>(tank.scene.bodies.size()) - 1;
}

World world_of(const Tank& tank, int threads) {
  return World(tank.scene, tank.sampled, make_plan(tank.scene, tank.sampled.spacing),
               {threads, Backend::kCpu});
}

HandleInput paddle_hand(double time) {
  HandleInput hand;
  hand.engaged = true;
  hand.pose.position = {-0.05 + 0.2 * time, 0.09, 0.01 * std::sin(20.0 * time)};
  hand.twist.linear = {0.2, 0.0, 0.2 * std::cos(20.0 * time)};
  return hand;
}

Tank stirred_tank(double wall_viscosity) {
  TankOptions options;
  options.inner = {0.2, 0.2, 0.12};
  options.fill = 0.08;
  options.wall_viscosity = wall_viscosity;
  Tank tank = make_tank(options);
  Fluid oil;
  oil.name = "oil";
  oil.rest_density = 900.0;
  oil.dynamic_viscosity = 0.3;
  tank.scene.fluids.push_back(oil);
  add_fluid_block(tank.scene, tank.sampled, 1, {-0.1, 0.08, -0.06}, {0.1, 0.1, 0.06});
  Body paddle;
  paddle.name = "paddle";
  paddle.motion = BodyMotion::kFree;
  paddle.mass = {0.2, glm::dvec3(0.0), glm::dmat3(2e-4)};
  paddle.mesh = static_cast<int>(tank.scene.meshes.size());
  paddle.pose.position = {-0.05, kPaddleHeight, 0.0};
  tank.scene.meshes.push_back(box_mesh(glm::dvec3(-0.005, -0.04, -0.03), glm::dvec3(0.005, 0.04, 0.03)));
  tank.scene.bodies.push_back(paddle);
  SurfaceSamples samples;
  for (int y = -4; y <= 4; ++y) {
    for (int z = -3; z <= 3; ++z) {
      for (const float side : {-0.005f, 0.005f}) {
        samples.positions.emplace_back(side, 0.01f * y, 0.01f * z);
        samples.normals.emplace_back(side > 0.0f ? 1.0f : -1.0f, 0.0f, 0.0f);
      }
    }
  }
  samples.particle_volume = 1e-6f;
  tank.sampled.surfaces.push_back(samples);
  tank.sampled.distance_fields.emplace_back();
  clear_box(tank.sampled, glm::vec3(paddle.pose.position), {0.012f, 0.047f, 0.037f});
  add_grip(tank, 1);
  return tank;
}

}  // namespace slosh::testing
