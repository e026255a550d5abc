#include "tests/lab/verbs/report_picture_water.h"

#include <algorithm>
#include <cmath>

namespace slosh {
namespace {

constexpr double kInner[3] = {0.36, 0.26, 0.20};  // m, the tank
constexpr double kFill = 0.10;                    // m of still water
constexpr double kStirRadius = 0.07;              // m, of the circle that a rod goes in
constexpr double kStirPeriod = 7.0;               // s: 63 mm a second

/// Where the rod's hand is, that stirs from time 0 on.
Pose rod_at(double time) {
  const double angle = 2.0 * report::kPi * time / kStirPeriod;
  Pose pose;
  pose.position = {kStirRadius * std::cos(angle), 0.11, kStirRadius * std::sin(angle)};
  return pose;
}

}  // namespace

report::SceneBuilder tank_scene(bool dam) {
  report::SceneBuilder b;
  b.add_fluid(1000.0, 0.01);
  const double x = 0.5 * kInner[0];
  const double z = 0.5 * kInner[2];
  const int tank = b.add_fixed("tank", report::tank_at_floor({kInner[0], kInner[1], kInner[2]}, 0.03));
  Material& glass = b.scene.bodies[static_cast<std::size_t>(tank)].material;
  glass.base_color = {0.85f, 0.93f, 0.95f};
  glass.roughness = 0.05f;
  glass.opacity = 0.1f;
  b.add_volume(dam ? make::box({-x, 0.0, -z}, {0.0, 2.0 * kFill, z})
                   : make::box({-x, 0.0, -z}, {x, kFill, z}));
  b.set_domain({-0.5, -0.2, -0.4}, {0.5, 0.6, 0.4});
  Picture table;
  table.name = "table";
  table.mesh = static_cast<int>(b.scene.meshes.size());
  table.material.base_color = {0.32f, 0.18f, 0.09f};
  b.scene.meshes.push_back(make::with_normals(make::box({-0.6, -0.1, -0.45}, {0.6, -0.031, 0.45})));
  b.scene.pictures.push_back(table);
  b.scene.camera.eye = {0.30, 0.42, 0.66};
  b.scene.camera.target = {0.0, 0.10, 0.0};
  return b;
}

std::pair<Scene, std::vector<Snapshot>> stirred_water(const report::Setting& setting, double spacing,
                                                      int pictures) {
  report::SceneBuilder b = tank_scene(false);
  const double half = std::max(0.01, spacing);
  const int rod = b.add_free("rod", make::box({-half, -0.07, -half}, {half, 0.09, half}), 0.2, rod_at(0.0));
  b.add_grip(rod, 1000.0, 20.0, 10.0, 0.2);
  report::Cost cost;
  report::Trial trial(b.scene, setting, cost);
  trial.handle(0) = {rod_at(0.0), {}, true};
  trial.settle(0.5, true);
  const double begun = trial.world().time();
  const auto stir = [&] { trial.handle(0).pose = rod_at(trial.world().time() - begun); };
  trial.run(1.5, stir);
  std::vector<Snapshot> stirred;
  for (int i = 0; i < pictures; ++i) {
    trial.run(1.0 / 30.0, stir);
    stirred.push_back(trial.picture());
  }
  return {b.scene, std::move(stirred)};
}

score::Exact still_surface(const View& view, double spacing, int width, int height) {
  const auto columns = static_cast<std::size_t>(width);
  const auto pixels = columns * static_cast<std::size_t>(height);
  score::Exact exact = score::nothing_seen(width, height);
  const glm::mat4 world_from_eye = glm::inverse(view.view);
  const glm::vec3 from(world_from_eye[3]);
  const glm::vec3 up = glm::mat3(view.view) * glm::vec3(0.0f, 1.0f, 0.0f);
  for (std::size_t i = 0; i < pixels; ++i) {
    const glm::vec2 ndc(2.0f * (static_cast<float>(i % columns) + 0.5f) / static_cast<float>(width) - 1.0f,
                        1.0f - 2.0f * (static_cast<float>(i / columns) + 0.5f) / static_cast<float>(height));
    const glm::vec3 eye_way(ndc.x / view.projection[0][0], ndc.y / view.projection[1][1], -1.0f);
    const glm::vec3 way = glm::mat3(world_from_eye) * eye_way;
    const float t = (static_cast<float>(kFill) - from.y) / way.y;
    const glm::vec3 at = from + t * way;
    const bool inside =
        std::abs(at.x) < 0.5 * kInner[0] - 4.0 * spacing && std::abs(at.z) < 0.5 * kInner[2] - 4.0 * spacing;
    if (!(t > 0.0f) || !inside) continue;
    exact.depth.values[i] = t;
    for (int c = 0; c < 3; ++c) exact.normal.values[3 * i + static_cast<std::size_t>(c)] = up[c];
  }
  return exact;
}

}  // namespace slosh
