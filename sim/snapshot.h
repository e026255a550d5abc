// What leaves the simulation: an immutable picture of the world at the end of one step.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sim/math/body_cuts.h"
#include "sim/math/pose.h"
#include "sim/math/shared_particles.h"

namespace slosh {

/// What the step had to report. Several may be set; they stay set until read (World::take_status).
enum StatusBit : std::uint32_t {
  kStatusNonFinite = 1u << 0,      ///< a particle or body went non-finite and was put out of the world
  kStatusEscaped = 1u << 1,        ///< particles left the domain and are out of the world
  kStatusSpeedLimited = 1u << 2,   ///< a particle was faster than a support radius a step and was slowed
  kStatusInputRejected = 1u << 3,  ///< a handle's pose was non-finite or out of range and was not used
  kStatusForceLimited = 1u << 4,   ///< a device's force met its limit
  kStatusTimeSlipped = 1u << 5,    ///< the step did not keep real time and the world slowed down
  kStatusCompressed = 1u << 6,     ///< fluid denser than twice rest: crushed, or too soft for its speed
  kStatusDeviceLost =
      1u << 7,  ///< a GPU call failed: the fluid stands still from here on (World::failure says why)
  kStatusClamped = 1u << 8,       ///< particles would have passed a wall and were put back
  kStatusViscosityCut = 1u << 9,  ///< implicit viscosity ended before it was as exact as it should be
  kStatusBodyGone =
      1u << 10,  ///< a free body left the world for good and stands still outside (BodyState::gone)
};

/// The status in words, "; " between, empty when nothing is set.
std::string status_text(std::uint32_t status);

struct BodyState {
  Pose pose;                       ///< of the mesh frame
  Twist twist;                     ///< of the centre of mass, world axes
  glm::dvec3 center_of_mass{0.0};  ///< world
  Wrench fluid;                    ///< on the body by the fluid, about its centre of mass, last step
  bool gone = false;               ///< it left the world for good or is away: no hand can hold it

  bool away() const { return is_away(pose); }  ///< it has still to appear, or was taken away
};

struct GripState {
  Pose pose;       ///< of the grip frame on the body, world
  Twist twist;     ///< of the grip point
  Pose handle;     ///< the pose that the step used
  Wrench on_hand;  ///< reaction that the host computed, on the hand, about the handle
  /// Times the scene's springs that the next step begins with, on its way to what was asked for
  /// (World::set_grip_stiffness); 0 = not told.
  double stiffness = 0.0;
};

struct JointState {
  double position = 0.0;  ///< rad or m from the scene's poses on, whole turns counted
  double speed = 0.0;     ///< rad/s or m/s
  double motor = 0.0;     ///< N·m or N along the axis by the motor on Joint::body, mean over the last step
  Wrench reaction;        ///< likewise, by all of the joint but motor and damper, about the joint, world axes
  bool joined = true;     ///< it holds its two bodies
};

/// Body and grip states: what the 1 kHz loops need, small and often.
struct BodySnapshot {
  std::uint64_t tick = 0;
  double time = 0.0;         ///< s, simulated
  std::uint32_t status = 0;  ///< StatusBit
  std::vector<BodyState> bodies;
  std::vector<GripState> grips;
  std::vector<JointState> joints;  ///< one a joint of the scene
  std::int64_t waiting = 0;        ///< fluid particles out of the world that are neither spilled nor lost
  std::shared_ptr<const BodyCuts> cuts{};  ///< null: every body is whole. Another one after each cut
};

/// Brings particles from a GPU, on the calling thread, which waits: as Snapshot has them.
using ParticleFetch =
    std::function<void(std::span<glm::vec3> positions, std::span<std::uint8_t> fluid_index)>;

/// Everything that is seen: what a viewer needs, at the picture's rate.
struct Snapshot {
  BodySnapshot rigid;
  std::vector<glm::vec3> positions;       ///< fluid particles, in an order that is fixed for the run (by id)
  std::vector<std::uint8_t> fluid_index;  ///< into Scene::fluids; 255 = retired, not to be drawn
  /// 1 = seen from outside (sim/shell.h), one a particle; empty unless the shell was asked for.
  std::vector<std::uint8_t> shell;
  /// Positions and indices once more, in the memory of the GPU that stepped them; null where they are not
  /// shared (World::share_particles), or where all places for that are still looked at.
  std::shared_ptr<const SharedParticles> on_gpu;
  /// What brings positions and indices, `to_come` of them, where World::fill_later() left them on the GPU;
  /// else empty.
  ParticleFetch fetch;
  std::size_t to_come = 0;

  /// Has them brought, where they are not there yet.
  void complete() {
    if (!fetch) return;
    positions.resize(to_come);
    fluid_index.resize(to_come);
    std::exchange(fetch, nullptr)(positions, fluid_index);
    to_come = 0;
  }
};

}  // namespace slosh
