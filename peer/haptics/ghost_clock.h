// Whose time a ghost goes by: its own run's, beside the person step by step of the task.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <vector>

namespace slosh {

/// A ghost does a step while its person does, waits at its end until they are through, and begins the next
/// with them.
class GhostClock {
 public:
  /// s of the recorded run at which each step of its task was done, rising; none: it goes by the world's
  /// time.
  explicit GhostClock(std::vector<double> done_at) : done_at_(std::move(done_at)) { begin(0, 0.0); }

  /// The person has done so many steps, at `time`, s. One thread.
  void follow(std::uint32_t done, double time) {
    if (done == done_) return;
    done_ = done;
    begin(done, time);
  }
  /// s of the recorded run when the world is at `time`. Any thread.
  double at(double time) const noexcept { return std::min(time + offset_, end_.load()); }

 private:
  void begin(std::uint32_t done, double time) {
    if (done_at_.empty()) return;
    offset_ = (done == 0 ? 0.0 : done_at_[std::min<std::size_t>(done, done_at_.size()) - 1]) - time;
    end_ = done < done_at_.size() ? done_at_[done] : std::numeric_limits<double>::infinity();
  }

  std::vector<double> done_at_;
  std::uint32_t done_ = 0;
  // A reader between the two sees the ghost leap for a moment, which guidance bears.
  std::atomic<double> offset_{0.0}, end_{std::numeric_limits<double>::infinity()};
};

}  // namespace slosh
