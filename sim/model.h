// What a particle model is made of: the one place where smoothing kernels and pair rules are chosen.
#pragma once

#include "scenes/scene.h"
#include "sim/passes/pressure_force/pair_force.h"
#include "sim/plan.h"

namespace slosh {

template <ParticleModel model>
struct ModelParts;

template <>
struct ModelParts<ParticleModel::kPaper> {
  using DensityKernel = Poly6;
  using ForceKernel = Spiky;
  static constexpr PairRule kFluids = PairRule::kPaper;
  static constexpr PairRule kWalls = PairRule::kPaper;
  static constexpr PairRule kOnBodies = PairRule::kPaper;  ///< kWalls seen from the body's particle
  static constexpr DragRule kDrag = DragRule::kAlongVelocity;
  static constexpr bool kCorrected = false;  ///< walls count in the density, pressure is a tensor and feels
                                             ///< bulk damping, with artificial viscosity
  static constexpr bool kSolved = false;     ///< by pressure projection
};

template <>
struct ModelParts<ParticleModel::kCorrected> {
  using DensityKernel = Spiky;
  using ForceKernel = Spiky;
  static constexpr PairRule kFluids = PairRule::kCorrected;
  static constexpr PairRule kWalls = PairRule::kCorrectedWall;
  static constexpr PairRule kOnBodies = PairRule::kCorrectedBody;
  static constexpr DragRule kDrag = DragRule::kCentral;
  static constexpr bool kCorrected = true;
  static constexpr bool kSolved = false;
};

template <>
struct ModelParts<ParticleModel::kIncompressible> : ModelParts<ParticleModel::kCorrected> {
  static constexpr PairRule kFluids = PairRule::kSolved;
  static constexpr PairRule kWalls = PairRule::kSolvedWall;
  static constexpr PairRule kOnBodies = PairRule::kSolvedBody;
  static constexpr bool kSolved = true;
};

/// Calls f.template operator()<Parts>() for a model, and returns what it returns.
template <class F>
auto with_model(ParticleModel model, F&& f) {
  if (model == ParticleModel::kPaper) return f.template operator()<ModelParts<ParticleModel::kPaper>>();
  if (model == ParticleModel::kIncompressible)
    return f.template operator()<ModelParts<ParticleModel::kIncompressible>>();
  return f.template operator()<ModelParts<ParticleModel::kCorrected>>();
}

/// Calls f.template operator()<Parts, Viscosity>() for what the plan has: what it does not need is not
/// compiled in.
template <class F>
void with_physics(const Plan& plan, F&& f) {
  with_model(plan.model, [&]<class Parts>() {
    if (!plan.explicit_viscosity()) {
      f.template operator()<Parts, Viscosity::kNone>();
    } else if (plan.has(PassId::kPairViscosity)) {
      f.template operator()<Parts, Viscosity::kPair>();
    } else {
      f.template operator()<Parts, Viscosity::kOne>();
    }
  });
}

}  // namespace slosh
