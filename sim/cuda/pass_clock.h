// When each pass of a step ended, by the GPU's own clock, without waiting for it: the times are those of the
// last step that is known to be over, the one before.
#pragma once

#include <array>

#include "sim/cuda/device_buffer.h"
#include "sim/world.h"

namespace slosh::cuda {

class PassClock {
 public:
  enum Mark { kBegin, kSorted, kDensity, kWrench, kForce, kEnd, kMarks };

  PassClock() = default;
  ~PassClock() {
    for (auto& set : events_) {
      for (cudaEvent_t event : set) {
        if (event) cudaEventDestroy(event);
      }
    }
  }
  PassClock(const PassClock&) = delete;
  PassClock& operator=(const PassClock&) = delete;

  void start(CallCheck& check) {
    for (auto& set : events_) {
      for (cudaEvent_t& event : set) check.ok(cudaEventCreate(&event), "cudaEventCreate");
    }
  }
  /// A step begins.
  void begin(CallCheck& check, cudaStream_t stream) {
    current_ = 1 - current_;
    ++steps_;
    mark(kBegin, check, stream);
  }
  void mark(Mark mark, CallCheck& check, cudaStream_t stream) {
    if (!check.failed()) check.ok(cudaEventRecord(events_[current_][mark], stream), "cudaEventRecord");
  }
  /// When all of the step before the one that begin() told of is over; this one may still be under way.
  void read(CallCheck& check) {
    if (steps_ < 2 || check.failed()) return;
    const auto& set = events_[1 - current_];
    const auto seconds = [&](Mark from, Mark to) {
      float ms = 0.0f;
      check.ok(cudaEventElapsedTime(&ms, set[from], set[to]), "cudaEventElapsedTime");
      return 1e-3 * ms;
    };
    times_.sort = seconds(kBegin, kSorted) + seconds(kForce, kEnd);
    times_.density = seconds(kSorted, kDensity);
    times_.force = seconds(kDensity, kForce);
  }
  const StepTimes& times() const { return times_; }

 private:
  std::array<std::array<cudaEvent_t, kMarks>, 2> events_{};
  int current_ = 0;
  std::uint64_t steps_ = 0;
  StepTimes times_;
};

}  // namespace slosh::cuda
