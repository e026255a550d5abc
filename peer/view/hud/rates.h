// How fast things ran when the world stood at a given time: pictures are drawn later than they were taken.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <mutex>
#include <string>

#include "scenes/task.h"

namespace slosh {

struct Rates {
  double time = 0.0;       ///< simulated s
  double real_time = 0.0;  ///< simulated s a wall s
  double step_rate = 0.0;  ///< Hz
  double step_ms = 0.0;
  double device_rate = 0.0;         ///< Hz
  std::uint32_t device_status = 0;  ///< StatusBits that the device loop ever set
  std::string budgets;              ///< a line for each hand whose device clips; empty where none does
  std::array<std::uint64_t, 32>
      status_steps{};      ///< in how many steps each was set; 0 where that is not known
  std::uint64_t lost = 0;  ///< fluid particles, as Diagnostics::lost where walls hold; local runs say it
  double start = 0.0;      ///< simulated s when this person's run began
  std::string connection;  ///< the network in a few words; empty without one
  std::string people;      ///< who is here, a line each; empty when alone
  TaskLines task;
};

/// Written by the thread that watches the run, read by the one that draws. Neither is the device loop.
class RateLog {
 public:
  void add(const Rates& rates) {
    const std::lock_guard lock(mutex_);
    log_.push_back(rates);
  }
  /// The last entry at or before `time`, else the first; zeros when there is none. Entries before it are
  /// forgotten: ask with rising times.
  Rates at(double time) {
    const std::lock_guard lock(mutex_);
    while (log_.size() > 1 && log_[1].time <= time) log_.pop_front();
    return log_.empty() ? Rates{} : log_.front();
  }

 private:
  std::mutex mutex_;
  std::deque<Rates> log_;
};

}  // namespace slosh
