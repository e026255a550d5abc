#include "tests/lab/picture/reference/ray_texture.h"

#include <array>
#include <cmath>

#include "render/shader_math.h"

namespace slosh::reference {
namespace {

std::array<float, 256> srgb_table() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const float v = static_cast<float>(i) / 255.0f;
    table[i] = v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
  }
  return table;
}

}  // namespace

RayTexture::RayTexture(const TextureImage& image)
    : width_(image.width),
      height_(image.height),
      srgb_(image.srgb),
      sampling_(image.sampling),
      rgba_(image.rgba.begin(), image.rgba.end()) {}

glm::vec4 RayTexture::texel(long x, long y) const {
  static const std::array<float, 256> linear = srgb_table();
  const auto column = static_cast<std::size_t>(wrapped_texel(x, width_, sampling_.wrap_u));
  const auto row = static_cast<std::size_t>(wrapped_texel(y, height_, sampling_.wrap_v));
  const std::uint8_t* c = rgba_.data() + 4 * (row * static_cast<std::size_t>(width_) + column);
  if (srgb_) return {linear[c[0]], linear[c[1]], linear[c[2]], c[3] / 255.0f};
  return glm::vec4(c[0], c[1], c[2], c[3]) / 255.0f;
}

glm::vec4 RayTexture::at(const glm::vec2& texcoord) const {
  const glm::vec2 place = texcoord * glm::vec2(width_, height_);
  if (sampling_.nearest)
    return texel(static_cast<long>(std::floor(place.x)), static_cast<long>(std::floor(place.y)));
  const glm::vec2 corner = glm::floor(place - 0.5f);
  const glm::vec2 share = place - 0.5f - corner;
  const long x = static_cast<long>(corner.x);
  const long y = static_cast<long>(corner.y);
  return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), share.x),
                  glm::mix(texel(x, y + 1), texel(x + 1, y + 1), share.x), share.y);
}

SurfaceLook look_at(const Hit& hit, const std::vector<RayTexture>& textures) {
  SurfaceLook out{*hit.look, hit.normal};
  const MeshMaps& maps = out.look.maps;
  const auto map = [&](TextureHandle handle) {
    return handle < textures.size() ? &textures[handle] : nullptr;
  };
  if (const RayTexture* base = map(maps.base_color)) {
    const glm::vec4 texel = base->at(hit.texcoord);
    out.look.base_color *= glm::vec3(texel);
    if (out.look.opacity < 1.0f)
      out.look.opacity *= texel.a;
    else
      out.hole = texel.a < out.look.alpha_cutoff;
  }
  if (const RayTexture* both = map(maps.metallic_roughness)) {
    const glm::vec4 texel = both->at(hit.texcoord);
    out.look.metallic *= texel.b;
    out.look.roughness *= texel.g;
  }
  if (const RayTexture* normal = map(maps.normal)) {
    out.normal =
        shader::mapped_normal(hit.normal, hit.edges[0], hit.edges[1], hit.texture_edges[0],
                              hit.texture_edges[1], glm::vec3(normal->at(hit.texcoord)), maps.normal_scale);
  }
  if (const RayTexture* occlusion = map(maps.occlusion))
    out.open = shader::mapped_occlusion(occlusion->at(hit.texcoord).r, maps.occlusion_strength);
  if (const RayTexture* emissive = map(maps.emissive))
    out.look.emissive *= glm::vec3(emissive->at(hit.texcoord));
  return out;
}

}  // namespace slosh::reference
