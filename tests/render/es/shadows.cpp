#include "tests/render/es/shadows.h"

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>

#include "render/passes/light_fit.h"

namespace slosh::es {
namespace {

/// As passes/fluid_shadow_pass.cpp has them: texels a side, a disc's radius over a ball's.
constexpr int kFluidShadowSize = 512;
constexpr float kSoft = 1.25f;

}  // namespace

Shadows shadows_of(const Frame& frame, const KeptMeshes& kept, int size) {
  std::vector<Caster> casters;
  std::vector<const MeshInstance*> opaque;
  for (const MeshInstance& mesh : frame.meshes) {
    if (mesh.look.opacity < 1.0f) continue;
    Bounds box;
    for (const glm::vec3& at : kept.meshes.at(mesh.mesh).positions) box.add(at);
    casters.push_back({box, mesh.model, true});
    opaque.push_back(&mesh);
  }
  Bounds fluid;
  for (const glm::vec3& at : frame.particles) fluid.add(at);
  fluid.low -= frame.particle_radius;
  fluid.high += frame.particle_radius;
  const LightFit fit = fit_light(casters, fluid, {&frame.view, 1}, direction_to_light(frame));

  Shadows out;
  for (std::size_t i = 0; i < opaque.size(); ++i)
    if (fit.casts[i]) out.casters.push_back(opaque[i]);
  const glm::mat4 clip = light_clip_from_world(fit, size);
  const auto scale_of = [&](int row) {
    return glm::length(glm::vec3(clip[0][row], clip[1][row], clip[2][row]));
  };
  out.view.clip_from_world = clip;
  out.view.shadow_from_world =
      glm::scale(glm::translate(glm::mat4(1.0f), glm::vec3(0.5f)), glm::vec3(0.5f)) * clip;
  out.view.depth_per_metre = 0.5f * scale_of(2);
  out.view.texel = 2.0f / (scale_of(0) * static_cast<float>(size));
  out.view.size = size;
  return out;
}

GLuint fluid_shadow(const Frame& frame, const RenderOptions& options, const ShadowView& view,
                    Canvas& canvas) {
  const GLuint map = make_texture(glm::ivec2(kFluidShadowSize), GL_RGBA16F, GL_LINEAR);
  canvas.clear_to(map, glm::ivec2(kFluidShadowSize), 0.0f);
  if (!canvas.use("fluid_shadow.vert", "fluid_shadow.frag", {})) return 0;
  std::array<glm::vec3, kMaxFluidLooks> extinction{};
  for (std::size_t i = 0; i < std::min(frame.fluids.size(), kMaxFluidLooks); ++i)
    extinction[i] = frame.fluids[i].extinction;
  glUniform3fv(canvas.at("extinction"), kMaxFluidLooks, &extinction[0].x);
  const glm::mat4& clip = view.clip_from_world;
  const float per_metre = glm::length(glm::vec3(clip[0][0], clip[1][0], clip[2][0])) * kFluidShadowSize;
  const float texels =
      glm::clamp(kSoft * frame.particle_radius * options.splat_scale * per_metre, 1.0f, 64.0f);
  const float drawn = texels / per_metre;
  const float radius = frame.particle_radius;
  canvas.set("clip_from_world", clip);
  canvas.set("point_size", texels);
  canvas.set("weight", 1.0f);
  canvas.set("chord", 2.0f * radius * radius * radius / (drawn * drawn));
  std::vector<glm::vec4> particles;
  for (std::size_t i = 0; i < frame.particles.size(); ++i)
    particles.emplace_back(frame.particles[i], static_cast<float>(frame.particle_fluid[i]));
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glBlendEquationSeparate(GL_FUNC_ADD, GL_MAX);
  canvas.points(particles);
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
  return map;
}

}  // namespace slosh::es
