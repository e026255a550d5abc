// What every pass of a frame knows: the uniform block of shaders/frame_block.glsl.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "render/frame.h"
#include "render/gl/objects.h"
#include "render/renderer.h"

namespace slosh {

/// The studio that every scene stands in. Scene-linear Rec.709.
struct Studio {
  glm::vec3 key_light{3.6f, 3.4f, 3.15f};   ///< irradiance of the light on a surface that faces it
  glm::vec3 sky{0.40f, 0.44f, 0.50f};       ///< radiance from straight above
  glm::vec3 horizon{0.84f, 0.80f, 0.74f};   ///< from the side
  glm::vec3 ground{0.21f, 0.175f, 0.145f};  ///< from below
  glm::vec3 softbox{4.0f, 3.9f, 3.7f};      ///< radiance of the light as a mirror shows it
};

/// Mirrors the block in shaders/frame_block.glsl (std140), which says what each member is.
struct FrameBlock {
  glm::mat4 eye_from_world;
  glm::mat4 world_from_eye;
  glm::mat4 clip_from_eye;
  glm::mat4 shadow_from_world;
  glm::vec4 unproject;
  glm::vec4 picture;
  glm::vec4 to_light_world;
  glm::vec4 to_light_eye;
  glm::vec4 camera;
  glm::vec4 splat;
  glm::vec4 key_light;
  glm::vec4 sky;
  glm::vec4 horizon;
  glm::vec4 ground;
  glm::vec4 softbox;
  glm::vec4 switches;
  glm::vec4 look_switches;
};
static_assert(sizeof(FrameBlock) == 16 * (4 * 4 + 13));

/// Looks a scene can mix: four bits beside the depth carry the index.
inline constexpr std::size_t kMaxFluidLooks = 16;

/// How the light sees the scene.
struct ShadowView {
  glm::mat4 clip_from_world{1.0f};
  glm::mat4 shadow_from_world{1.0f};  ///< to the map's texture coordinates and depth, 0–1
  float depth_per_metre = 1.0f;       ///< of the map's depth
  float texel = 0.0f;                 ///< m
  float reach = 0.0f;                 ///< texels about a point that are searched for what casts shadows
  int size = 0;                       ///< texels a side, 0 = no shadows
};

/// Unit vector towards the light; straight up if the frame's direction is zero or not finite.
glm::vec3 direction_to_light(const Frame& frame);

/// `chords`: thickness is summed particle by particle this frame.
FrameBlock make_frame_block(const Frame& frame, const RenderOptions& options, const ShadowView& shadow,
                            bool chords);

/// Holds a picture's and the fluids' uniform blocks on bindings 0 and 1.
class FrameUniforms {
 public:
  void upload(const FrameBlock& block);
  void upload_looks(std::span<const FluidLook> fluids);

 private:
  gl::StreamBuffer frame_;
  gl::StreamBuffer looks_;
};

}  // namespace slosh
