// Where the light's map lies: over what casts shadows that are seen, and nothing else. Plain maths, no GL.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "render/frame.h"
#include "render/passes/meshes.h"

namespace slosh {

/// A mesh as the light sees it.
struct Caster {
  Bounds box;             ///< in the mesh's own frame
  glm::mat4 model{1.0f};  ///< to the world
  bool convex = false;    ///< casts no shadow on itself
};

struct LightFit {
  glm::mat4 light_from_world{1.0f};  ///< turned so that the light travels down −z
  /// In light axes, m. x and y: what casts a shadow on something and lies in an eye's view. z: everything.
  Bounds box;
  std::vector<bool> casts;  ///< of each mesh: it may cast a shadow on something
};

/// A mesh is no caster where it is convex and all others, and the fluid, lie before a side of its box that
/// faces the light: a table under what stands on it. `fluid`: box in the world, may be empty. `views`: one at
/// least; what lies beyond the first one's far plane is taken to be there. The fit is empty only where there
/// is nothing at all.
LightFit fit_light(std::span<const Caster> meshes, const Bounds& fluid, std::span<const View> views,
                   const glm::vec3& to_light);

/// World to the light's clip space. The box's extent is rounded up and its middle moved by whole texels of a
/// map of `size` texels a side: a body that moves the box must not make the edges crawl.
glm::mat4 light_clip_from_world(const LightFit& fit, int size);

/// The eight corners of a box, one by one.
glm::vec3 box_corner(const Bounds& box, int corner);

}  // namespace slosh
