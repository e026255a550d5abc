// Guidance of a hand along a recorded one's way: a force with a stated maximum that never gives more energy
// than it took.
#pragma once

#include <memory>
#include <vector>

#include "peer/haptics/ghost_clock.h"
#include "peer/haptics/pose_track.h"
#include "scenes/scene.h"

namespace slosh {

/// Two parts. A damper acts on what of the hand's velocity does not lead to where the recorded hand is: it
/// only takes energy. A spring draws the hand there, but by no more than the damper has taken before (an
/// energy tank, Franken et al. 2011): whoever goes along is not pushed, whoever strays is led back. Counted
/// by the way that the hand went under each tick's force, so that the sum holds whatever its velocity was
/// measured to be. Forces alone: it turns no hand. One thread; no allocation.
class Guidance {
 public:
  static constexpr double kStiffness = 150.0;  ///< N/m
  static constexpr double kDamping = 15.0;     ///< N·s/m
  static constexpr double kMaxStored = 0.3;    ///< J that are kept for the spring

  /// `way`: of the handle, world, at least one key. `most`: N.
  Guidance(const std::vector<PoseKey>& way, double most) : way_(way, way.front().pose), most_(most) {}

  /// N on the hand, world, for the next `dt` s. `time`: s of the recorded run; `most_damping`: N·s/m that the
  /// device holds. Neither allocates nor throws.
  glm::dvec3 force(double time, const glm::dvec3& hand, const glm::dvec3& velocity, double dt,
                   double most_damping) noexcept;
  /// The hand was put elsewhere, or let go: what it did since the last force() counts for nothing.
  void restart() noexcept { last_ = glm::dvec3(0.0); }

  double stored() const { return stored_; }  ///< J
  /// J that it has taken from the hand so far, less what it gave; never far below 0.
  double taken() const { return taken_; }

 private:
  PoseTrack way_;
  double most_;
  double stored_ = 0.0, taken_ = 0.0;
  glm::dvec3 last_{0.0};   // N, of the call before
  glm::dvec3 place_{0.0};  // m, of the hand then
};

/// Which hand is guided, along what, by how much at most (N).
struct GuidedHand {
  std::size_t grip = 0;
  std::vector<PoseKey> way;
  double most = 0.0;
  std::shared_ptr<const GhostClock> clock;  ///< of the ghost; never null
};

}  // namespace slosh
