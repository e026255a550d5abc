// What acts on a held body besides its couplings, by how the host says that it moves, and how far that is to
// be trusted.
#pragma once

#include <algorithm>
#include <vector>

#include "peer/replica/body_replica.h"
#include "peer/replica/carried_fluid.h"
#include "peer/replica/host_update.h"

namespace slosh {

struct LoadEstimator {
  LoadEstimator(const ReplicaBody& body, const std::vector<Pose>& grips, bool follows_slosh_in)
      : follows_slosh(follows_slosh_in), carried(body), on_hands(grips.size()), body_(body), grips_(grips) {}

  void restart() noexcept {
    fluid = FluidLoad{};
    carried.restart();
    looks_for_slosh = false;
    slosh_share = 0.0;
    std::fill(on_hands.begin(), on_hands.end(), Wrench{});
    disturbance = model_uncertainty = quiet_load = 0.0;
  }

  void become(const ReplicaBody& body) noexcept {
    body_ = body;
    carried.become(body);
  }

  /// The update before.
  struct Before {
    bool known = false;
    double time = 0.0;  ///< s of the body's time
    RigidMotion motion;
    bool shared = false;      ///< others hold the body
    double round_trip = 0.0;  ///< s of the body's time
  };
  /// What acts on the body besides couplings and the fluid's answer to its acceleration: fluid, weight,
  /// contacts.
  FluidLoad load_of(const HostUpdate& word, const Before& before) noexcept;
  /// Notes by how much more `load` differs from the one `before` than was told of it. `late`: s of the body's
  /// time of a round trip and what it varies by; `elapsed`: s. Returns how far the load's work is trusted,
  /// 0–1.
  double note_disturbance(const FluidLoad& load, const FluidLoad& before, bool shared, double late,
                          double elapsed) noexcept;

  FluidLoad fluid;  ///< how the fluid answers to the body, as was said last
  bool follows_slosh;
  bool looks_for_slosh = false;  ///< the newest update was felt
  double slosh_share = 0.0;      ///< 0–1: how far what swings is followed at all
  CarriedFluid carried;
  bool tells_fluid = false;        ///< the newest update did
  glm::dvec3 fluid_force{0.0};     ///< N, of the update before
  glm::dvec3 met{0.0};             ///< N: what acts besides couplings and fluid, weight and contacts
  glm::dvec3 met_late{0.0};        ///< N: the same as late as the replica follows it
  std::vector<Wrench> on_hands;    ///< of the update before
  double disturbance = 0.0;        ///< 0–1
  double model_uncertainty = 0.0;  ///< 0–1
  double quiet_load = 0.0;         ///< s since this began or something acted that was not foreseen

  /// s of the body's time between two updates beyond which they say nothing of its acceleration.
  static constexpr double kLongestStep = 0.1;

 private:
  ReplicaBody body_;
  std::vector<Pose> grips_;  // in the mesh frame
};

}  // namespace slosh
