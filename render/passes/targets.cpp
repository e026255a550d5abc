#include "render/passes/targets.h"

namespace slosh {

Targets make_targets(glm::ivec2 size, bool half_resolution_back, bool fast) {
  using gl::make_framebuffer;
  using gl::make_texture;
  Targets t;
  t.size = size;
  t.half_size = (size + 1) / 2;
  t.chord_size = fast ? (size + 3) / 4 : t.half_size;
  t.back_size = half_resolution_back ? t.half_size : size;

  t.mesh_color = make_texture(size, GL_RGBA16F, GL_NEAREST);
  t.color = make_texture(size, GL_RGBA16F, GL_NEAREST);
  t.scene_color = make_texture(size, GL_RGBA16F, GL_NEAREST);
  t.scene_depth = make_texture(size, GL_R32F, GL_NEAREST);
  t.depth = make_texture(size, GL_DEPTH_COMPONENT32F, GL_NEAREST);
  t.front = make_texture(size, GL_R32F, GL_LINEAR);
  for (gl::Texture& texture : t.smooth) texture = make_texture(size, GL_R32F, GL_LINEAR);
  t.back = make_texture(t.back_size, GL_R32F, GL_LINEAR);
  t.chord = make_texture(t.chord_size, GL_R16F, GL_LINEAR);
  t.occlusion = make_texture(t.half_size, GL_R8, GL_LINEAR);
  t.sharp = make_texture(size, GL_RGBA8, GL_NEAREST);
  t.display = make_texture(size, GL_RGBA8, GL_LINEAR);

  t.mesh_target = make_framebuffer({&t.mesh_color, &t.scene_depth}, &t.depth);
  t.plain_mesh_target = make_framebuffer({&t.color, &t.scene_depth}, &t.depth);
  t.color_target = make_framebuffer({&t.color});
  t.scene_color_target = make_framebuffer({&t.scene_color});
  t.blend_target = make_framebuffer({&t.color}, &t.depth);
  t.front_target = make_framebuffer({&t.front});
  for (std::size_t i = 0; i < 2; ++i) t.smooth_target[i] = make_framebuffer({&t.smooth[i]});
  t.back_target = make_framebuffer({&t.back});
  t.chord_target = make_framebuffer({&t.chord});
  t.occlusion_target = make_framebuffer({&t.occlusion});
  t.sharp_target = make_framebuffer({&t.sharp});
  t.display_target = make_framebuffer({&t.display});
  return t;
}

}  // namespace slosh
