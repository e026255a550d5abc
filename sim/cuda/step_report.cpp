#include "sim/cuda/step_report.h"

namespace slosh::cuda {

namespace {

// The status, in a pack of its own.
struct alignas(16) Head {
  std::uint32_t status = 0;
};

}  // namespace

void StepReport::plan(std::size_t sums, std::size_t impulse_bytes, std::size_t probes, CallCheck& check) {
  check.ok(cudaEventCreateWithFlags(&ready_, cudaEventDisableTiming), "cudaEventCreate");
  wrenches_at_ = sizeof(Head);
  drags_at_ = wrenches_at_ + sums * sizeof(DeviceWrench);
  impulses_at_ = drags_at_ + sums * sizeof(BodyDrag);
  // Whole packs of 16 bytes, as the probes' forces are.
  probes_at_ = (impulses_at_ + impulse_bytes + 15) / 16 * 16;
  device_.allocate(probes_at_ + probes * sizeof(float4), check);
  got_.allocate(device_.size(), check);
}

void StepReport::clear_status(CallCheck& check, cudaStream_t stream) const {
  check.ok(cudaMemsetAsync(device_.data(), 0, sizeof(Head), stream), "clearing the status");
}

void StepReport::fetch(CallCheck& check, cudaStream_t stream) {
  if (check.failed()) return;
  check.ok(cudaMemcpyAsync(got_.data(), device_.data(), device_.bytes(), cudaMemcpyDeviceToHost, stream),
           "fetching the report");
  check.ok(cudaEventRecord(ready_, stream), "cudaEventRecord");
  clear_status(check, stream);
}

}  // namespace slosh::cuda
