#include "render/passes/shadow_pass.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace slosh {
namespace {

/// Texture unit of shaders/shadow.glsl.
constexpr GLuint kShadowUnit = 8;

/// World box of the meshes that cast shadows, cut to what lies within the far plane of the eye.
Bounds caster_bounds(const Frame& frame, const MeshStore& meshes) {
  const glm::vec3 eye(glm::inverse(frame.view.view)[3]);
  Bounds box;
  for (const MeshInstance& instance : frame.meshes) {
    if (!meshes.has(instance.mesh) || instance.look.opacity < 1.0f) continue;
    const Bounds& own = meshes.bounds(instance.mesh);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 world(instance.model * glm::vec4(box_corner(own, corner), 1.0f));
      box.add(glm::clamp(world, eye - frame.view.far_plane, eye + frame.view.far_plane));
    }
  }
  return box;
}

/// Of the particles within the far plane's distance of the eye, along to_light, m.
float highest_fluid(const Frame& frame, const glm::vec3& to_light) {
  const float eye = glm::dot(glm::vec3(glm::inverse(frame.view.view)[3]), to_light);
  float highest = -1e30f;
  for (const glm::vec3& particle : frame.particles) {
    const float height = glm::dot(particle, to_light);
    if (height > highest && height < eye + frame.view.far_plane) highest = height;
  }
  return highest;
}

}  // namespace

glm::vec3 box_corner(const Bounds& box, int corner) {
  return {(corner & 1) ? box.high.x : box.low.x, (corner & 2) ? box.high.y : box.low.y,
          (corner & 4) ? box.high.z : box.low.z};
}

glm::mat4 light_clip_from_world(const Bounds& box, const glm::vec3& to_light, float highest, int size) {
  const glm::vec3 up =
      std::abs(to_light.y) > 0.99f ? glm::vec3(0.0f, 0.0f, 1.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
  const glm::mat4 light = glm::lookAt(glm::vec3(0.0f), -to_light, up);
  Bounds seen;
  for (int corner = 0; corner < 8; ++corner) {
    seen.add(glm::vec3(light * glm::vec4(box_corner(box, corner), 1.0f)));
  }
  seen.high.z = std::max(seen.high.z, highest);
  // Round the extent up and the centre to whole texels: a body that moves the box must not make the edges
  // crawl.
  const glm::vec3 span = glm::max(seen.high - seen.low, glm::vec3(1e-3f));
  const float extent = std::exp2(std::ceil(4.0f * std::log2(std::max(span.x, span.y) * 1.02f)) / 4.0f);
  const float texel = extent / static_cast<float>(size);
  const glm::vec2 center = glm::floor(0.5f * glm::vec2(seen.low + seen.high) / texel) * texel;
  const float margin = 0.01f * span.z + 1e-3f;
  return glm::ortho(center.x - 0.5f * extent, center.x + 0.5f * extent, center.y - 0.5f * extent,
                    center.y + 0.5f * extent, -seen.high.z - margin, -seen.low.z + margin) *
         light;
}

Result<ShadowPass> ShadowPass::create(int size) {
  auto program = gl::Program::create("depth_only.vert", "nothing.frag");
  if (!program) return program.error();
  ShadowPass pass;
  pass.program_ = std::move(program.value());
  pass.size_ = size;
  pass.map_ = gl::make_texture(glm::ivec2(size), GL_DEPTH_COMPONENT32F, GL_LINEAR);
  glTextureParameteri(pass.map_.name(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
  glTextureParameteri(pass.map_.name(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
  pass.target_ = gl::make_framebuffer({}, &pass.map_);
  return pass;
}

ShadowView ShadowPass::draw(const Frame& frame, const MeshStore& meshes) {
  glBindTextureUnit(kShadowUnit, map_.name());
  const Bounds box = caster_bounds(frame, meshes);
  if (box.empty()) return {};
  const glm::vec3 to_light = direction_to_light(frame);
  const glm::mat4 clip_from_world =
      light_clip_from_world(box, to_light, highest_fluid(frame, to_light), size_);

  glBindFramebuffer(GL_FRAMEBUFFER, target_.name());
  glViewport(0, 0, size_, size_);
  const float farthest = 1.0f;
  glClearNamedFramebufferfv(target_.name(), GL_DEPTH, 0, &farthest);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(2.0f, 4.0f);
  program_.use();
  for (const MeshInstance& instance : frame.meshes) {
    if (!meshes.has(instance.mesh) || instance.look.opacity < 1.0f) continue;
    program_.set("clip_from_model", clip_from_world * instance.model);
    meshes.draw(instance.mesh);
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glDisable(GL_DEPTH_TEST);

  const glm::mat4 to_texture =
      glm::translate(glm::mat4(1.0f), glm::vec3(0.5f)) * glm::scale(glm::mat4(1.0f), glm::vec3(0.5f));
  ShadowView view;
  view.clip_from_world = clip_from_world;
  view.shadow_from_world = to_texture * clip_from_world;
  const auto row = [&](int i) {
    return glm::vec3(clip_from_world[0][i], clip_from_world[1][i], clip_from_world[2][i]);
  };
  view.depth_per_metre = 0.5f * glm::length(row(2));  // an orthographic view's depth rises evenly
  view.texel = 2.0f / (glm::length(row(0)) * static_cast<float>(size_));
  view.size = size_;
  return view;
}

}  // namespace slosh
