// When each pass of a sub-step ended, by the GPU's own clock, without waiting for it: the times are those of
// the last sub-step that is known to be over, the one before.
#pragma once

#include <array>

#include "sim/cuda/device_buffer.h"
#include "sim/world.h"

namespace slosh::cuda {

class PassClock {
 public:
  PassClock() = default;
  ~PassClock() {
    for (SubStepEvents& set : sets_) {
      for (cudaEvent_t event : set.events) {
        if (event) cudaEventDestroy(event);
      }
    }
  }
  PassClock(const PassClock&) = delete;
  PassClock& operator=(const PassClock&) = delete;

  void start(CallCheck& check) {
    for (SubStepEvents& set : sets_) {
      for (cudaEvent_t& event : set.events) check.ok(cudaEventCreate(&event), "cudaEventCreate");
    }
  }
  /// A sub-step begins.
  void begin(CallCheck& check, cudaStream_t stream) {
    current_ = 1 - current_;
    sets_[current_].count = 0;
    record(check, stream);
  }
  /// What was given to the stream since the call before belongs to pass `id`.
  void ended(PassId id, CallCheck& check, cudaStream_t stream) {
    SubStepEvents& set = sets_[current_];
    if (set.count == set.events.size()) return;
    set.of[set.count] = id;
    record(check, stream);
  }
  /// When all of the sub-step before the one that begin() told of is over; this one may still be under way.
  void read(CallCheck& check) {
    const SubStepEvents& set = sets_[1 - current_];
    times_ = StepTimes{};
    for (std::size_t i = 1; i < set.count && !check.failed(); ++i) {
      float ms = 0.0f;
      check.ok(cudaEventElapsedTime(&ms, set.events[i - 1], set.events[i]), "cudaEventElapsedTime");
      times_[set.of[i]] += 1e-3 * ms;
    }
  }
  const StepTimes& times() const { return times_; }

 private:
  /// A pass may end in parts, so that there are some more than passes.
  struct SubStepEvents {
    std::array<cudaEvent_t, kPassCount + 4> events{};
    std::array<PassId, kPassCount + 4> of{};
    std::size_t count = 0;
  };
  void record(CallCheck& check, cudaStream_t stream) {
    SubStepEvents& set = sets_[current_];
    if (!check.failed()) check.ok(cudaEventRecord(set.events[set.count], stream), "cudaEventRecord");
    set.count += 1;
  }

  std::array<SubStepEvents, 2> sets_;
  std::size_t current_ = 0;
  StepTimes times_;
};

}  // namespace slosh::cuda
