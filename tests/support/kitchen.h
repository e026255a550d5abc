// A block that may be cut, a table, a knife: bodies without fluid.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scenes/sample.h"
#include "sim/bodies/pieces.h"
#include "sim/world.h"
#include "tests/support/tank.h"

namespace slosh::testing {

inline constexpr double kCutDensity = 900.0;     // kg/m³
inline constexpr double kCutSpacing = 1.0 / 64;  // m

struct Kitchen {
  Scene scene;
  std::vector<ConvexSolid> solids;  // one a body

  Kitchen() {
    scene.name = "kitchen";
    scene.gravity = glm::dvec3(0.0);
    scene.domain_min = glm::dvec3(-2.0);
    scene.domain_max = glm::dvec3(2.0);
  }
  int add(const std::string& name, const glm::dvec3& lower, const glm::dvec3& upper, BodyMotion motion,
          const Pose& pose = {}) {
    return add(name, box_mesh(lower, upper), motion, pose);
  }
  int add(const std::string& name, const TriangleMesh& mesh, BodyMotion motion, const Pose& pose = {}) {
    Body body;
    body.name = name;
    body.mesh = static_cast<int>(scene.meshes.size());
    body.motion = motion;
    body.pose = pose;
    scene.meshes.push_back(mesh);
    solids.push_back(convex_solid(scene.meshes.back()));
    const SolidIntegrals solid = integrate(solids.back());
    body.mass = {kCutDensity * solid.volume, solid.center, kCutDensity * solid.inertia};
    scene.bodies.push_back(body);
    return static_cast<int>(scene.bodies.size()) - 1;
  }
  /// A block that may become so many bodies, the others right behind it.
  int add_butter(const TriangleMesh& mesh, int pieces, double cut_n_m = 0.0, const Pose& pose = {}) {
    const int first = add("butter", mesh, BodyMotion::kFree, pose);
    scene.bodies.back().pieces = pieces;
    scene.bodies.back().cut_n_m = cut_n_m;
    for (int more = 2; more <= pieces; ++more) {
      Body piece = scene.bodies[static_cast<std::size_t>(first)];
      piece.name += "~" + std::to_string(more);
      piece.pieces = 0;
      piece.piece_of = first;
      piece.starts_away = true;
      scene.bodies.push_back(piece);
      solids.push_back(solids[static_cast<std::size_t>(first)]);
    }
    return first;
  }
  void add_grip(int body, const glm::dvec3& at, double stiffness = 2000.0) {
    Grip grip;
    grip.name = "grip";
    grip.body = body;
    grip.pose.position = at;
    grip.stiffness = stiffness;
    scene.grips.push_back(grip);
  }
  World world(double time_step = 1e-3) const {
    const Result<SampledScene> sampled = sample_scene(scene, kCutSpacing);
    EXPECT_TRUE(sampled) << (sampled ? "" : sampled.error().text());
    Plan plan = make_plan(scene, kCutSpacing);
    plan.time_step = time_step;
    WorldOptions options;
    options.threads = 1;
    options.backend = Backend::kCpu;
    return World(scene, sampled.value(), plan, options);
  }
};

inline BodySnapshot state_in(const World& world) {
  BodySnapshot state;
  world.fill(state);
  return state;
}

}  // namespace slosh::testing
