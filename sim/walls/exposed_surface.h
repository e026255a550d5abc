// What is left of the surface of fixed bodies that touch: they are one solid (joined_walls.h), and a face
// that another body stands on is none of it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenes/scene.h"
#include "sim/math/distance_field.h"
#include "sim/math/pose.h"
#include "sim/walls/point_buckets.h"

namespace slosh {

/// Of a spacing: bodies with a narrower gap between them touch, since no fluid gets into that.
inline constexpr float kTouching = 0.25f;

/// A fixed body that has a distance field.
struct FixedSolid {
  const SurfaceSamples* surface;
  DistanceFieldView field;
  Pose pose;           ///< mesh to world
  float depth = 0.0f;  ///< m, how far behind its surface it presses from
};

/// A sample of a solid's surface, in the world. `hidden`: another body is within kTouching of it.
struct SolidSample {
  glm::vec3 position, normal;
  bool hidden;
};

/// The surface that is left of all solids together, as discs around their samples. World frame.
class ExposedSurface {
 public:
  struct Depth {
    float depth;       ///< m below the surface, negative outside
    glm::vec3 inward;  ///< unit
  };

  /// `spacing`: m, of the fluid.
  explicit ExposedSurface(float spacing) : near_(2.0f * spacing) {}

  /// `apart`: m, from the sample to its neighbours.
  void add(std::size_t solid, const glm::vec3& p, const glm::vec3& normal, float apart);
  /// Of a point within two spacings of the surface; farther inside, infinity.
  Depth depth_at(const glm::vec3& p) const;
  /// Whose a point within two spacings of the surface is: of the solid straight behind whose face it is, and
  /// beyond the edge where two faces meet of the one that it is farther behind. There both are as near, but
  /// for what discs leave uncovered of a face at its edge (0.2 of the way between samples).
  std::size_t solid_at(const glm::vec3& p) const;

 private:
  // How a point lies to the disc around one sample.
  struct Bearing {
    float behind;    // m, behind the plane through it; negative before it
    bool beside;     // is it beside the disc
    glm::vec3 away;  // m, from the nearest point of the disc
  };
  Bearing bearing_of(const glm::vec3& p, const glm::vec3& sample, std::uint32_t number) const;

  PointBuckets near_;
  std::vector<float> radii_;
  std::vector<glm::vec3> normals_;
  std::vector<std::size_t> solids_;
};

/// Solids, and how they touch.
struct TouchingSolids {
  std::vector<std::vector<SolidSample>> samples;  ///< a list a solid
  std::vector<std::vector<std::size_t>> touched;  ///< by each: the solids that it touches
  ExposedSurface surface;
};

/// `spacing`: m, of the fluid.
TouchingSolids touching(std::span<const FixedSolid> solids, float spacing);

/// Whether p, m, is inside one of those solids that `numbers` says, or as near to it as its field may be off:
/// no fluid is there. `spacing`: m, of the fluid.
bool covered(std::span<const FixedSolid> solids, std::span<const std::size_t> numbers, const glm::vec3& p,
             float spacing);

/// From a solid's mesh frame to the world's.
inline glm::vec3 to_world(const Pose& pose, const glm::vec3& p) {
  return glm::vec3(transform_point(pose, glm::dvec3(p)));
}

/// The scene's fixed bodies that have a distance field, and the body that each is. What is sampled must
/// outlive them.
struct FixedSolids {
  std::vector<FixedSolid> solids;
  std::vector<std::size_t> body_of;
};
FixedSolids fixed_solids(const Scene& scene, const SampledScene& sampled);

}  // namespace slosh
