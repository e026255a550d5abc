#include "render/passes/frame_block.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace slosh {
namespace {

/// Mirrors Look in shaders/look_block.glsl.
struct LookBlock {
  glm::vec4 color_displacement;
  glm::vec4 extinction_scattering;
  glm::vec4 specular_exponent;
  glm::vec4 surface;
};

}  // namespace

glm::vec3 direction_to_light(const Frame& frame) {
  const float length = glm::length(frame.light_direction);
  if (!std::isfinite(length) || length < 1e-6f) return {0.0f, 1.0f, 0.0f};
  return -frame.light_direction / length;
}

FrameBlock make_frame_block(const Frame& frame, const RenderOptions& options, const ShadowView& shadow,
                            bool chords) {
  const Studio studio;
  const glm::mat4& projection = frame.view.projection;
  const glm::vec2 size(options.width, options.height);
  const glm::vec3 to_light = direction_to_light(frame);

  FrameBlock block{};
  block.eye_from_world = frame.view.view;
  block.world_from_eye = glm::inverse(frame.view.view);
  block.clip_from_eye = projection;
  block.shadow_from_world = shadow.shadow_from_world;
  block.unproject = {1.0f / projection[0][0], 1.0f / projection[1][1], projection[2][0], projection[2][1]};
  block.picture = {size, 1.0f / size};
  block.to_light_world = {to_light, shadow.size > 0 ? 1.0f : 0.0f};
  block.to_light_eye = {glm::mat3(frame.view.view) * to_light,
                        shadow.size > 0 ? 1.0f / static_cast<float>(shadow.size) : 0.0f};
  block.camera = {glm::vec3(block.world_from_eye[3]), frame.view.far_plane};
  block.splat = {options.splat_scale * frame.particle_radius, 0.5f * projection[1][1] * size.y,
                 1.0f / (options.bilateral_range * frame.particle_radius),
                 1.0f / (shadow.depth_per_metre * options.splat_scale * frame.particle_radius)};
  // The filter reaches two texels to the side; on a steep surface that is as much in depth.
  block.key_light = {studio.key_light, 2.0f * shadow.texel};
  block.sky = {studio.sky, 0.0f};
  block.horizon = {studio.horizon, 0.0f};
  block.ground = {studio.ground, 0.0f};
  block.softbox = {studio.softbox, 0.0f};
  block.switches = {options.fresnel ? 1.0f : 0.0f, options.lit_fluid ? 1.0f : 0.0f,
                    options.fluid_shadow ? 1.0f : 0.0f, options.surface == Surface::kPaper ? 1.0f : 0.0f};
  block.look_switches = {chords ? 1.0f : 0.0f, 1.0f / shadow.depth_per_metre, shadow.reach, 0.0f};
  return block;
}

void FrameUniforms::upload(const FrameBlock& block) {
  frame_.upload(std::span(&block, 1));
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_.name());
}

void FrameUniforms::upload_looks(std::span<const FluidLook> fluids) {
  std::array<LookBlock, kMaxFluidLooks> looks{};
  for (std::size_t i = 0; i < std::min(fluids.size(), looks.size()); ++i) {
    const FluidLook& fluid = fluids[i];
    looks[i] = {{fluid.color, fluid.displacement},
                {fluid.extinction, fluid.scattering},
                {fluid.specular, fluid.specular_exponent},
                {fluid.gloss, fluid.refraction, fluid.roughness, 0.0f}};
  }
  looks_.upload(std::span<const LookBlock>(looks));
  glBindBufferBase(GL_UNIFORM_BUFFER, 1, looks_.name());
}

}  // namespace slosh
