// The variants of the force passes, as template arguments: what a plan does not need is not compiled in.
#pragma once

#include "sim/plan.h"

namespace slosh {

/// kPair: both sides have their own viscosity (Eq 9). kOne: all share p's (Eq 6). kNone: pressure only (Eq
/// 5).
enum class Viscosity { kNone, kOne, kPair };

/// Calls f.template operator()<consistent, Viscosity>() for what the plan has.
template <class F>
void with_physics(const Plan& plan, bool one_viscosity, F&& f) {
  const auto with_model = [&]<Viscosity viscosity>() {
    if (plan.model == ParticleModel::kPaper) {
      f.template operator()<false, viscosity>();
    } else {
      f.template operator()<true, viscosity>();
    }
  };
  if (!plan.viscosity) {
    with_model.template operator()<Viscosity::kNone>();
  } else if (one_viscosity) {
    with_model.template operator()<Viscosity::kOne>();
  } else {
    with_model.template operator()<Viscosity::kPair>();
  }
}

}  // namespace slosh
