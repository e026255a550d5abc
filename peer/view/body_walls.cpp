#include "peer/view/body_walls.h"

#include <algorithm>

#include "peer/view/cut_mesh.h"

namespace slosh {

BodyWalls::BodyWalls(const Scene& scene, float clearance) : scene_(scene), clearance_(clearance) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.mesh < 0 || body.point_probe) continue;
    walls_.push_back(
        {i, {}, mesh::MeshTree(scene.meshes[static_cast<std::size_t>(body.mesh)]), body.pose, body.pose});
  }
}

void BodyWalls::follow_cuts(const BodyCuts* cuts) {
  for (Wall& wall : walls_) {
    const std::span<const CutPlane> planes = planes_of(cuts, wall.body);
    if (std::ranges::equal(planes, wall.planes)) continue;
    const TriangleMesh& mesh = scene_.meshes[static_cast<std::size_t>(scene_.bodies[wall.body].mesh)];
    wall.planes.assign(planes.begin(), planes.end());
    wall.tree = mesh::MeshTree(cut_mesh(mesh, wall.planes));
  }
}

void BodyWalls::move(const BodySnapshot& now) {
  if (now.cuts != cuts_) follow_cuts(now.cuts.get());
  cuts_ = now.cuts;
  const std::vector<BodyState>& bodies = now.bodies;
  for (Wall& wall : walls_) {
    if (wall.body >= bodies.size()) continue;
    const Pose& pose = bodies[wall.body].pose;
    wall.before = placed_ ? wall.now : pose;
    wall.now = pose;
  }
  placed_ = true;
}

std::optional<glm::vec3> BodyWalls::stop(const glm::vec3& from, const glm::vec3& to, bool moved) const {
  std::optional<glm::vec3> stopped;
  glm::vec3 end = to;
  for (const Wall& wall : walls_) {
    // Seen from the body, so that one that moves meets drops that stand still.
    const glm::vec3 start(transform_point(inverse(moved ? wall.before : wall.now), glm::dvec3(from)));
    const glm::vec3 way = glm::vec3(transform_point(inverse(wall.now), glm::dvec3(end))) - start;
    const float length = glm::length(way);
    if (!(length > 1e-9f)) continue;
    const glm::vec3 low = glm::min(start, start + way) - clearance_;
    const glm::vec3 high = glm::max(start, start + way) + clearance_;
    if (glm::any(glm::lessThan(high, wall.tree.low())) || glm::any(glm::greaterThan(low, wall.tree.high())))
      continue;
    const glm::vec3 along = way / length;
    float nearest = length + clearance_;
    wall.tree.each_hit(start, along, [&](float distance, int) {
      if (distance >= 0.0f) nearest = std::min(nearest, distance);
    });
    if (nearest >= length + clearance_) continue;
    end = glm::vec3(
        transform_point(wall.now, glm::dvec3(start + along * std::max(nearest - clearance_, 0.0f))));
    stopped = end;
  }
  return stopped;
}

std::optional<glm::vec3> BodyWalls::stop(const glm::vec3& from, const glm::vec3& to) const {
  return stop(from, to, true);
}
std::optional<glm::vec3> BodyWalls::stop_now(const glm::vec3& from, const glm::vec3& to) const {
  return stop(from, to, false);
}

std::optional<WallPoint> BodyWalls::nearest(const glm::vec3& at, float reach) const {
  std::optional<WallPoint> found;
  for (const Wall& wall : walls_) {
    const glm::vec3 here(transform_point(inverse(wall.now), glm::dvec3(at)));
    if (glm::any(glm::lessThan(here, wall.tree.low() - reach)) ||
        glm::any(glm::greaterThan(here, wall.tree.high() + reach)))
      continue;
    const mesh::NearestPoint face = wall.tree.nearest(here, reach);
    if (face.triangle < 0) continue;
    reach = face.distance;
    found = WallPoint{glm::vec3(transform_point(wall.now, glm::dvec3(face.point))),
                      glm::vec3(wall.now.orientation * glm::dvec3(wall.tree.face_normal(face.triangle)))};
  }
  return found;
}

}  // namespace slosh
