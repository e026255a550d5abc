#include "render/passes/scene_pass.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace slosh {
namespace {

void set_look(const gl::Program& program, const MeshInstance& instance, unsigned bits) {
  program.set("model", instance.model);
  program.set("base", glm::vec4(instance.look.base_color, glm::clamp(instance.look.opacity, 0.0f, 1.0f)));
  program.set("roughness", glm::vec2(instance.look.metallic, instance.look.roughness));
  if (bits == 0) return;
  program.set("emissive", instance.look.emissive);
  program.set("alpha_cutoff", instance.look.alpha_cutoff);
  program.set("normal_scale", instance.look.maps.normal_scale);
  program.set("occlusion_strength", instance.look.maps.occlusion_strength);
}

/// The frame's known meshes of a wanted opacity, nearest centre first.
template <class Wanted>
TiledMeshes::Instances sorted_by_distance(const Frame& frame, const MeshStore& meshes, Wanted wanted) {
  std::vector<std::pair<float, const MeshInstance*>> found;
  for (const MeshInstance& instance : frame.meshes) {
    if (!meshes.has(instance.mesh) || !wanted(instance.look.opacity)) continue;
    const Bounds& box = meshes.bounds(instance.mesh);
    const glm::vec4 middle(0.5f * (box.low + box.high), 1.0f);
    const float distance = -(frame.view.view * instance.model * middle).z;
    if (std::isfinite(distance)) found.emplace_back(distance, &instance);  // a body that blew up is not drawn
  }
  std::ranges::stable_sort(found, [](const auto& a, const auto& b) { return a.first < b.first; });
  TiledMeshes::Instances sorted;
  for (const auto& [distance, instance] : found) sorted.push_back(instance);
  return sorted;
}

// In the order in which they are drawn.
TiledMeshes::Instances opaque_nearest_first(const Frame& frame, const MeshStore& meshes) {
  return sorted_by_distance(frame, meshes, [](float opacity) { return opacity >= 1.0f; });
}
TiledMeshes::Instances glass_farthest_first(const Frame& frame, const MeshStore& meshes) {
  auto sorted = sorted_by_distance(frame, meshes, [](float opacity) { return opacity < 1.0f; });
  std::ranges::reverse(sorted);
  return sorted;
}

}  // namespace

bool has_translucent(const Frame& frame) {
  return std::ranges::any_of(frame.meshes, [](const MeshInstance& m) { return m.look.opacity < 1.0f; });
}

bool has_opaque(const Frame& frame) {
  return std::ranges::any_of(frame.meshes, [](const MeshInstance& m) { return m.look.opacity >= 1.0f; });
}

Result<ScenePass::Programs> ScenePass::Programs::create(const char* fragment,
                                                        std::vector<std::string> defines) {
  Programs out;
  out.fragment = fragment;
  out.defines = std::move(defines);
  auto plain = gl::Program::create("mesh.vert", fragment, out.defines);
  if (!plain) return plain.error();
  out.by_bits[0] = std::move(plain.value());
  return out;
}

const gl::Program& ScenePass::Programs::of(unsigned bits) {
  if (const auto known = by_bits.find(bits); known != by_bits.end()) return known->second;
  std::vector<std::string> all = defines;
  for (std::string& define : map_defines(bits)) all.push_back(std::move(define));
  auto made = gl::Program::create("mesh.vert", fragment, std::move(all));
  if (!made) return by_bits[0];  // a driver that refuses this one: its numbers without its maps
  return by_bits[bits] = std::move(made.value());
}

Result<ScenePass> ScenePass::create(bool fast, bool compute, const std::vector<std::string>& far_light) {
  ScenePass pass;
  pass.fast_ = fast;
  const MeshDefines defines = mesh_defines(fast, far_light);
  for (const Result<bool>& loaded :
       {gl::take(pass.background_, gl::Program::create("fullscreen.vert", "background.frag", far_light)),
        gl::take(pass.occlusion_, gl::PixelProgram::create("occlusion.frag", compute, false, {"TAPS 8"})),
        gl::take(pass.resolve_, gl::PixelProgram::create("resolve.frag", compute, false, {"EACH 4"})),
        gl::take(pass.opaque_, Programs::create("mesh.frag", defines.opaque)),
        gl::take(pass.translucent_behind_, Programs::create("translucent.frag", defines.behind)),
        gl::take(pass.translucent_front_, Programs::create("translucent.frag", far_light))}) {
    if (!loaded) return loaded.error();
  }
  if (compute) {
    auto tiled = TiledMeshes::create(fast, far_light);
    if (!tiled) return tiled.error();
    pass.tiled_ = std::move(tiled.value());
  }
  pass.no_vertices_ = gl::make_vertex_array();
  return pass;
}

