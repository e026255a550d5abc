// What a glTF's materials say of textures, and the bytes of its images. Looks are no reason not to run:
// whatever is wrong here is left out and told.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenes/gltf/document.h"
#include "scenes/scene.h"

namespace slosh::gltf {

/// Which of a mesh's texture coordinates are used, and what is done to them (KHR_texture_transform).
struct TexcoordUse {
  int set = 0;             ///< TEXCOORD_0, TEXCOORD_1, …
  glm::dmat2 linear{1.0};  ///< texture coordinate = linear · (u, v) + offset
  glm::dvec2 offset{0.0};

  bool operator==(const TexcoordUse&) const = default;
};

/// One reference of a material to a texture.
struct TextureUse {
  int image = -1;  ///< of the glTF, in range
  TextureSampling sampling;
  TexcoordUse texcoords;
  double factor = 1.0;  ///< a normal map's scale, an occlusion map's strength
};

/// A material's five; an absent one has image −1.
struct MaterialUse {
  TextureUse base_color, metallic_roughness, normal, occlusion, emissive;
  glm::dvec3 emission{0.0};    ///< emissiveFactor · KHR_materials_emissive_strength, 0–100
  std::optional<double> mask;  ///< alphaCutoff where alphaMode is MASK
  bool blended = false;        ///< alphaMode is BLEND

  /// The first texture's; nothing without textures.
  std::optional<TexcoordUse> texcoords() const;
};

/// The material that a mesh is shown with: of its first primitive that has one; −1 = none.
int material_of(const Document& document, int mesh);

/// `problems`: one for each reference that cannot be followed; it is as if it was not there. May be null.
MaterialUse read_material_use(const Document& document, int material, std::vector<Error>* problems);

/// The bytes of image `index` (in range), still packed: from a buffer view, a data URI, or a file in the
/// scene's own folder or below it. Errors: none of these, cut off, more than kMaxImageBytes.
Result<SceneImage> read_image(const Document& document, int index);

}  // namespace slosh::gltf
