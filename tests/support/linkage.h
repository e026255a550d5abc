// Bodies without surfaces, on joints or driven by keys: nothing touches, so closed forms hold.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "sim/world.h"

namespace slosh::testing {

/// A frame at `at` whose y goes along `axis`.
inline Pose frame_along(const glm::dvec3& axis, const glm::dvec3& at) {
  const glm::dvec3 y = glm::normalize(axis);
  const glm::dvec3 x = glm::normalize(std::abs(y.x) < 0.9 ? glm::cross(y, glm::dvec3(1, 0, 0))
                                                          : glm::cross(y, glm::dvec3(0, 0, 1)));
  return {at, glm::quat_cast(glm::dmat3(x, y, glm::cross(x, y)))};
}

struct Linkage {
  Scene scene;
  double time_step = 1e-3;  ///< s

  Linkage() {
    scene.name = "linkage";
    scene.domain_min = glm::dvec3(-100.0);
    scene.domain_max = glm::dvec3(100.0);
  }
  /// A free body of moments `inertia` (kg·m²) about its own axes.
  int add(double mass, const glm::dvec3& inertia, const Pose& pose = {}, const Twist& twist = {}) {
    Body body;
    body.name = "body " + std::to_string(scene.bodies.size());
    body.motion = BodyMotion::kFree;
    body.pose = pose;
    body.twist = twist;
    body.mass.mass = mass;
    for (int i = 0; i < 3; ++i) body.mass.inertia[i][i] = inertia[i];
    scene.bodies.push_back(body);
    return static_cast<int>(scene.bodies.size()) - 1;
  }
  int add_driven(std::vector<PoseKey> keys, bool repeats = false) {
    Body body;
    body.name = "driven";
    body.motion = BodyMotion::kDriven;
    body.pose = keys.front().pose;
    body.keys = std::move(keys);
    body.repeats = repeats;
    scene.bodies.push_back(body);
    return static_cast<int>(scene.bodies.size()) - 1;
  }
  /// `frame` in the world. The reference is good until the next.
  Joint& join(JointKind kind, int body, int other, const Pose& frame) {
    Joint joint;
    joint.name = "joint " + std::to_string(scene.joints.size());
    joint.kind = kind;
    joint.body = body;
    joint.other = other;
    joint.pose = compose(inverse(scene.bodies[static_cast<std::size_t>(body)].pose), frame);
    scene.joints.push_back(joint);
    return scene.joints.back();
  }
  World world() const {
    SampledScene sampled;
    sampled.spacing = 0.01;
    sampled.surfaces.resize(scene.bodies.size());
    sampled.distance_fields.resize(scene.bodies.size());
    Plan plan = make_plan(scene, sampled.spacing);
    plan.time_step = time_step;
    WorldOptions options;
    options.threads = 1;
    options.backend = Backend::kCpu;
    return World(scene, sampled, plan, options);
  }
};

inline BodySnapshot state_of(const World& world) {
  BodySnapshot state;
  world.fill(state);
  return state;
}

inline void run_for(World& world, double seconds) {
  const auto steps = static_cast<int>(std::lround(seconds / world.plan().time_step));
  for (int i = 0; i < steps; ++i) world.step({});
}

/// J, of motion and height.
inline double energy_of(const Scene& scene, const BodySnapshot& state) {
  double energy = 0.0;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const MassProperties& mass = scene.bodies[b].mass;
    const BodyState& body = state.bodies[b];
    const glm::dvec3 turning = glm::conjugate(body.pose.orientation) * body.twist.angular;
    energy += 0.5 * mass.mass * glm::dot(body.twist.linear, body.twist.linear) +
              0.5 * glm::dot(turning, mass.inertia * turning) -
              mass.mass * glm::dot(scene.gravity, body.center_of_mass);
  }
  return energy;
}

/// A pendulum that hangs on a hinge about z at the origin, `length` m below it, turned out by `angle` rad.
inline int add_pendulum(Linkage& link, double mass, double inertia, double length, double angle) {
  const glm::dquat turn = glm::angleAxis(angle, glm::dvec3(0, 0, 1));
  const int body = link.add(mass, glm::dvec3(inertia), {turn * glm::dvec3(0, -length, 0), turn});
  link.join(JointKind::kHinge, body, -1, frame_along({0, 0, 1}, {0, 0, 0}));
  return body;
}

}  // namespace slosh::testing
