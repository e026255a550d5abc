// What the GPU is told about bodies and probes in a step.
#pragma once

#include <span>
#include <vector>

#include "sim/cuda/device_buffer.h"
#include "sim/cuda/kernels.h"

namespace slosh::cuda {

/// Motions of the bodies, one each.
class SentBodies {
 public:
  void allocate(std::size_t count, CallCheck& check);
  /// As they are. The copy before has been made by now: the engine was waited for since.
  void send(std::span<const RigidBody> bodies, CallCheck& check, cudaStream_t stream);
  /// As they are, with these twists instead.
  void send_twists(std::span<const Twist> twists, CallCheck& check, cudaStream_t stream);

  // On the GPU:
  const DeviceBody* bodies() const { return bodies_.data(); }
  const DeviceBody* twists() const { return twists_.data(); }

 private:
  DeviceBuffer<DeviceBody> bodies_, twists_;
  PinnedBuffer<DeviceBody> sent_bodies_, sent_twists_;
};

/// Probes: particles that their bodies carry.
class SentProbes {
 public:
  void allocate(const std::vector<Probe>& probes, CallCheck& check);
  /// Puts each where its body is.
  void carry(const StepConstants& constants, float rest_volume, const std::vector<Probe>& probes,
             std::span<const RigidBody> bodies, const FluidView& fluid, CallCheck& check,
             cudaStream_t stream);

  /// Where in the order each is; the integration pass keeps it.
  const DeviceBuffer<std::uint32_t>& slots() const { return slots_; }
  void write_slots(std::span<const std::uint32_t> slots, CallCheck& check, cudaStream_t stream) {
    slots_.write(slots, check, stream);
  }

 private:
  DeviceBuffer<DeviceProbe> probes_;
  PinnedBuffer<DeviceProbe> sent_;
  DeviceBuffer<std::uint32_t> slots_;
};

}  // namespace slosh::cuda
