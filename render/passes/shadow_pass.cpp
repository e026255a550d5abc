#include "render/passes/shadow_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>
#include <vector>

#include "render/passes/light_fit.h"

namespace slosh {
namespace {

/// Texture units of shaders/shadow.glsl.
constexpr GLuint kReachUnit = 7;
constexpr GLuint kShadowUnit = 8;
constexpr int kTile = 8;  ///< texels a side (shadow_reach.frag)

/// m to each side of a shadow's edge: no softer than the map's tiles allow, up to two of them.
constexpr float kSoftest = 0.016f;

/// The frame's known opaque meshes; `drawn`: which they are.
std::vector<Caster> casters_of(const Frame& frame, const MeshStore& meshes,
                               std::vector<const MeshInstance*>& drawn) {
  std::vector<Caster> casters;
  for (const MeshInstance& instance : frame.meshes) {
    if (!meshes.has(instance.mesh) || instance.look.opacity < 1.0f) continue;
    const glm::vec4 sum = instance.model[0] + instance.model[1] + instance.model[2] + instance.model[3];
    if (!std::isfinite(glm::dot(sum, glm::vec4(1.0f)))) continue;  // a body that blew up
    casters.push_back({meshes.bounds(instance.mesh), instance.model, meshes.convex(instance.mesh)});
    drawn.push_back(&instance);
  }
  return casters;
}

/// Sixteen boxes side by side, a particle in sixteen each: of a million particles, one after the other took
/// several milliseconds.
class Boxes {
 public:
  explicit Boxes(const Bounds& within) : within_(within) {
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis].fill(kEmpty.low[axis]);
      high_[axis].fill(kEmpty.high[axis]);
    }
  }
  /// Particles of one of the first `fluids`, `count` up to kSide of them. What is not finite is not within
  /// either.
  void add(const glm::vec3* at, const std::uint8_t* fluid, std::size_t fluids, std::size_t count) {
    const glm::vec3 lowest = within_.low;
    const glm::vec3 highest = within_.high;
    for (std::size_t k = 0; k < count; ++k) {
      const float x = at[k].x, y = at[k].y, z = at[k].z;
      const bool counts = (x > lowest.x) & (x < highest.x) & (y > lowest.y) & (y < highest.y) &
                          (z > lowest.z) & (z < highest.z) & (fluid[k] < fluids);
      grow(0, k, counts, x);
      grow(1, k, counts, y);
      grow(2, k, counts, z);
    }
  }
  Bounds all() const {
    Bounds box;
    for (std::size_t k = 0; k < kSide; ++k)
      for (int axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], low_[axis][k]);
        box.high[axis] = std::max(box.high[axis], high_[axis][k]);
      }
    return box;
  }
  static constexpr std::size_t kSide = 16;

 private:
  static constexpr Bounds kEmpty{};
  void grow(int axis, std::size_t k, bool counts, float value) {
    const float low = counts ? value : kEmpty.low[axis];
    const float high = counts ? value : kEmpty.high[axis];
    low_[axis][k] = std::min(low_[axis][k], low);
    high_[axis][k] = std::max(high_[axis][k], high);
  }
  Bounds within_;
  std::array<std::array<float, kSide>, 3> low_;
  std::array<std::array<float, kSide>, 3> high_;
};

/// Of the particles within the far plane's distance of the eye.
Bounds fluid_box(const Frame& frame, const View& view) {
  const glm::vec3 eye(glm::inverse(view.view)[3]);
  const std::size_t count = std::min(frame.particles.size(), frame.particle_fluid.size());
  Boxes boxes({eye - view.far_plane, eye + view.far_plane});
  const glm::vec3* at = frame.particles.data();
  const std::uint8_t* fluid = frame.particle_fluid.data();
  std::size_t i = 0;
  for (; i + Boxes::kSide <= count; i += Boxes::kSide)
    boxes.add(at + i, fluid + i, frame.fluids.size(), Boxes::kSide);
  boxes.add(at + i, fluid + i, frame.fluids.size(), count - i);
  Bounds box = boxes.all();
  if (box.empty()) return box;
  box.low -= frame.particle_radius;
  box.high += frame.particle_radius;
  return box;
}

}  // namespace

