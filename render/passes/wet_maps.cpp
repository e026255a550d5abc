#include "render/passes/wet_maps.h"

#include <algorithm>

namespace slosh {
namespace {

constexpr GLuint kWetUnit = 21;    // mesh.frag
constexpr int kLargestMap = 2048;  // what GL 4.5 promises of each side

bool can_be_drawn(const Wetness& wet) {
  const glm::ivec3& size = wet.size;
  if (wet.version == 0 || glm::any(glm::lessThan(size, glm::ivec3(1))) ||
      glm::any(glm::greaterThan(size, glm::ivec3(kLargestMap))))
    return false;
  return wet.shares.size() >= std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z) &&
         glm::all(glm::lessThan(wet.wet_low, wet.wet_high));
}

}  // namespace

void WetMaps::upload(const Wetness& wet, Map& map) {
  if (map.size != wet.size) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_3D, 1, &name);
    map = {gl::Texture(name), wet.size, 0, {}, {}};
    glTextureStorage3D(name, 1, GL_R8, wet.size.x, wet.size.y, wet.size.z);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
      glTextureParameteri(name, filter, GL_LINEAR);
    for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
      glTextureParameteri(name, wrap, GL_CLAMP_TO_EDGE);
    const std::uint8_t dry = 0;
    glClearTexImage(name, 0, GL_RED, GL_UNSIGNED_BYTE, &dry);
  }
  const glm::ivec3 wet_low = glm::clamp(wet.wet_low, glm::ivec3(0), wet.size);
  const glm::ivec3 wet_high = glm::clamp(wet.wet_high, glm::ivec3(0), wet.size);
  // What was wet and is dry, too.
  const glm::ivec3 low = map.version == 0 ? wet_low : glm::min(wet_low, map.low);
  const glm::ivec3 high = map.version == 0 ? wet_high : glm::max(wet_high, map.high);
  const glm::ivec3 size = high - low;
  const auto first =
      std::size_t(low.x) +
      std::size_t(wet.size.x) * (std::size_t(low.y) + std::size_t(wet.size.y) * std::size_t(low.z));
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, wet.size.x);
  glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, wet.size.y);
  glTextureSubImage3D(map.texture.name(), 0, low.x, low.y, low.z, size.x, size.y, size.z, GL_RED,
                      GL_UNSIGNED_BYTE, wet.shares.data() + first);
  glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 0);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  map.version = wet.version;
  map.low = wet_low;
  map.high = wet_high;
}

void WetMaps::take(const Frame& frame) {
  maps_.resize(frame.meshes.size());
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    const Wetness& wet = frame.meshes[i].wet;
    if (can_be_drawn(wet) && (maps_[i].version != wet.version || maps_[i].size != wet.size))
      upload(wet, maps_[i]);
  }
}

bool WetMaps::has(const Frame& frame, const MeshInstance& instance) const {
  const auto i = static_cast<std::size_t>(&instance - frame.meshes.data());
  return i < maps_.size() && can_be_drawn(instance.wet) && maps_[i].version == instance.wet.version;
}

void WetMaps::bind(const Frame& frame, const MeshInstance& instance, const gl::Program& program) const {
  const Map& map = maps_[static_cast<std::size_t>(&instance - frame.meshes.data())];
  glBindTextureUnit(kWetUnit, map.texture.name());
  const Wetness& wet = instance.wet;
  const glm::vec3 scale = 1.0f / (wet.cell * glm::vec3(wet.size));
  glm::mat4 map_from_mesh(0.0f);
  for (int axis = 0; axis < 3; ++axis) {
    map_from_mesh[axis][axis] = scale[axis];
    map_from_mesh[3][axis] = -wet.low[axis] * scale[axis];
  }
  map_from_mesh[3][3] = 1.0f;
  program.set("wet_from_world", map_from_mesh * glm::inverse(instance.model));
  const glm::vec3 texel = 1.0f / glm::vec3(wet.size);
  program.set("wet_low", (glm::vec3(map.low) - 0.5f) * texel);
  program.set("wet_high", (glm::vec3(map.high) + 0.5f) * texel);
  program.set("wet_off", wet.off);
}

}  // namespace slosh
