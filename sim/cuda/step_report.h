// What comes back from the GPU each step, in one copy: status, wrenches, drag on free bodies, what walls took
// from particles, forces on probes.
#pragma once

#include <cstring>

#include "sim/cuda/device_buffer.h"
#include "sim/cuda/kernels.h"

namespace slosh::cuda {

class StepReport {
 public:
  StepReport() = default;
  ~StepReport() {
    if (ready_) cudaEventDestroy(ready_);
  }
  StepReport(const StepReport&) = delete;
  StepReport& operator=(const StepReport&) = delete;

  /// `sums`: of WrenchSums; `impulse_bytes`: WallClamps::handed_bytes().
  void plan(std::size_t sums, std::size_t impulse_bytes, std::size_t probes, CallCheck& check);

  // On the GPU:
  std::uint32_t* status() const { return reinterpret_cast<std::uint32_t*>(device_.data()); }
  DeviceWrench* wrenches() const { return reinterpret_cast<DeviceWrench*>(device_.data() + wrenches_at_); }
  BodyDrag* drags() const { return reinterpret_cast<BodyDrag*>(device_.data() + drags_at_); }
  unsigned char* impulses() const { return device_.data() + impulses_at_; }
  float4* probes() const { return reinterpret_cast<float4*>(device_.data() + probes_at_); }

  void clear_status(CallCheck& check, cudaStream_t stream) const;
  /// Begins to copy it to the host; the status begins anew.
  void fetch(CallCheck& check, cudaStream_t stream);
  /// Until what was fetched is there.
  void wait(CallCheck& check) { check.ok(cudaEventSynchronize(ready_), "waiting for the step"); }

  // As fetched:
  std::uint32_t got_status() const { return read_at<std::uint32_t>(got_, 0, 0); }
  DeviceWrench got_wrench(std::size_t sum) const { return read_at<DeviceWrench>(got_, wrenches_at_, sum); }
  BodyDrag got_drag(std::size_t sum) const { return read_at<BodyDrag>(got_, drags_at_, sum); }
  void got_impulses(std::size_t body, std::int64_t (&words)[kImpulseWords]) const {
    std::memcpy(words, got_.data() + impulses_at_ + body * sizeof words, sizeof words);
  }
  float4 got_probe(std::size_t probe) const { return read_at<float4>(got_, probes_at_, probe); }

 private:
  cudaEvent_t ready_ = nullptr;
  DeviceBuffer<unsigned char> device_;
  PinnedBuffer<unsigned char> got_;
  std::size_t wrenches_at_ = 0, drags_at_ = 0, impulses_at_ = 0, probes_at_ = 0;
};

}  // namespace slosh::cuda
