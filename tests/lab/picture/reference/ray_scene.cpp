#include "tests/lab/picture/reference/ray_scene.h"

#include <algorithm>
#include <cmath>
#include <string>

#ifdef SLOSH_EMBREE
#include "tests/lab/picture/reference/embree_library.h"
#endif

namespace slosh::reference {

#ifdef SLOSH_EMBREE

struct RayScene::Parts {
  struct Mesh {
    std::vector<glm::vec3> normals;  // world
    std::vector<glm::uvec3> triangles;
    std::vector<glm::vec2> texcoords;
    std::vector<glm::vec3> positions;  // world; empty without texture coordinates
    const MeshLook* look;
    int fluid;
  };
  const EmbreeLibrary& embree = *embree_library();
  RTCDevice device = embree.new_device(nullptr);
  RTCScene scene = embree.new_scene(device);
  std::vector<Mesh> meshes;  // by Embree's number of the geometry
  ~Parts() {
    embree.release_scene(scene);
    embree.release_device(device);
  }
};

Result<bool> RayScene::available() {
  const EmbreeLibrary* embree = embree_library();
  if (!embree)
    return Error{"reference picture", std::string("there is no Embree here (") + embree_library_name() + ")",
                 "Install it: libembree3-3 in Debian 12, libembree4-4 in Debian 13"};
  RTCDevice device = embree->new_device(nullptr);
  if (!device) return Error{"reference picture", "Embree cannot start", "Update it"};
  embree->release_device(device);
  return true;
}

RayScene::RayScene() : parts_(std::make_unique<Parts>()) {
  parts_->embree.set_scene_flags(parts_->scene, RTC_SCENE_FLAG_ROBUST);
}

void RayScene::add(const Triangles& mesh, const glm::mat4& model, const MeshLook* look, int fluid) {
  if (mesh.triangles.empty()) return;
  const EmbreeLibrary& embree = parts_->embree;
  RTCGeometry geometry = embree.new_geometry(parts_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* positions = static_cast<glm::vec3*>(embree.set_new_geometry_buffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh.positions.size()));
  std::ranges::transform(mesh.positions, positions,
                         [&](const glm::vec3& p) { return glm::vec3(model * glm::vec4(p, 1.0f)); });
  auto* triangles = static_cast<glm::uvec3*>(embree.set_new_geometry_buffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), mesh.triangles.size()));
  std::ranges::copy(mesh.triangles, triangles);
  embree.commit_geometry(geometry);
  embree.attach_geometry_by_id(parts_->scene, geometry, static_cast<unsigned>(parts_->meshes.size()));
  embree.release_geometry(geometry);
  Parts::Mesh kept{mesh.normals, mesh.triangles, mesh.texcoords, {}, look, fluid};
  if (!mesh.texcoords.empty()) kept.positions.assign(positions, positions + mesh.positions.size());
  for (glm::vec3& n : kept.normals) n = glm::mat3(model) * n;
  parts_->meshes.push_back(std::move(kept));
}

void RayScene::finish() {
  parts_->embree.commit_scene(parts_->scene);
}

Hit RayScene::nearest(const glm::vec3& from, const glm::vec3& way) const {
  RTCRayHit ray{};
  ray.ray.org_x = from.x;
  ray.ray.org_y = from.y;
  ray.ray.org_z = from.z;
  ray.ray.dir_x = way.x;
  ray.ray.dir_y = way.y;
  ray.ray.dir_z = way.z;
  ray.ray.tnear = 0.0f;
  ray.ray.tfar = std::numeric_limits<float>::infinity();
  ray.ray.mask = ~0u;
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
  parts_->embree.intersect_1(parts_->scene, &ray);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  parts_->embree.intersect_1(parts_->scene, &context, &ray);
#endif
  Hit hit;
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  const Parts::Mesh& mesh = parts_->meshes[ray.hit.geomID];
  const glm::uvec3& t = mesh.triangles[ray.hit.primID];
  hit.distance = ray.ray.tfar;
  hit.face = glm::normalize(glm::vec3(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z));
  const glm::vec3 n = mesh.normals[t.x] * (1.0f - ray.hit.u - ray.hit.v) + mesh.normals[t.y] * ray.hit.u +
                      mesh.normals[t.z] * ray.hit.v;
  const float length = glm::length(n);
  hit.normal = length > 1e-6f ? n / length : hit.face;
  // A vertex' normal must not turn the surface round.
  if ((glm::dot(hit.normal, way) > 0.0f) != (glm::dot(hit.face, way) > 0.0f)) hit.normal = hit.face;
  hit.look = mesh.look;
  if (!mesh.positions.empty()) {
    const glm::vec3& corner = mesh.positions[t.x];
    const glm::vec2& texcoord = mesh.texcoords[t.x];
    hit.edges[0] = mesh.positions[t.y] - corner;
    hit.edges[1] = mesh.positions[t.z] - corner;
    hit.texture_edges[0] = mesh.texcoords[t.y] - texcoord;
    hit.texture_edges[1] = mesh.texcoords[t.z] - texcoord;
    hit.texcoord = texcoord + ray.hit.u * hit.texture_edges[0] + ray.hit.v * hit.texture_edges[1];
  }
  hit.fluid = mesh.fluid;
  return hit;
}

#else

struct RayScene::Parts {};
Result<bool> RayScene::available() {
  return Error{"reference picture", "this slosh was built without Embree",
               "apt-get install libembree-dev, remove the build folder's CMakeCache.txt and build again"};
}
RayScene::RayScene() = default;
void RayScene::add(const Triangles&, const glm::mat4&, const MeshLook*, int) {}
void RayScene::finish() {}
Hit RayScene::nearest(const glm::vec3&, const glm::vec3&) const {
  return {};
}

#endif

RayScene::~RayScene() = default;

}  // namespace slosh::reference
