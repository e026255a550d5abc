// What may still come out at a site's hands, for the passivity controllers.
#pragma once

#include <algorithm>
#include <cmath>

#include "peer/replica/passivity_controller.h"

namespace slosh {

/// J: what all persons put in and what acts besides gave the body at the host, less what dampers used up. The
/// persons' own counts are added by who has them.
struct EnergyBalance {
  double stored = 0.0;         ///< in the couplings when this began, less what had been counted by then
  double forgotten = 0.0;      ///< that nothing here holds any more
  double work_received = 0.0;  ///< BodyReplica::work_received() at the tick before
  double lent = 0.0;           ///< that loads took and nobody had put in

  /// Without the persons' counts. `trusted`: BodyReplica::work_trusted().
  double without_persons(double trusted) const noexcept { return stored + trusted - forgotten + lent; }

  /// What was put in and is held nowhere went into dampers: it does not come out again, or a body that
  /// bounces would live for long on what it took to bring it there. `held`: BodyReplica::stored();
  /// `round_trip`: s.
  void forget_surplus(double balance, double held, double round_trip, double dt) noexcept {
    const double surplus = balance - held - kKept;
    if (surplus > 0.0) {
      const double time = std::max(kForgets, kForgetsRoundTrips * round_trip);
      forgotten += surplus * (1.0 - std::exp(-dt / time));
    }
    // Others took what was forgotten too early: no hand is to carry on without force for that.
    const double debt = -balance - PassivityController::kSlack;
    if (debt > 0.0) forgotten -= debt * (1.0 - std::exp(-dt / kForgives));
  }

  /// What the host's step took for the load beyond all that there was it made itself: it carries hands on,
  /// and what it gives their couplings by that nobody put in. No hand is to pay for it; but what comes back
  /// of it is no gift. `balance`: called where it counts.
  template <class Balance>
  void lend(double received, Balance&& balance) noexcept {
    const double gave = received - work_received;
    work_received += gave;
    if (gave > 0.0) lent -= std::min(lent, gave);
    if (gave >= 0.0) return;
    // What was thought used up and was on its way comes first: a load that sank and is lifted again.
    const double short_of = std::clamp(-balance(), 0.0, -gave);
    const double kept = std::clamp(forgotten, 0.0, short_of);
    forgotten -= kept;
    lent += short_of - kept;
  }

  /// By which the balance may be more than the replica holds, and s, or round trips if that is longer, over
  /// which what is beyond is forgotten: dampers used it up. Until then it may be on its way to another hand.
  static constexpr double kKept = 2e-3;
  static constexpr double kForgets = 1.0;
  static constexpr double kForgetsRoundTrips = 4.0;
  static constexpr double kForgives = 1.0;  ///< s, in which a debt that others made is forgiven
};

}  // namespace slosh
