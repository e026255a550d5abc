// Textures of bodies kept on the GPU.
#pragma once

#include <vector>

#include "render/frame.h"
#include "render/gl/objects.h"

namespace slosh {

class TextureStore {
 public:
  /// `by_gpu`: what is seen at a slant is sampled along it.
  explicit TextureStore(bool by_gpu) : by_gpu_(by_gpu) {}

  /// With mipmaps where the sampling asks for them; sRGB is decoded before anything is averaged.
  TextureHandle add(const TextureImage& image);
  bool has(TextureHandle handle) const { return handle < textures_.size(); }
  GLuint name(TextureHandle handle) const { return textures_[handle].name(); }

 private:
  bool by_gpu_;
  std::vector<gl::Texture> textures_;
};

/// Which maps of a look there are: bits, the shaders' defines, and the units they are bound to.
enum MapBits : unsigned {
  kBaseMap = 1,
  kMetalRoughMap = 2,
  kNormalMap = 4,
  kOcclusionMap = 8,
  kEmissiveMap = 16,
  kEmits = 32,  ///< light of its own, with or without a map
  kHoles = 64,
  kWet = 128,  ///< the instance's (wet_maps.h)
};
unsigned map_bits(const MeshLook& look, const TextureStore& textures);
std::vector<std::string> map_defines(unsigned bits);
/// Binds what `bits` names.
void bind_maps(const MeshMaps& maps, unsigned bits, const TextureStore& textures);

}  // namespace slosh
