// How surfaces look, as glTF says it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "sim/math/texture_sampling.h"

namespace slosh {

/// A picture for textures as its file has it: a PNG or a JPEG (images/decode.h unpacks it).
struct SceneImage {
  std::string name;
  std::vector<std::uint8_t> bytes;  ///< at most kMaxImageBytes
};

inline constexpr std::size_t kMaxImageBytes = 64u << 20;  ///< of one image, packed
inline constexpr std::size_t kMaxImages = 256;            ///< of one scene

/// A picture laid over a surface.
struct TextureMap {
  int image = -1;  ///< index into Scene::images, −1 = none
  TextureSampling sampling;

  bool operator==(const TextureMap&) const = default;
};

/// glTF's five, each multiplied with the number of the same name.
struct MaterialMaps {
  TextureMap base_color;          ///< sRGB; alpha counts where Material::alpha_cutoff or opacity asks for it
  TextureMap metallic_roughness;  ///< linear: green roughness, blue metallic
  TextureMap normal;              ///< linear: tangent space, y towards smaller v
  TextureMap occlusion;           ///< linear: red
  TextureMap emissive;            ///< sRGB
  float normal_scale = 1.0f;      ///< ±10
  float occlusion_strength = 1.0f;  ///< 0–1

  bool any() const {
    return base_color.image >= 0 || metallic_roughness.image >= 0 || normal.image >= 0 ||
           occlusion.image >= 0 || emissive.image >= 0;
  }
  bool operator==(const MaterialMaps&) const = default;
};

/// How a surface looks (linear sRGB primaries, glTF metallic-roughness).
struct Material {
  glm::vec3 base_color{0.7f};
  float metallic = 0.0f;      ///< 0–1
  float roughness = 0.6f;     ///< 0–1
  float opacity = 1.0f;       ///< 1 opaque; below 1 drawn blended (a glass)
  glm::vec3 emissive{0.0f};   ///< 0–100, scene-linear: light that it gives off
  float alpha_cutoff = 0.0f;  ///< 0–1: where the base colour map's alpha is below it there is nothing
  MaterialMaps maps{};

  bool operator==(const Material&) const = default;
};

}  // namespace slosh