Result<ShadowPass> ShadowPass::create(int size) {
  ShadowPass pass;
  for (const Result<bool>& loaded :
       {gl::take(pass.program_, gl::Program::create("depth_only.vert", "nothing.frag")),
        gl::take(pass.tiles_program_, gl::Program::create("fullscreen.vert", "shadow_reach.frag")),
        gl::take(pass.reach_program_,
                 gl::Program::create("fullscreen.vert", "shadow_reach.frag", {"SPREAD"}))}) {
    if (!loaded) return loaded.error();
  }
  pass.no_vertices_ = gl::make_vertex_array();
  const glm::ivec2 tiles((size + kTile - 1) / kTile);
  pass.tiles_ = gl::make_texture(tiles, GL_RG32F, GL_NEAREST);
  pass.tiles_target_ = gl::make_framebuffer({&pass.tiles_});
  pass.reach_ = gl::make_texture(tiles, GL_RG32F, GL_LINEAR);
  pass.reach_target_ = gl::make_framebuffer({&pass.reach_});
  pass.size_ = size;
  pass.map_ = gl::make_texture(glm::ivec2(size), GL_DEPTH_COMPONENT32F, GL_LINEAR);
  glTextureParameteri(pass.map_.name(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  pass.target_ = gl::make_framebuffer({}, &pass.map_);
  return pass;
}

void ShadowPass::draw_map(const MeshStore& meshes, std::span<const Shown> shown) {
  glBindFramebuffer(GL_FRAMEBUFFER, target_.name());
  glViewport(0, 0, size_, size_);
  const float farthest = 1.0f;
  glClearNamedFramebufferfv(target_.name(), GL_DEPTH, 0, &farthest);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(2.0f, 4.0f);
  program_.use();
  for (const Shown& one : shown) {
    program_.set("clip_from_model", one.clip_from_model);
    meshes.draw(one.mesh);
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_DEPTH_TEST);
}

void ShadowPass::find_reach(int tiles_beside) {
  glTextureParameteri(map_.name(), GL_TEXTURE_COMPARE_MODE, GL_NONE);
  const int side = (size_ + kTile - 1) / kTile;
  glViewport(0, 0, side, side);
  glBindVertexArray(no_vertices_.name());
  reach_program_.set("tiles_beside", tiles_beside);
  const auto pass = [](const gl::Texture& from, const gl::Program& program, const gl::Framebuffer& to) {
    gl::bind_textures({&from});
    glBindFramebuffer(GL_FRAMEBUFFER, to.name());
    program.use();
    glDrawArrays(GL_TRIANGLES, 0, 3);
  };
  pass(map_, tiles_program_, reach_target_);
  reach_program_.set("along", glm::ivec2(1, 0));
  pass(reach_, reach_program_, tiles_target_);
  reach_program_.set("along", glm::ivec2(0, 1));
  pass(tiles_, reach_program_, reach_target_);
  glTextureParameteri(map_.name(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
}

ShadowView ShadowPass::draw(const Frame& frame, const MeshStore& meshes, std::span<const View> views) {
  glBindTextureUnit(kReachUnit, reach_.name());
  glBindTextureUnit(kShadowUnit, map_.name());
  std::vector<const MeshInstance*> drawn;
  const std::vector<Caster> casters = casters_of(frame, meshes, drawn);
  if (casters.empty()) return {};
  const LightFit fit = fit_light(casters, fluid_box(frame, views.front()), views, direction_to_light(frame));
  const glm::mat4 clip_from_world = light_clip_from_world(fit, size_);

  std::vector<Shown> shown;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    // A table alone would fill the map.
    if (fit.casts[i]) shown.push_back({drawn[i]->mesh, clip_from_world * drawn[i]->model});
  }
  const glm::vec3 across(clip_from_world[0][0], clip_from_world[1][0], clip_from_world[2][0]);
  const float texel = 2.0f / (glm::length(across) * static_cast<float>(size_));
  const int tiles_beside = texel * kTile < kSoftest ? 2 : 1;
  if (!kept_ || shown != *kept_) {
    draw_map(meshes, shown);
    find_reach(tiles_beside);
  }
  kept_ = std::move(shown);

  const glm::mat4 to_texture =
      glm::translate(glm::mat4(1.0f), glm::vec3(0.5f)) * glm::scale(glm::mat4(1.0f), glm::vec3(0.5f));
  ShadowView view;
  view.clip_from_world = clip_from_world;
  view.shadow_from_world = to_texture * clip_from_world;
  const glm::vec3 away(clip_from_world[0][2], clip_from_world[1][2], clip_from_world[2][2]);
  view.depth_per_metre = 0.5f * glm::length(away);  // an orthographic view's depth rises evenly
  view.texel = texel;
  view.reach = static_cast<float>(kTile * tiles_beside);
  view.size = size_;
  return view;
}

}  // namespace slosh
