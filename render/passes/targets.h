// The textures that passes write and later passes read. All of the picture's size unless said otherwise.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "render/gl/objects.h"

namespace slosh {

struct Targets {
  glm::ivec2 size{0};
  glm::ivec2 half_size{0};
  glm::ivec2 back_size{0};  ///< of the back depth: half_size or size

  glm::ivec2 chord_size{0};  ///< half of size, or a quarter where that has to be quick

  gl::Texture mesh_color;             ///< RGBA16F: meshes before occlusion; alpha = share occlusion may take
  gl::Texture color;                  ///< RGBA16F: the picture in scene-linear light
  gl::Texture scene_color;            ///< RGBA16F: S_c, a copy of color from before the fluid
  gl::Texture scene_depth;            ///< R32F: S_d, m
  gl::Texture depth;                  ///< DEPTH32F: hidden-surface removal of meshes
  gl::Texture front;                  ///< R32F: F_fD as splatted, the fluid's index in the low four bits
  std::array<gl::Texture, 2> smooth;  ///< R32F: F_fD through the filter, by turns
  gl::Texture back;                   ///< R32F, back_size: F_bD
  gl::Texture chord;                  ///< R16F, chord_size: fluid along the line of sight, summed, m
  gl::Texture occlusion;              ///< R8, half_size: 1 = open
  gl::Texture sharp;                  ///< RGBA8: the picture as shown, before its edges are smoothed
  gl::Texture display;                ///< RGBA8: the picture as shown

  gl::Framebuffer mesh_target;        ///< mesh_color + scene_depth + depth
  gl::Framebuffer plain_mesh_target;  ///< color + scene_depth + depth: meshes without occlusion
  gl::Framebuffer color_target;       ///< color
  gl::Framebuffer scene_color_target;
  gl::Framebuffer blend_target;  ///< color + depth: translucent meshes, arrows
  gl::Framebuffer front_target;
  std::array<gl::Framebuffer, 2> smooth_target;
  gl::Framebuffer back_target;
  gl::Framebuffer chord_target;
  gl::Framebuffer occlusion_target;
  gl::Framebuffer sharp_target;
  gl::Framebuffer display_target;
};

/// Sizes in pixels, >= 1. `fast`: less for a CPU.
Targets make_targets(glm::ivec2 size, bool half_resolution_back, bool fast);

}  // namespace slosh
