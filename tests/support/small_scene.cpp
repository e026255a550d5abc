#include "tests/support/small_scene.h"

namespace slosh::test {
namespace {

TriangleMesh tetrahedron(const std::string& name, float size) {
  TriangleMesh mesh;
  mesh.name = name;
  mesh.positions = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}, {0, 0, size}};
  mesh.normals = {{-0.57735026f, -0.57735026f, -0.57735026f}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

}  // namespace

Scene small_scene() {
  Scene scene;
  scene.name = "small";
  scene.title = "One of everything";
  scene.source_file = "/somewhere/small.gltf";
  scene.meshes = {tetrahedron("water", 0.1f), tetrahedron("bucket", 0.2f), tetrahedron("table", 1.0f / 3.0f)};
  scene.fluids = {{"water", 998.2, 0.001002, {0.1f, 0.3f, 0.5f}, {12.0f, 4.0f, 2.5f}}};
  FluidVolume volume;
  volume.name = "fill";
  volume.mesh = 0;
  volume.pose.position = {0.1, 1.0 / 3.0, 0.0};
  scene.fluid_volumes = {volume};

  Body bucket;
  bucket.name = "bucket";
  bucket.mesh = 1;
  bucket.motion = BodyMotion::kFree;
  bucket.pose.orientation = glm::normalize(glm::dquat(0.9, 0.1, 0.2, 0.3));
  bucket.twist.angular = {0.0, 0.1, 0.0};
  bucket.mass = {1.1, {0.0, 0.05, 1e-300}, glm::dmat3(0.01)};
  Body table;
  table.name = "table";
  table.mesh = 2;
  table.measured = true;
  Body probe;
  probe.name = "probe";
  probe.motion = BodyMotion::kFree;
  probe.point_probe = true;
  probe.mass = {0.05, {}, glm::dmat3(1e-6)};
  scene.bodies = {bucket, table, probe};

  Picture sign;
  sign.name = "sign";
  sign.mesh = 2;
  sign.material.opacity = 0.25f;
  scene.pictures = {sign};

  Grip grip;
  grip.name = "handle";
  grip.body = 0;
  grip.pose.position = {0.0, 0.2, 0.0};
  for (int i = 0; i < 3; ++i) {
    PoseKey key;
    key.time = i / 60.0;
    key.pose.position = {0.0, 0.2 + 0.01 * i, 0.0};
    grip.hand_motion.push_back(key);
  }
  scene.grips = {grip};
  scene.camera.target = {0.0, 0.1, 0.0};
  scene.domain_min = glm::dvec3(-1.0);
  scene.domain_max = glm::dvec3(1.0, 2.0, 1.0);
  scene.spacing = 0.01;
  return scene;
}

}  // namespace slosh::test
