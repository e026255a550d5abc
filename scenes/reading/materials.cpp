// How bodies and pictures look: numbers and textures of their materials.
#include <algorithm>

#include "scenes/gltf/textures.h"
#include "scenes/images/decode.h"
#include "scenes/reading/reading.h"

namespace slosh::reading {
namespace {

/// A picture that is too much, or none, is told once and left out everywhere.
int take_image(Reading& reading, int source) {
  if (const auto known = reading.images.find(source); known != reading.images.end()) return known->second;
  int& index = reading.images[source];
  index = -1;
  const auto leave_out = [&](const Error& error) {
    reading.scene.left_out.push_back(error);
    return -1;
  };
  Result<SceneImage> read = gltf::read_image(reading.document, source);
  if (!read) return leave_out(read.error());
  SceneImage& image = read.value();
  const std::string where = reading.document.file + ": image '" + image.name + "'";
  const Result<images::Facts> facts = images::look_at(image.bytes, where);
  if (!facts) return leave_out(facts.error());
  const bool fits = reading.image_pixels + facts.value().pixels() <= images::kMaxPixels;
  if (!fits || reading.scene.images.size() >= kMaxImages)
    return leave_out({where,
                      "would be more than " + std::to_string(images::kMaxPixels >> 20) +
                          " million pixels or " + std::to_string(kMaxImages) + " images in one scene",
                      "Scale the pictures down"});
  reading.image_pixels += facts.value().pixels();
  index = static_cast<int>(reading.scene.images.size());
  reading.scene.images.push_back(std::move(image));
  return index;
}

TextureMap take_map(Reading& reading, const gltf::TextureUse& use) {
  return {use.image < 0 ? -1 : take_image(reading, use.image), use.sampling};
}

Material make_material(Reading& reading, int index) {
  Material out;
  const tinygltf::Material& source = reading.document.model.materials[static_cast<std::size_t>(index)];
  const tinygltf::PbrMetallicRoughness& pbr = source.pbrMetallicRoughness;
  const gltf::MaterialUse use = gltf::read_material_use(reading.document, index, &reading.scene.left_out);
  const auto unit = [](double v) { return static_cast<float>(v >= 0.0 ? std::min(v, 1.0) : 0.0); };
  if (pbr.baseColorFactor.size() == 4) {
    for (int i = 0; i < 3; ++i) out.base_color[i] = unit(pbr.baseColorFactor[static_cast<std::size_t>(i)]);
    // Alpha counts only where the material asks for blending, as glTF has it.
    if (use.blended) out.opacity = unit(pbr.baseColorFactor[3]);
  }
  out.metallic = unit(pbr.metallicFactor);
  out.roughness = unit(pbr.roughnessFactor);
  out.emissive = glm::vec3(use.emission);
  out.maps.base_color = take_map(reading, use.base_color);
  out.maps.metallic_roughness = take_map(reading, use.metallic_roughness);
  out.maps.normal = take_map(reading, use.normal);
  out.maps.occlusion = take_map(reading, use.occlusion);
  out.maps.emissive = take_map(reading, use.emissive);
  out.maps.normal_scale = static_cast<float>(use.normal.factor);
  out.maps.occlusion_strength = unit(use.occlusion.factor);
  if (out.maps.base_color.image >= 0) {
    if (use.mask) out.alpha_cutoff = unit(*use.mask);
    // A label, a leaf: what is blended by its texture alone is cut out. Glass has its alpha in the number.
    if (use.blended && out.opacity >= 1.0f) out.alpha_cutoff = 0.5f;
  }
  return out;
}

}  // namespace

Material read_material(Reading& reading, int mesh) {
  const int index = gltf::material_of(reading.document, mesh);
  if (index < 0) return {};
  if (const auto known = reading.materials.find(index); known != reading.materials.end())
    return known->second;
  return reading.materials[index] = make_material(reading, index);
}

}  // namespace slosh::reading
