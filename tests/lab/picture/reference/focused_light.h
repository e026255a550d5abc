// Light that the fluids' surfaces gather on bodies: photons, sent from the light (Jensen 1996). Plain maths
// over RayScene.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <unordered_map>
#include <vector>

#include "tests/lab/picture/reference/ray_scene.h"
#include "tests/lab/picture/reference/ray_texture.h"

namespace slosh::reference {

/// A box along the world's axes, m.
struct Bounds {
  glm::vec3 low{1.0f}, high{-1.0f};
  bool empty() const { return high.x < low.x; }
  void add(const glm::vec3& point);
};

/// The key light's irradiance that reaches bodies by way of a fluid's surface, mirrored there or refracted,
/// once or more often.
class FocusedLight {
 public:
  struct Source {
    glm::vec3 to_light{0.0f, 1.0f, 0.0f};  ///< unit
    Bounds fluids;                         ///< what photons are sent through
    int photons = 0;                       ///< rounded to a square; > 0
    int threads = 1;                       ///< >= 1
    /// Share of the light that arrives at a point just outside `fluids`, towards the light.
    std::function<glm::vec3(const glm::vec3&)> arriving;
  };

  /// Nothing.
  FocusedLight() = default;
  /// `looks`: of the scene's fluids, by Hit::fluid. The same photons again for the same source.
  FocusedLight(const RayScene& scene, std::span<const FluidLook> looks,
               const std::vector<RayTexture>& textures, const Source& source);

  bool empty() const { return photons_.empty(); }
  /// Over the light's irradiance on what faces it, at a point of a body with that unit normal: a mean over
  /// radius(), which is dark within as much of an edge.
  glm::vec3 at(const glm::vec3& point, const glm::vec3& normal) const;
  /// m: some fifty photons of unfocused light are within it.
  float radius() const { return radius_; }

 private:
  struct Photon {
    glm::vec3 at, normal, flux;  // m²: of what faces the light
  };
  struct CellHash {
    std::size_t operator()(const glm::ivec3& c) const {
      return static_cast<std::size_t>(c.x) * 73856093u ^ static_cast<std::size_t>(c.y) * 19349663u ^
             static_cast<std::size_t>(c.z) * 83492791u;
    }
  };
  glm::ivec3 cell(const glm::vec3& p) const { return glm::ivec3(glm::floor(p / radius_)); }

  float radius_ = 0.0f;
  std::vector<Photon> photons_;
  std::unordered_map<glm::ivec3, std::vector<std::uint32_t>, CellHash> cells_;
};

}  // namespace slosh::reference
