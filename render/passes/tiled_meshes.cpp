#include "render/passes/tiled_meshes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/gl/pixel_program.h"

namespace slosh {
namespace {

// As the shaders have them.
constexpr int kTile = 32;
constexpr std::size_t kTriangleBytes = 6 * sizeof(glm::vec4);
constexpr std::size_t kBoxBytes = 2 * sizeof(std::uint32_t);
constexpr std::size_t kGroup = 64;  // triangles of one box

std::size_t groups_of(std::size_t triangles) {
  return (triangles + kGroup - 1) / kGroup;
}
struct Item {
  glm::vec4 base;
  glm::vec4 surface;
  glm::vec4 emissive;
};

/// More in one tile take longer than fragments: on an H200 a ball of 4900 makes 0.26 ms, one of 40 000 3.3,
/// while by fragments the meshes of a picture take 1.7.
constexpr std::size_t kMaxTriangles = 16000;

/// The eye is outside of it, by more than the near plane cuts off anywhere: so it sees no inside.
bool shows_no_inside(const MeshInstance& instance, const MeshStore& meshes, const View& view) {
  const glm::mat4 eye_from_model = view.view * instance.model;
  const glm::mat3 turn(eye_from_model);
  if (!meshes.closed(instance.mesh) || !(glm::determinant(turn) > 0.0f)) return false;
  const glm::mat4& p = view.projection;
  const glm::vec3 corner((1.0f + std::abs(p[2][0])) / p[0][0], (1.0f + std::abs(p[2][1])) / p[1][1], 1.0f);
  const Bounds& box = meshes.bounds(instance.mesh);
  const glm::vec3 eye(glm::inverse(eye_from_model)[3]);
  const float least = std::min({glm::length(turn[0]), glm::length(turn[1]), glm::length(turn[2])});
  return least * glm::length(eye - glm::clamp(eye, box.low, box.high)) >
         view.near_plane * glm::length(corner);
}

}  // namespace

MeshDefines mesh_defines(bool fast, const std::vector<std::string>& far_light) {
  MeshDefines defines{far_light, far_light};
  if (fast) defines.opaque.emplace_back("FAST");
  defines.behind.emplace_back("BEHIND");
  return defines;
}

Result<TiledMeshes> TiledMeshes::create(bool fast, const std::vector<std::string>& far_light) {
  TiledMeshes out;
  out.fast_ = fast;
  const MeshDefines defines = mesh_defines(fast, far_light);
  for (const Result<bool>& loaded :
       {gl::take(out.triangles_, gl::Program::create_compute("mesh_triangles.comp")),
        gl::take(out.opaque_, gl::Program::create_compute("mesh_pixels.comp", defines.opaque)),
        gl::take(out.behind_, gl::Program::create_compute("glass_pixels.comp", defines.behind)),
        gl::take(out.before_, gl::Program::create_compute("glass_pixels.comp", far_light))}) {
    if (!loaded) return loaded.error();
  }
  return out;
}

bool TiledMeshes::suit(const Frame& frame, const MeshStore& meshes, const TextureStore& textures) {
  std::size_t triangles = 0;
  for (const MeshInstance& instance : frame.meshes) {
    if (!meshes.has(instance.mesh)) continue;
    const bool opaque = instance.look.opacity >= 1.0f;
    const unsigned bits = map_bits(instance.look, textures) | (instance.wet.version != 0 ? kWet : 0u);
    if (opaque ? (bits & ~unsigned{kEmits}) != 0 : (bits & kBaseMap) != 0) return false;
    triangles += meshes.triangle_count(instance.mesh) * (opaque ? 1 : 2);
  }
  return triangles <= kMaxTriangles;
}

void TiledMeshes::fill(List& list, std::span<const Sides> passes, const View& view,
                       const MeshStore& meshes) const {
  std::size_t groups = 0;
  for (const MeshInstance* instance : list.drawn)
    groups += passes.size() * groups_of(meshes.triangle_count(instance->mesh));
  list.groups = static_cast<int>(groups);
  if (groups == 0) return;
  list.triangles.reserve(groups * kGroup * kTriangleBytes);
  list.boxes.reserve(groups * kGroup * kBoxBytes);
  list.group_boxes.reserve(groups * kBoxBytes);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, list.triangles.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, list.boxes.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, list.group_boxes.name());
  triangles_.set("near_plane", view.near_plane);
  int first = 0;
  for (std::size_t i = 0; i < list.drawn.size(); ++i) {
    const MeshInstance& instance = *list.drawn[i];
    const auto own = meshes.triangle_count(instance.mesh);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, meshes.vertices(instance.mesh));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, meshes.indices(instance.mesh));
    triangles_.set("model", instance.model);
    triangles_.set("item", static_cast<int>(i));
    const bool outside_alone = instance.look.opacity >= 1.0f && shows_no_inside(instance, meshes, view);
    for (const Sides sides : passes) {
      triangles_.set("first", first);
      triangles_.set("sides", static_cast<int>(outside_alone ? Sides::kOutside : sides));
      gl::start_each(triangles_, own);
      first += static_cast<int>(kGroup * groups_of(own));
    }
  }
}

