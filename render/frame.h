// Everything one picture needs. Plain data, no GL: whoever has a world fills it, the renderer draws it.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace slosh {

/// How a surface looks (linear sRGB primaries, glTF metallic-roughness).
struct MeshLook {
  glm::vec3 base_color{0.7f};
  float metallic = 0.0f;
  float roughness = 0.6f;
  float opacity = 1.0f;  ///< below 1 drawn blended after the fluid's background, a glass
};

/// A mesh the renderer keeps on the GPU.
using MeshHandle = std::uint32_t;

struct MeshInstance {
  MeshHandle mesh = 0;
  glm::mat4 model{1.0f};  ///< mesh frame to world, rigid
  MeshLook look;
};

/// How a fluid looks: the constants of Eq 15.
struct FluidLook {
  glm::vec3 color{0.10f, 0.35f, 0.55f};     ///< F_c
  glm::vec3 extinction{12.0f, 4.0f, 2.5f};  ///< F_e, 1/m
  float refraction = 0.35f;                 ///< β, displacement in screen heights a metre of thickness
  glm::vec3 specular{0.6f};                 ///< k_s
  float specular_exponent = 180.0f;         ///< α
};

struct View {
  glm::mat4 view{1.0f};        ///< world to eye, looking down −z
  glm::mat4 projection{1.0f};  ///< OpenGL clip space
  float near_plane = 0.02f;    ///< m
  float far_plane = 20.0f;     ///< m
};

/// An arrow in the world: a force in the HUD.
struct Arrow {
  glm::vec3 from{0.0f};
  glm::vec3 to{0.0f};
  glm::vec3 color{1.0f};
};

struct Frame {
  View view;
  glm::vec3 light_direction{-0.4f, -1.0f, -0.35f};  ///< the way the light travels
  std::vector<MeshInstance> meshes;
  std::span<const glm::vec3> particles;          ///< m, world
  std::span<const std::uint8_t> particle_fluid;  ///< index into fluids, 255 = not drawn
  std::vector<FluidLook> fluids;
  float particle_radius = 0.005f;  ///< m; splats are 1.2 times larger (5.1)
  std::vector<Arrow> arrows;
  std::function<void()>
      hud;  ///< Dear ImGui calls for this frame, run between NewFrame and Render; may be empty
};

}  // namespace slosh
