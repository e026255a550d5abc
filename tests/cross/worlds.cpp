#include "tests/cross/worlds.h"

#include <algorithm>
#include <cmath>

#include "tests/support/stirred_tank.h"

namespace slosh::testing {

Tank stirred_tank(ParticleModel model) {
  Tank tank = stirred_tank(0.1);
  tank.scene.model = model;
  return tank;
}

Tank paddle_in_honey(ParticleModel model) {
  Tank tank = stirred_tank(model);
  for (Fluid& fluid : tank.scene.fluids) fluid.dynamic_viscosity = 20.0;
  tank.scene.bodies[1].mass = {0.005, glm::dvec3(0.0), glm::dmat3(5e-6)};
  return tank;
}

Tank thick_tank(double viscosity, double above) {
  Tank tank = stirred_tank(kFluidsViscosity);
  tank.scene.fluids[0].dynamic_viscosity = viscosity;
  tank.scene.fluids[1].dynamic_viscosity = above;
  tank.scene.bodies[1].dynamic_viscosity = kFluidsViscosity;
  Body box;
  box.name = "box";
  box.motion = BodyMotion::kFree;
  box.dynamic_viscosity = kFluidsViscosity;
  box.mass = {500.0 * 6.4e-5, glm::dvec3(0.0), glm::dmat3(500.0 * 6.4e-5 * 1.6e-3 / 6.0)};
  box.mesh = static_cast<int>(tank.scene.meshes.size());
  box.pose.position = {0.05, 0.05, 0.0};
  tank.scene.meshes.push_back(box_mesh(glm::dvec3(-0.02), glm::dvec3(0.02)));
  tank.scene.bodies.push_back(box);
  SurfaceSamples samples;
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) {
        glm::vec3 x, normal(0.0f);
        normal[axis] = side % 2 ? 1.0f : -1.0f;
        x[axis] = 0.013f * normal[axis];  // an inset of 0.7 spacings
        x[(axis + 1) % 3] = -0.013f + 0.026f / 3.0f * static_cast<float>(i);
        x[(axis + 2) % 3] = -0.013f + 0.026f / 3.0f * static_cast<float>(j);
        samples.positions.push_back(x);
        samples.normals.push_back(normal);
      }
    }
  }
  samples.particle_volume = 1e-6f;
  tank.sampled.surfaces.push_back(samples);
  tank.sampled.distance_fields.emplace_back();
  clear_box(tank.sampled, glm::vec3(box.pose.position), glm::vec3(0.021f));
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
  add_grip(tank, add_probe(tank, {-0.05, 0.05, 0.0}));
  tank.scene.grips[0].rotational_stiffness = tank.scene.grips[0].rotational_damping = 0.0;
  return tank;
}

Tank thrown_tank() {
  TankOptions options;
  options.viscosity = 0.001;
  Tank tank = make_tank(options);
  for (glm::vec3& v : tank.sampled.fluid_velocities) v = {3.0f, 0.2f, 0.1f};
  Body& walls = tank.scene.bodies[0];
  walls.motion = BodyMotion::kFree;
  walls.mass = {3.0, glm::dvec3(0.0), glm::dmat3(0.03)};
  // The boundary layers sit half a spacing behind the inner faces already; walls 5 cm thick, no lid.
  const glm::vec3 low(-0.1f, 0.0f, -0.1f), high(0.1f, 1.0f, 0.1f), wall(0.05f);
  const auto distance_to_box = [](const glm::vec3& p, const glm::vec3& lower, const glm::vec3& upper) {
    const glm::vec3 q = glm::max(lower - p, p - upper);
    return glm::length(glm::max(q, 0.0f)) + std::min(std::max({q.x, q.y, q.z}), 0.0f);
  };
  DistanceField& field = tank.sampled.distance_fields[0];
  field.cell = 0.005f;
  field.origin = low - wall - 0.0317f;
  field.size = glm::ivec3(74, 64, 74);
  for (int k = 0; k < field.size.z; ++k) {
    for (int j = 0; j < field.size.y; ++j) {
      for (int i = 0; i < field.size.x; ++i) {
        const glm::vec3 p = field.origin + field.cell * glm::vec3(i, j, k);
        field.distance.push_back(std::max(distance_to_box(p, low - wall, glm::vec3(0.15f, 0.2f, 0.15f)),
                                          -distance_to_box(p, low, high)));
      }
    }
  }
  add_grip(tank, 0);
  tank.scene.grips[0].stiffness = 1e4;
  tank.scene.grips[0].rotational_stiffness = 100.0;
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
