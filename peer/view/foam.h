// Foam, spray and bubbles where fluid is violent (Ihmsen, Akinci, Akinci & Teschner 2012), for the eye alone:
// made from the particles that a viewer has, on its own machine. Nothing of it goes back to the world.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "peer/view/body_walls.h"
#include "render/frame.h"
#include "scenes/scene.h"
#include "sim/snapshot.h"

namespace slosh {

/// How much a particle is worth of each of the paper's three potentials, 0–1.
struct FoamPotential {
  float trapped_air = 0.0f;  ///< its neighbours come at it (their Eq 2)
  float wave_crest = 0.0f;   ///< it leads where the surface is convex (Eqs 4–7)
  float energy = 0.0f;       ///< of its motion (Eq 8)
};

/// Which fluids foam, and why none does.
struct FoamPlan {
  std::vector<bool> fluids;  ///< one a fluid of the scene
  std::string reason;        ///< in words, for a person
  bool any() const;
};
/// A thin fluid that one can see into foams; what is thick, or hides all that is a centimetre down, does not.
FoamPlan plan_foam(const Scene& scene);

/// On the drawing thread. The same snapshots give the same foam.
class Foam {
 public:
  /// `scene` must outlive it. `spacing` in m.
  Foam(const Scene& scene, double spacing);

  /// A new snapshot. Velocities are ways between two of them, so there is foam from the third on; a world
  /// that started again starts without.
  void record(const Snapshot& snapshot);
  /// Drops of spray, foam and bubbles as they are at the last snapshot: at most kMax.
  std::span<const FoamPoint> points() const { return points_; }
  /// How many particles record() looked around at the last snapshot: at most kMaxLooked, 0 where nothing is
  /// violent.
  std::size_t looked_at() const { return looked_at_; }

  /// Of particle `i` among `positions` with `velocities` (m, m/s, one each). For tests: record() does the
  /// same.
  FoamPotential potential(std::size_t i, std::span<const glm::vec3> positions,
                          std::span<const glm::vec3> velocities);

  static constexpr std::size_t kMax = 4000;
  static constexpr std::size_t kMaxLooked =
      4000;  ///< fluid particles whose neighbours are looked at, a snapshot

 private:
  enum class Kind : std::uint8_t { kSpray, kFoam, kBubble };
  struct Drop {
    glm::vec3 at;
    glm::vec3 velocity;
    float life;  // s
    Kind kind;
  };
  void sort(std::span<const glm::vec3> positions);
  template <class Visit>
  void each_neighbour(const glm::vec3& at, Visit&& visit) const;
  FoamPotential look_around(std::size_t i, std::span<const glm::vec3> positions,
                            std::span<const glm::vec3> velocities) const;
  void move(float passed, std::span<const glm::vec3> positions);
  void make(float passed, std::span<const glm::vec3> positions);
  void show();
  float random();

  const Scene& scene_;
  FoamPlan plan_;
  float spacing_;
  float reach_;
  std::vector<glm::vec3> before_;
  std::vector<glm::vec3> velocities_;
  double time_ = -1.0;
  std::vector<std::uint8_t> foams_;    // a particle each: its fluid does
  std::vector<std::uint32_t> begin_;   // a bucket each, and the end
  std::vector<std::uint32_t> sorted_;  // particles, bucket by bucket
  std::vector<std::uint32_t> fast_;
  std::vector<Drop> drops_;
  std::optional<BodyWalls> walls_;  // made when first something is violent
  std::vector<FoamPoint> points_;
  std::size_t looked_at_ = 0;
  std::uint64_t state_ = 0x853c49e6748fea9bull;
};

}  // namespace slosh
