// What is known of the fluid on a held body from the host's updates: its slosh modes, their weight, what
// lasts.
#pragma once

#include <array>

#include "peer/replica/body_replica.h"
#include "peer/replica/residue_follower.h"
#include "peer/replica/slosh_finder.h"

namespace slosh {

/// What acts on the body besides couplings, over the time between two updates of the host.
struct Acting {
  double elapsed = 0.0;       ///< s; 0: nothing came before, and there is no acceleration
  glm::dvec3 before{0.0};     ///< m/s, of the centre of mass, at the update before
  glm::dvec3 now{0.0};        ///< at this
  glm::dvec3 force{0.0};      ///< N: all that acts, the mean
  bool tells_fluid = false;   ///< the host says what of that is the fluid's:
  glm::dvec3 fluid{0.0};      ///< N, the mean
  glm::dvec3 told_mass{0.0};  ///< kg that go along, by the host's own line; 0: it says nothing …
  glm::dvec3 told_drag{0.0};  ///< … and N·s/m
};

/// Three slosh modes along the world's axes, the bowl in which what swings rises, and how far the replica
/// goes by all that. Where fluid weighs on the body it is in it as in a vessel, and what it weighs says what
/// of it swings and how fast before anything has moved. What is poured out or in changes all masses as it
/// does the weight. Allocates when made; reads no clock; one thread.
class CarriedFluid {
 public:
  explicit CarriedFluid(const ReplicaBody& body) : body_(body) { restart(); }

  void restart() noexcept;
  void become(const ReplicaBody& body) noexcept { body_ = body; }
  void update(const Acting& acting) noexcept;
  /// Puts what swings in the place of the line in `load`, as far as it explains more, times `share` (0–1),
  /// and takes it out of `rest`: the wrench that acts besides couplings, to which the answer to `pace`
  /// (linear and angular acceleration) is added. What no model explains of the fluid is left in it as what is
  /// late, and foreseen for when updates that are `round_trip` s old are felt.
  void put_into(FluidLoad& load, Vector6& rest, const Vector6& pace, const Acting& acting, double share,
                double round_trip) noexcept;

  /// Of the fluid's changes, the share that the replica no longer follows late, as of the last put_into().
  double foreseen() const noexcept { return foreseen_; }
  std::array<SloshState, 3> states() const noexcept {
    return {finders_[0].state(), finders_[1].state(), finders_[2].state()};
  }
  const SloshFinder& finder(std::size_t axis) const noexcept { return finders_[axis]; }

 private:
  /// Sets carried_, and changes the masses that were found with it.
  void weigh(const Acting& acting) noexcept;
  void look_for_vessel(const Acting& acting) noexcept;

  ReplicaBody body_;
  std::array<SloshFinder, 3> finders_;  // along x, y, z
  glm::dvec3 down_{0.0};                // 0 where nothing is carried
  double bowl_ = 0.0;                   // s²/m: 1/g of a whole bowl
  double lifts_ = 0.0;                  // N, down: what swings puts on the body by rising in a whole bowl
  double lifts_share_ = 1.0;            // how far it does, 0–1
  double lifts_square_ = 0.0, lifts_answer_ = 0.0;  // N²·s
  std::array<ResidueFollower, 3> residue_;          // what no model explains, along x, y, z
  glm::dvec3 passing_{0.0};                         // N: of it, what does not last, the bowl not taken off
  glm::dvec3 dragged_{0.0};                         // N: by the damper, of the update before
  double round_trip_ = 0.0;                         // s
  double mass_force_ = 0.0, mass_square_ = 0.0;     // N·m/s², m²/s⁴: means
  double carried_ = 0.0;                            // kg; 0: nothing
  double vessel_ = 0.0;                             // 0–1: something is carried
  double foreseen_ = 0.0;
};

}  // namespace slosh
