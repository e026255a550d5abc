// A world's dynamic state as bytes, and back with every value checked.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/bodies/blades.h"
#include "sim/bodies/contact_memory.h"
#include "sim/bodies/hands.h"
#include "sim/bodies/joints.h"
#include "sim/bodies/rigid_body.h"
#include "sim/columns.h"
#include "sim/math/result.h"
#include "sim/passes/bonds/bonds.h"
#include "sim/run_constants.h"
#include "sim/world.h"

namespace slosh {

/// What stays the same for a run and must match for a state to fit.
struct StateFrame {
  std::uint64_t fluid_particles = 0;
  std::uint64_t probes = 0;
  std::uint64_t body_particles = 0;
  std::uint64_t bodies = 0;
  std::uint64_t grips = 0;
  std::uint64_t fluids = 0;
  std::uint64_t joints = 0;
  double spacing = 0.0;    ///< m
  double time_step = 0.0;  ///< s
  double stiffness = 0.0;  ///< m²/s²
  std::uint64_t scene =
      0;        ///< fingerprint of masses, grips, joints, keys, gravity, domain, fluids, materials
  bool cuts{};  ///< some body may be cut
};

StateFrame state_frame(const Scene& scene, const Plan& plan, const ParticleStart& start);

struct SavedState {
  std::uint64_t tick = 0;
  std::uint32_t status = 0;
  double gravity_scale = 1.0;
  std::int64_t waiting = 0;  ///< particles out of the world that are neither spilled nor lost
  double age = 0.0;          ///< s since the start, settling counted (passes/rest_density/rest_density.h)
  std::vector<double> viscosities;              ///< Pa·s, one a fluid
  std::vector<RigidBody> bodies;                ///< only what moves is read back
  std::vector<std::vector<CutPlane>> planes{};  ///< of bodies that may be cut, one a body; else empty
  std::vector<Incision> incisions{};            ///< blades on their way
  std::vector<Wrench> wrenches;                 ///< by the fluid, one a body
  std::vector<GripState> grips;                 ///< handle and on_hand
  std::vector<HandleInput> last_input;          ///< one a grip
  Hands::Stiffness grip_stiffness;              ///< one a grip
  std::vector<KeptImpulse> impulses;            ///< of contacts, pair by pair
  std::vector<KeptJoint> joints;                ///< one a joint
  std::vector<JointState> joint_means;          ///< one a joint: motor and reaction
  ImpulseSums walls;        ///< what bodies have still to be given (walls/clamp_impulse.h)
  BondTable bonds;          ///< kBonds; else empty
  ParticleState particles;  ///< in the order that the engine has them: sums over neighbours depend on it
};

constexpr std::uint64_t kMaxTicks = std::uint64_t{1} << 48;

/// Appends to `out`.
void write_state(const StateFrame& frame, const RunConstants& constants, const SavedState& state,
                 std::vector<std::uint8_t>& out);

/// `state` comes with the bodies as the world has them now; fixed ones and constants are left as they are.
/// Errors: not such bytes, cut off, of another scene, spacing or version, a value that cannot be.
Result<bool> read_state(std::span<const std::uint8_t> bytes, const StateFrame& frame,
                        const RunConstants& constants, SavedState& state);

}  // namespace slosh
