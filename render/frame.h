// Everything one picture needs. Plain data, no GL: whoever has a world fills it, the renderer draws it.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "sim/math/shared_particles.h"
#include "sim/math/texture_sampling.h"

namespace slosh {

/// A mesh the renderer keeps on the GPU.
using MeshHandle = std::uint32_t;

/// A texture it keeps there.
using TextureHandle = std::uint32_t;
inline constexpr TextureHandle kNoTexture = 0xffffffffu;

/// Pixels of a texture, for the time of a call.
struct TextureImage {
  int width = 0;                       ///< 1–16384
  int height = 0;                      ///< 1–16384
  std::span<const std::uint8_t> rgba;  ///< 4 · width · height, rows from the top (v = 0) down
  bool srgb = false;                   ///< colours are sRGB; else the numbers as they are. Alpha is linear
  TextureSampling sampling;
};

/// What lies over a surface, as glTF has it: each multiplies the number of the same name. An unknown handle
/// is none.
struct MeshMaps {
  TextureHandle base_color = kNoTexture;
  TextureHandle metallic_roughness = kNoTexture;  ///< green roughness, blue metallic
  TextureHandle normal = kNoTexture;              ///< tangent space, y towards smaller v
  TextureHandle occlusion = kNoTexture;           ///< red: share of the light from all around that arrives
  TextureHandle emissive = kNoTexture;
  float normal_scale = 1.0f;
  float occlusion_strength = 1.0f;  ///< 0–1
  bool operator==(const MeshMaps&) const = default;
};

/// How a surface looks (linear sRGB primaries, glTF metallic-roughness).
struct MeshLook {
  glm::vec3 base_color{0.7f};
  float metallic = 0.0f;
  float roughness = 0.6f;
  float opacity = 1.0f;       ///< below 1 drawn blended after the fluid's background, a glass
  glm::vec3 emissive{0.0f};   ///< scene-linear light that it gives off, not to others
  float alpha_cutoff = 0.0f;  ///< an opaque surface has holes where the base colour map's alpha is below it
  MeshMaps maps{};            ///< of a glass only base_color is read
  bool operator==(const MeshLook&) const = default;
};

/// What draws frames and keeps their meshes.
class MeshSink {
 public:
  virtual ~MeshSink() = default;
  /// Copies a mesh. One normal a position; triangles counter-clockwise seen from outside; a triangle
  /// with an index out of range is left out. `texcoords`: one a position, v downward, or empty: then maps of
  /// its looks show their corner.
  virtual MeshHandle add_mesh(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                              std::span<const glm::uvec3> triangles,
                              std::span<const glm::vec2> texcoords = {}) = 0;
  /// Of no frame from now on; the handle is never given again.
  virtual void remove_mesh(MeshHandle mesh) = 0;
  /// Copies a texture for good. Sizes out of range or too few pixels give kNoTexture.
  virtual TextureHandle add_texture(const TextureImage& image) = 0;
};

/// Where fluid wets a body, or did: shares on a grid of cells in its mesh's frame. A cell says it of the
/// faces that have it within `off` before them; between cells' centres it is linear.
struct Wetness {
  std::uint64_t version = 0;             ///< another for other shares; 0: dry
  glm::vec3 low{0.0f};                   ///< m, the grid's corner
  float cell = 0.01f;                    ///< m
  float off = 0.005f;                    ///< m, before a face
  glm::ivec3 size{0};                    ///< cells
  std::span<const std::uint8_t> shares;  ///< a cell each, x runs first: below 64 dry, from 192 wet
  glm::ivec3 wet_low{0};                 ///< cells: in here lies all that is not 0,
  glm::ivec3 wet_high{0};                ///< this one excluded
  bool operator==(const Wetness& other) const { return version == other.version; }
};

struct MeshInstance {
  MeshHandle mesh = 0;
  glm::mat4 model{1.0f};  ///< mesh frame to world, rigid
  MeshLook look;
  Wetness wet{};  ///< of an opaque one
  bool operator==(const MeshInstance&) const = default;
};

/// How a fluid looks.
struct FluidLook {
  glm::vec3 color{0.10f, 0.35f, 0.55f};     ///< F_c of Eq 15
  glm::vec3 extinction{12.0f, 4.0f, 2.5f};  ///< F_e, 1/m

  // Eq 15's own, drawn where RenderOptions::lit_fluid is off.
  float displacement = 0.35f;        ///< β, in screen heights a metre of thickness
  glm::vec3 specular{0.6f};          ///< k_s
  float specular_exponent = 180.0f;  ///< α

  // Beyond the paper, drawn where lit_fluid is on (shaders/fluid_look.glsl).
  float scattering = 0.2f;  ///< 0–1: share of the light that F_e takes which comes back as F_c; else absorbed
  float gloss = 1.0f;       ///< 0–1: share of a clean surface's reflection
  float refraction = 1.33f;  ///< refractive index, >= 1
  float roughness = 0.05f;   ///< 0–1, of the surface, as glTF has it
};

struct View {
  glm::mat4 view{1.0f};        ///< world to eye, looking down −z
  glm::mat4 projection{1.0f};  ///< OpenGL clip space
  float near_plane = 0.02f;    ///< m
  float far_plane = 20.0f;     ///< m
  bool operator==(const View&) const = default;
};

/// An arrow in the world: a force in the HUD.
struct Arrow {
  glm::vec3 from{0.0f};
  glm::vec3 to{0.0f};
  glm::vec3 color{1.0f};
};

/// A drop of spray, a bubble, a patch of foam.
struct FoamPoint {
  glm::vec3 position{0.0f};  ///< m, world
  float radius = 0.001f;     ///< m
  float opacity = 1.0f;      ///< 0–1
};

/// A point of a body's surface.
struct WallPoint {
  glm::vec3 at{0.0f};      ///< m, world
  glm::vec3 normal{0.0f};  ///< unit, out of the body
};

struct Frame {
  View view;
  glm::vec3 light_direction{-0.4f, -1.0f, -0.35f};  ///< the way the light travels
  std::vector<MeshInstance> meshes;
  std::span<const glm::vec3> particles;          ///< m, world
  std::span<const std::uint8_t> particle_fluid;  ///< index into fluids, 255 = not drawn
  /// Both once more, in memory of a GPU, or null: read there where compute shaders draw on that GPU.
  std::shared_ptr<const SharedParticles> on_gpu;
  std::vector<FluidLook> fluids;
  float particle_radius =
      0.005f;  ///< m, of the ball with a particle's volume; splats are 1.2 times larger (5.1)
  /// The nearest wall within a reach in m: particles that few others surround lie on it as drops and films
  /// do. A processor asks for it, on the drawing thread; a GPU takes the meshes that a view sees. Empty: none
  /// lie.
  std::function<std::optional<WallPoint>(const glm::vec3& at, float reach)> wall;
  std::span<const FoamPoint> foam;  ///< drawn over the fluid; fades below its surface
  std::vector<Arrow> arrows;
  std::function<void()>
      hud;  ///< Dear ImGui calls for this frame, run between NewFrame and Render; may be empty
};

}  // namespace slosh