void ScenePass::draw_opaque(const Frame& frame, const MeshStore& meshes, const TextureStore& textures,
                            const WetMaps& wet, const Targets& targets, bool background,
                            bool occlusion_follows) {
  const auto sorted = opaque_nearest_first(frame, meshes);
  const gl::Framebuffer& target = occlusion_follows ? targets.mesh_target : targets.plain_mesh_target;
  const glm::vec4 black(0.0f);
  const glm::vec4 nothing(kNoFluidDepth);
  const float farthest = 1.0f;
  if (!background) glClearNamedFramebufferfv(target.name(), GL_COLOR, 0, &black.x);
  glClearNamedFramebufferfv(target.name(), GL_COLOR, 1, &nothing.x);
  glClearNamedFramebufferfv(target.name(), GL_DEPTH, 0, &farthest);
  glBindFramebuffer(GL_FRAMEBUFFER, target.name());
  glViewport(0, 0, targets.size.x, targets.size.y);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  // Near before far and outsides before insides: what is hidden is then not shaded. Insides show where a mesh
  // is open or the eye is in it.
  glEnable(GL_CULL_FACE);
  for (GLenum culled : {GL_BACK, GL_FRONT}) {
    glCullFace(culled);
    for (const MeshInstance* instance : sorted) {
      const bool is_wet = wet.has(frame, *instance);
      const unsigned bits = map_bits(instance->look, textures) | (is_wet ? kWet : 0u);
      const gl::Program& program = opaque_.of(bits);
      program.use();
      set_look(program, *instance, bits);
      if (is_wet) wet.bind(frame, *instance, program);
      bind_maps(instance->look.maps, bits, textures);
      meshes.draw(instance->mesh);
    }
  }
  glDisable(GL_CULL_FACE);
  if (background) {
    // The triangle lies on the far plane: it fills what the meshes left. It writes no depth.
    glColorMaski(1, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glDepthMask(GL_FALSE);
    glDepthFunc(GL_LEQUAL);
    background_.use();
    glBindVertexArray(no_vertices_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
    glColorMaski(1, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  }
  glDisable(GL_DEPTH_TEST);
}

bool ScenePass::takes_tiles(const Frame& frame, const MeshStore& meshes, const TextureStore& textures) const {
  return tiled_ && TiledMeshes::suit(frame, meshes, textures);
}

void ScenePass::upload_looks(const Frame& frame, const MeshStore& meshes, TiledMeshes::Lists& lists) {
  TiledMeshes::upload_looks(opaque_nearest_first(frame, meshes), glass_farthest_first(frame, meshes), lists);
}

void ScenePass::start_lists(const Frame& frame, const MeshStore& meshes, TiledMeshes::Lists& lists) const {
  tiled_->start_lists(frame.view, meshes, lists);
}

void ScenePass::start_opaque(const Frame& frame, const TiledMeshes::Lists& lists, const Targets& targets,
                             bool background, bool occlusion_follows) const {
  tiled_->start_opaque(lists, frame.view, targets, background, occlusion_follows);
}

void ScenePass::start_translucent(const Frame& frame, const TiledMeshes::Lists& lists, const Targets& targets,
                                  const gl::Texture* fluid, GlassPart part) const {
  tiled_->start_glass(lists, frame.view, targets, fluid, part);
}

void ScenePass::start_occlusion(const Targets& targets, float reach) const {
  gl::bind_textures({&targets.scene_depth});
  occlusion_.program().set("reach", reach);
  occlusion_.start({targets.occlusion, targets.occlusion_target, targets.half_size, GL_R8});
}

void ScenePass::start_resolve(const Targets& targets) const {
  gl::bind_textures({&targets.mesh_color, &targets.occlusion});
  resolve_.start({targets.color, targets.color_target, targets.size, GL_RGBA16F});
}

void ScenePass::draw_translucent(const Frame& frame, const MeshStore& meshes, const TextureStore& textures,
                                 const Targets& targets, const gl::Texture* fluid, bool behind) {
  const auto sorted = glass_farthest_first(frame, meshes);
  if (sorted.empty()) return;
  Programs& programs = behind ? translucent_behind_ : translucent_front_;
  if (fluid) gl::bind_textures({fluid});
  glBindFramebuffer(GL_FRAMEBUFFER, targets.blend_target.name());
  glViewport(0, 0, targets.size.x, targets.size.y);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_SRC1_COLOR);  // translucent.frag: light added, share of what is behind
  glEnable(GL_CULL_FACE);
  // Glass that stands on a table has its underside where the table's top is: rounding showed that in stripes.
  // By a few steps of the depth buffer it is nearer, so it is seen whole.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(0.0f, -16.0f);
  for (const MeshInstance* instance : sorted) {
    const unsigned bits = map_bits(instance->look, textures) & kBaseMap;
    const gl::Program& program = programs.of(bits);
    program.use();
    program.set("has_fluid", fluid ? 1 : 0);
    set_look(program, *instance, bits);
    bind_maps(instance->look.maps, bits, textures);
    for (GLenum culled : {GL_FRONT, GL_BACK}) {  // the far side first
      if (fast_ && culled == GL_FRONT) continue;
      glCullFace(culled);
      meshes.draw(instance->mesh);
    }
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  // A factor of the second output forbids targets of several textures, blended or not (GL 4.5, 17.3.6).
  glBlendFunc(GL_ONE, GL_ZERO);
  glDepthMask(GL_TRUE);
  glDisable(GL_DEPTH_TEST);
}

}  // namespace slosh
