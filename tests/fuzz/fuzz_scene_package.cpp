// A scene's package, and what a peer does with the scene.
#include <algorithm>

#include "net/wire/acting_fields.h"
#include "net/wire/scene_package.h"
#include "tests/fuzz/messages.h"
#include "tests/fuzz/seeds.h"
#include "tests/support/small_scene.h"

using namespace slosh;

namespace {

/// What a peer's code takes for granted.
void check_scene(const Scene& scene) {
  const auto at = [](const auto& list, int index) { return static_cast<std::size_t>(index) < list.size(); };
  for (const TriangleMesh& mesh : scene.meshes) {
    test::must(mesh.normals.size() == mesh.positions.size(), "a normal for each position");
    test::must(mesh.texcoords.empty() || mesh.texcoords.size() == mesh.positions.size(),
               "texture coordinates likewise");
    for (const glm::uvec3& t : mesh.triangles)
      test::must(std::max({t.x, t.y, t.z}) < mesh.positions.size(), "triangles of the mesh's positions");
  }
  for (const FluidVolume& volume : scene.fluid_volumes)
    test::must(at(scene.meshes, volume.mesh) && at(scene.fluids, volume.fluid), "a volume's mesh and fluid");
  for (const Body& body : scene.bodies) {
    test::must(at(scene.meshes, body.mesh) || (body.mesh == -1 && body.point_probe), "a body's mesh");
    test::must(body.motion == BodyMotion::kFixed || body.mass.mass > 0.0, "a free body's mass");
    if (body.piece_of >= 0) {
      test::must(at(scene.bodies, body.piece_of), "a piece's body");
      test::must(scene.bodies[static_cast<std::size_t>(body.piece_of)].pieces >= 2, "which may be cut");
    }
  }
  for (const Picture& picture : scene.pictures)
    test::must(at(scene.meshes, picture.mesh), "a picture's mesh");
  const auto check_maps = [&](const MaterialMaps& maps) {
    for (const TextureMap* map :
         {&maps.base_color, &maps.metallic_roughness, &maps.normal, &maps.occlusion, &maps.emissive})
      test::must(map->image == -1 || at(scene.images, map->image), "a texture's image");
  };
  for (const Body& body : scene.bodies) check_maps(body.material.maps);
  for (const Picture& picture : scene.pictures) check_maps(picture.material.maps);
  for (const Grip& grip : scene.grips) {
    test::must(at(scene.bodies, grip.body), "a grip's body");
    for (std::size_t i = 1; i < grip.hand_motion.size(); ++i)
      test::must(grip.hand_motion[i].time > grip.hand_motion[i - 1].time, "motion goes forward in time");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const Result<UnpackedScene> scene = unpack_scene({data, size});
  if (!scene) {
    test::must(wire::text_problem(scene.error().text()).empty(), "an error can be told");
    return 0;
  }
  check_scene(scene.value().scene);
  const Result<wire::Bytes> again = pack_scene(scene.value().scene, scene.value().spacing, SceneParts::kAll);
  test::must(static_cast<bool>(again), "what was unpacked can be packed");
  test::must(static_cast<bool>(unpack_scene(again.value())), "and unpacked");
  test::must(static_cast<bool>(pack_scene(scene.value().scene, scene.value().spacing, SceneParts::kSeen)),
             "also for a peer");
  return 0;
}

std::vector<std::vector<std::uint8_t>> slosh_fuzz_seeds() {
  std::vector<std::vector<std::uint8_t>> seeds;
  for (const SceneParts parts : {SceneParts::kSeen, SceneParts::kAll}) {
    const Scene scene = test::small_scene();
    seeds.push_back(pack_scene(scene, 0.01, parts).value());
    // As it is, so that damage reaches the fields and not only zstd.
    std::vector<std::uint8_t> stored{1, 0};
    wire::SceneAt<wire::kPlainScene> packed{{unpack_scene(seeds.back()).value().scene, 0.01}};
    wire::encode(packed, stored);
    seeds.push_back(stored);
  }
  // With textures; the images are anything, as they are when they arrive.
  Scene textured = test::small_scene();
  textured.images = {{"paint", {1, 2, 3}}, {"bumps", {4, 5}}};
  for (TriangleMesh& mesh : textured.meshes) mesh.texcoords.resize(mesh.positions.size(), glm::vec2(0.5f));
  textured.bodies[0].material.maps.base_color.image = 0;
  textured.pictures[0].material.maps.normal.image = 1;
  std::vector<std::uint8_t> stored{wire::kTexturedScene, 0};
  wire::encode(wire::SceneAt<wire::kTexturedScene>{{textured, 0.01}}, stored);
  seeds.push_back(stored);
  // All that there is: what moves, comes and is cut, too.
  Body piece = textured.bodies[0];
  textured.bodies[0].pieces = 2;
  piece.piece_of = 0;
  piece.starts_away = true;
  textured.bodies.push_back(piece);
  textured.joints.push_back({"lid", JointKind::kHinge, 0, 1});
  stored = {wire::kCutScene, 0};
  wire::encode(wire::SceneAt<wire::kCutScene>{{textured, 0.01}}, stored);
  seeds.push_back(stored);
  return seeds;
}
