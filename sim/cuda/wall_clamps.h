// The bodies that particles are kept from passing (walls/penetration_clamp.h), as the GPU knows them.
#pragma once

#include <span>
#include <vector>

#include "sim/cuda/device_buffer.h"
#include "sim/cuda/kernels.h"

namespace slosh::cuda {

class WallClamps {
 public:
  /// Takes the distance fields over, where the plan has the penetration clamp.
  void plan(const RunConstants& constants, const ParticleStart& start, std::size_t body_count,
            CallCheck& check);
  /// How many bodies; 0: no clamp.
  std::size_t size() const { return clamps_.size(); }

  /// The bodies' ways in this sub-step, to the GPU, unless it has them: bodies that stand still are sent
  /// once. The copy before has been made by now: the engine was waited for since, or the bodies stood still.
  void send(const Plan& plan, std::span<const RigidBody> before, std::span<const RigidBody> after,
            CallCheck& check, cudaStream_t stream);
  ClampView view(const ImpulseUnits& units) const;
  /// Another field of a body, on the grid that it had.
  void reshape(std::size_t body, const DistanceField& field, CallCheck& check, cudaStream_t stream);

  /// What walls took from particles, as ImpulseSums.
  const DeviceBuffer<std::int64_t>& impulses() const { return impulses_; }
  void write(const ImpulseSums& impulses, CallCheck& check, cudaStream_t stream) {
    impulses_.write(impulses, check, stream);
  }
  /// Hands what the bodies have to be given over to `out`, kImpulseWords a body, and begins anew.
  void hand_over(unsigned char* out, CallCheck& check, cudaStream_t stream) const;
  std::size_t handed_bytes() const { return clamps_.size() * kImpulseWords * sizeof(std::int64_t); }

 private:
  /// All of a body that its way depends on.
  struct Place {
    glm::dvec3 position;
    glm::dquat orientation;
    glm::dvec3 velocity, angular_velocity;
    bool operator==(const Place&) const = default;
  };
  bool goes_as_sent(std::span<const RigidBody> before, std::span<const RigidBody> after);

  std::vector<Place> places_;   // before and after, of each
  DeviceBuffer<float> fields_;  // one after the other
  std::vector<ClampSolid> solids_;
  ClampBodies clamped_;
  DeviceBuffer<DeviceClamp> clamps_;
  PinnedBuffer<DeviceClamp> sent_;
  bool any_fast_ = false;
  DeviceBuffer<std::int64_t> impulses_;
};

}  // namespace slosh::cuda
