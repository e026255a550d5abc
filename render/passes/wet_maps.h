// Where bodies are wet, as textures that mesh.frag reads.
#pragma once

#include <cstdint>
#include <vector>

#include "render/frame.h"
#include "render/gl/objects.h"

namespace slosh {

class WetMaps {
 public:
  /// Brings what changed of a frame's instances to the GPU.
  void take(const Frame& frame);
  /// Whether this one of the frame taken is wet somewhere.
  bool has(const Frame& frame, const MeshInstance& instance) const;
  /// Binds its map and sets what mesh.frag (WET) reads beside it. Only where has().
  void bind(const Frame& frame, const MeshInstance& instance, const gl::Program& program) const;

 private:
  struct Map {
    gl::Texture texture;
    glm::ivec3 size{0};
    std::uint64_t version = 0;
    glm::ivec3 low{0};  ///< cells that may not be 0, `high` excluded
    glm::ivec3 high{0};
  };
  static void upload(const Wetness& wet, Map& map);

  std::vector<Map> maps_;  // one an instance
};

}  // namespace slosh
