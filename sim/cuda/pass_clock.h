// When each pass of a sub-step ended, by the GPU's own clock, without waiting for it: the times are those of
// the last timed sub-step that is known to be over.
#pragma once

#include <array>

#include "sim/cuda/device_buffer.h"
#include "sim/world.h"

namespace slosh::cuda {

class PassClock {
 public:
  PassClock() = default;
  ~PassClock() {
    for (cudaEvent_t event : events_) {
      if (event) cudaEventDestroy(event);
    }
  }
  PassClock(const PassClock&) = delete;
  PassClock& operator=(const PassClock&) = delete;

  void start(CallCheck& check) {
    for (cudaEvent_t& event : events_) check.ok(cudaEventCreate(&event), "cudaEventCreate");
  }
  /// A sub-step begins.
  void begin(CallCheck& check, cudaStream_t stream) {
    timed_ = sub_steps_++ % kEvery == 0;
    if (!timed_) return;
    count_ = 0;
    record(check, stream);
  }
  /// What was given to the stream since the call before belongs to pass `id`.
  void ended(PassId id, CallCheck& check, cudaStream_t stream) {
    if (!timed_ || count_ == events_.size()) return;
    of_[count_] = id;
    record(check, stream);
  }
  /// When all of the sub-step before the one that begin() told of is over; this one may still be under way.
  void read(CallCheck& check) {
    if (timed_ || count_ == 0) return;
    times_ = StepTimes{};
    for (std::size_t i = 1; i < count_ && !check.failed(); ++i) {
      float ms = 0.0f;
      check.ok(cudaEventElapsedTime(&ms, events_[i - 1], events_[i]), "cudaEventElapsedTime");
      times_[of_[i]] += 1e-3 * ms;
    }
    count_ = 0;
  }
  const StepTimes& times() const { return times_; }

 private:
  /// One sub-step of so many is timed: events are 2 % of a step of 33 thousand particles. At least 2.
  static constexpr std::uint64_t kEvery = 8;
  /// A pass may end in parts, so that there are some more than passes.
  static constexpr std::size_t kEvents = kPassCount + 4;

  void record(CallCheck& check, cudaStream_t stream) {
    if (!check.failed()) check.ok(cudaEventRecord(events_[count_], stream), "cudaEventRecord");
    count_ += 1;
  }

  std::array<cudaEvent_t, kEvents> events_{};
  std::array<PassId, kEvents> of_{};
  std::size_t count_ = 0;  // recorded and not read
  bool timed_ = false;     // this sub-step is
  std::uint64_t sub_steps_ = 0;
  StepTimes times_;
};

}  // namespace slosh::cuda
