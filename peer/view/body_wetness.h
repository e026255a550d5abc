// Where fluid wets the bodies, and wetted them: what it touched stays dark and glossy until it is dry.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "render/frame.h"
#include "scenes/scene.h"
#include "sim/snapshot.h"

namespace slosh {

/// s of simulated time until what a fluid left is dry.
inline constexpr double kDriesIn = 30.0;

class BodyWetness {
 public:
  /// A grid a body that has an opaque mesh; `spacing` of the particles, m.
  BodyWetness(const Scene& scene, double spacing);

  /// Wets what particles are at, and dries the rest by the time since the snapshot before. All is dry where
  /// time goes back. Of many particles, or bodies, some particles are looked at, the others at the next
  /// ones.
  void record(const Snapshot& snapshot);
  /// Of a body of the scene, nothing of one that is dry; points into this until the next record().
  Wetness of(std::size_t body) const;

 private:
  struct Grid {
    std::size_t body;
    glm::vec3 low;
    float cell;
    glm::ivec3 size;
    std::vector<std::uint8_t> near_face;  // 1: a cell at which a particle touches
    std::vector<std::uint8_t> shares;
    glm::ivec3 wet_low, wet_high;
    std::uint64_t version = 0;
    std::size_t at(const glm::ivec3& c) const {
      return std::size_t(c.x) +
             std::size_t(size.x) * (std::size_t(c.y) + std::size_t(size.y) * std::size_t(c.z));
    }
  };
  void mark_faces(const TriangleMesh& mesh, Grid& grid, double& looked_at) const;
  bool wet(const glm::vec3& at, Grid& grid) const;
  void dry(Grid& grid, int by);
  void forget();

  float spacing_;
  std::vector<Grid> grids_;
  std::uint64_t version_ = 0;  // the last that some grid got
  double time_ = 0.0;
  double dried_ = 0.0;    // s, up to which they are dried
  std::size_t turn_ = 0;  // which particles come next
};

}  // namespace slosh