void TiledMeshes::start(const gl::Program& program, const List& list, const View& view, glm::ivec2 size) {
  if (list.groups > 0) {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, list.triangles.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, list.boxes.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, list.items.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, list.group_boxes.name());
  }
  program.use();
  program.set("count", list.groups);
  program.set("near_plane", view.near_plane);
  const glm::ivec2 tiles = (size + kTile - 1) / kTile;
  glDispatchCompute(static_cast<GLuint>(tiles.x), static_cast<GLuint>(tiles.y), 1);
}

void TiledMeshes::upload_looks(Instances opaque_nearest_first, Instances glass_farthest_first, Lists& lists) {
  lists.opaque.drawn = std::move(opaque_nearest_first);
  lists.glass.drawn = std::move(glass_farthest_first);
  for (List* list : {&lists.opaque, &lists.glass}) {
    std::vector<Item> items;
    for (const MeshInstance* instance : list->drawn) {
      const MeshLook& look = instance->look;
      items.push_back({{look.base_color, glm::clamp(look.opacity, 0.0f, 1.0f)},
                       {look.metallic, look.roughness, 0.0f, 0.0f},
                       {look.emissive, 0.0f}});
    }
    list->items.upload(std::span<const Item>(items));
  }
}

void TiledMeshes::start_lists(const View& view, const MeshStore& meshes, Lists& lists) const {
  constexpr Sides kEitherSide[] = {Sides::kBoth};
  constexpr Sides kFarSideFirst[] = {Sides::kInside, Sides::kOutside};
  fill(lists.opaque, kEitherSide, view, meshes);
  fill(lists.glass, std::span(kFarSideFirst).subspan(fast_ ? 1 : 0), view, meshes);
}

void TiledMeshes::start_opaque(const Lists& lists, const View& view, const Targets& targets, bool background,
                               bool occlusion_follows) const {
  const gl::Texture& color = occlusion_follows ? targets.mesh_color : targets.color;
  glBindImageTexture(0, color.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  glBindImageTexture(1, targets.scene_depth.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_R32F);
  opaque_.set("background", background ? 1 : 0);
  start(opaque_, lists.opaque, view, targets.size);
}

void TiledMeshes::start_glass(const Lists& lists, const View& view, const Targets& targets,
                              const gl::Texture* fluid, GlassPart part) const {
  const gl::Program& program = part == GlassPart::kBefore ? before_ : behind_;
  program.set("has_fluid", fluid ? 1 : 0);
  gl::bind_textures({fluid ? fluid : &targets.scene_depth, &targets.scene_depth});
  glBindImageTexture(0, targets.color.name(), 0, GL_FALSE, 0, GL_READ_WRITE, GL_RGBA16F);
  if (part == GlassPart::kBehind)
    glBindImageTexture(1, targets.scene_color.name(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  start(program, lists.glass, view, targets.size);
}

}  // namespace slosh
