// What of a picture may differ from the one drawn before it, so that the rest can be kept: a table and a room
// do not change while hands move a bucket over them. Plain maths, no GL.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "render/frame.h"
#include "render/passes/meshes.h"

namespace slosh {

/// Pixels from the bottom left, `high` excluded; empty where it is not above `low`.
struct PixelBox {
  glm::ivec2 low{0};
  glm::ivec2 high{0};

  bool empty() const { return high.x <= low.x || high.y <= low.y; }
  glm::ivec2 size() const { return empty() ? glm::ivec2(0) : high - low; }
  void add(const PixelBox& other);
  /// Grown by so many pixels to each side, within a picture of `size`.
  PixelBox grown(int pixels, glm::ivec2 size) const;
};

class KeptPicture {
 public:
  /// The next picture is drawn whole.
  void forget() { last_.reset(); }

  /// Where `frame`, in its view, may look different from the frame given last: bodies that moved, wetter
  /// or drier parts of them, arrows, fluid and foam (always), each where it was and where it is, and whatever
  /// their shadows may fall on. The whole picture where the eye, the light, the set of bodies or a look
  /// changed, or where it cannot be told. `size`: of the picture. `shadow_texel`: m, of the light's map; 0
  /// without shadows.
  PixelBox changed(const Frame& frame, const MeshStore& meshes, glm::ivec2 size, float shadow_texel);

 private:
  struct Seen {
    View view;
    glm::vec3 light_direction{0.0f};
    std::vector<MeshInstance> meshes;
    glm::ivec2 size{0};
    float shadow_texel = 0.0f;
    PixelBox moving;  ///< fluid, foam and arrows, with their shadows
  };
  std::optional<Seen> last_;
};

}  // namespace slosh
