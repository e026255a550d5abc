// Gauges and regions: where a run is measured.
#include "scenes/reading/reading.h"

namespace slosh::reading {
namespace {

constexpr std::size_t kMaxOfEach = 1000;

Problem read_place(Reading& reading, int node, int& body, Pose& pose, glm::dmat3& rest) {
  if (Problem problem = read_pose(reading, node, pose, rest)) return problem;
  const int up = body_node_above(reading, node);
  body = up < 0 ? -1 : reading.body_of_node.at(up);
  if (up < 0) return std::nullopt;
  // The file's, which a driven body's first key need not be.
  Pose carried_by;
  glm::dmat3 unused;
  if (Problem problem = read_pose(reading, up, carried_by, unused)) return problem;
  pose = compose(inverse(carried_by), pose);
  return std::nullopt;
}

Problem too_many(const Reading& reading, int node, const char* what) {
  return Error{reading.document.owner(node), "is one of more than " + std::to_string(kMaxOfEach) + " " + what,
               "Use fewer"};
}

}  // namespace

int body_node_above(const Reading& reading, int node) {
  int up = reading.document.parent[node];
  while (up >= 0 && !reading.body_of_node.contains(up)) up = reading.document.parent[up];
  return up;
}

Problem read_gauge(Reading& reading, int node) {
  Gauge gauge;
  gauge.name = reading.document.name(node);
  gltf::Extras extras(reading.document.extras[node], reading.document.owner(node));
  extras.text("slosh", "");
  if (Problem problem = all_of(reading, std::nullopt, extras)) return problem;
  Pose pose;
  glm::dmat3 rest;
  if (Problem problem = read_place(reading, node, gauge.body, pose, rest)) return problem;
  gauge.position = pose.position;
  if (reading.scene.fluid_volumes.empty()) {
    return Error{reading.document.owner(node), "reads the level of a fluid, and the scene has none",
                 "Give a closed mesh slosh = \"fluid\", or take the gauge out"};
  }
  if (reading.scene.gauges.size() >= kMaxOfEach) return too_many(reading, node, "gauges");
  reading.scene.gauges.push_back(std::move(gauge));
  return std::nullopt;
}

Problem read_region(Reading& reading, int node) {
  Region region;
  region.name = reading.document.name(node);
  gltf::Extras extras(reading.document.extras[node], reading.document.owner(node));
  extras.text("slosh", "");
  glm::dmat3 rest;
  Problem place = read_place(reading, node, region.body, region.pose, rest);
  if (!place) place = read_node_mesh(reading, node, rest, true, region.mesh);
  if (Problem problem = all_of(reading, place, extras)) return problem;
  if (reading.scene.regions.size() >= kMaxOfEach) return too_many(reading, node, "regions");
  reading.scene.regions.push_back(std::move(region));
  return std::nullopt;
}

}  // namespace slosh::reading
