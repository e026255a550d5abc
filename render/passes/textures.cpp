#include "render/passes/textures.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace slosh {
namespace {

constexpr int kLargest = 16384;    // what GL 4.5 promises
constexpr GLuint kFirstUnit = 16;  // material_maps.glsl
constexpr float kSlant = 8.0f;     // anisotropic samples

GLenum wrap(TextureWrap wrap) {
  return wrap == TextureWrap::kClamp    ? GL_CLAMP_TO_EDGE
         : wrap == TextureWrap::kMirror ? GL_MIRRORED_REPEAT
                                        : GL_REPEAT;
}

GLenum shrink(TextureShrink shrink) {
  constexpr GLenum kFilters[] = {GL_NEAREST,
                                 GL_LINEAR,
                                 GL_NEAREST_MIPMAP_NEAREST,
                                 GL_LINEAR_MIPMAP_NEAREST,
                                 GL_NEAREST_MIPMAP_LINEAR,
                                 GL_LINEAR_MIPMAP_LINEAR};
  return kFilters[static_cast<std::size_t>(shrink)];
}

struct Slot {
  unsigned bit;
  TextureHandle MeshMaps::* map;
};
constexpr Slot kSlots[] = {{kBaseMap, &MeshMaps::base_color},
                           {kMetalRoughMap, &MeshMaps::metallic_roughness},
                           {kNormalMap, &MeshMaps::normal},
                           {kOcclusionMap, &MeshMaps::occlusion},
                           {kEmissiveMap, &MeshMaps::emissive}};

}  // namespace

TextureHandle TextureStore::add(const TextureImage& image) {
  if (image.width < 1 || image.height < 1 || image.width > kLargest || image.height > kLargest ||
      image.rgba.size() <
          std::size_t{4} * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
    return kNoTexture;
  const bool levels = image.sampling.shrink > TextureShrink::kLinear;
  const auto side = static_cast<unsigned>(std::max(image.width, image.height));
  const GLsizei count = levels ? static_cast<GLsizei>(std::bit_width(side)) : 1;
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  gl::Texture texture(name);
  glTextureStorage2D(name, count, image.srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8, image.width, image.height);
  // The first row is glTF's v = 0 and stays so: a texture coordinate is one of ours as it is.
  glTextureSubImage2D(name, 0, 0, 0, image.width, image.height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  if (levels) glGenerateTextureMipmap(name);
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, static_cast<GLint>(wrap(image.sampling.wrap_u)));
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, static_cast<GLint>(wrap(image.sampling.wrap_v)));
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(shrink(image.sampling.shrink)));
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, image.sampling.nearest ? GL_NEAREST : GL_LINEAR);
  // llvmpipe's way of it (Mesa 22.3) is slow, and blurs what is magnified.
  if (by_gpu_ && image.sampling.shrink == TextureShrink::kLinearMipLinear &&
      (epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic") ||
       epoxy_has_gl_extension("GL_ARB_texture_filter_anisotropic"))) {
    float most = 1.0f;
    glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &most);
    glTextureParameterf(name, GL_TEXTURE_MAX_ANISOTROPY_EXT, std::min(most, kSlant));
  }
  textures_.push_back(std::move(texture));
  return static_cast<TextureHandle>(textures_.size() - 1);
}

unsigned map_bits(const MeshLook& look, const TextureStore& textures) {
  unsigned bits = 0;
  for (const Slot& slot : kSlots)
    if (textures.has(look.maps.*slot.map)) bits |= slot.bit;
  if (look.emissive != glm::vec3(0.0f))
    bits |= kEmits;
  else
    bits &= ~unsigned{kEmissiveMap};
  if (look.alpha_cutoff > 0.0f && (bits & kBaseMap)) bits |= kHoles;
  return bits;
}

std::vector<std::string> map_defines(unsigned bits) {
  std::vector<std::string> defines;
  if (bits & (kBaseMap | kMetalRoughMap | kNormalMap | kOcclusionMap | kEmissiveMap))
    defines.emplace_back("TEXTURED");
  constexpr const char* kNames[] = {"BASE_MAP",     "METAL_ROUGH_MAP", "NORMAL_MAP", "OCCLUSION_MAP",
                                    "EMISSIVE_MAP", "EMITS",           "HOLES",      "WET"};
  for (unsigned i = 0; i < std::size(kNames); ++i)
    if (bits & (1u << i)) defines.emplace_back(kNames[i]);
  return defines;
}

void bind_maps(const MeshMaps& maps, unsigned bits, const TextureStore& textures) {
  GLuint unit = kFirstUnit;
  for (const Slot& slot : kSlots) {
    if (bits & slot.bit) glBindTextureUnit(unit, textures.name(maps.*slot.map));
    ++unit;
  }
}

}  // namespace slosh
