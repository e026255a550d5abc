// The 1 kHz thread: absolute deadlines around Servo::tick.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <thread>

#include "net/histogram.h"
#include "peer/haptics/servo.h"

namespace slosh {

struct DeviceLoopReport {
  Histogram period;  ///< from wake to wake
  Histogram busy;    ///< from wake to the end of the tick
  std::uint64_t ticks = 0;
  std::uint64_t missed = 0;    ///< deadlines that passed while the loop was not there
  bool real_time = false;      ///< the kernel granted SCHED_FIFO
  bool memory_locked = false;  ///< and that what is mapped stays in memory
  std::string scheduler() const { return real_time ? "SCHED_FIFO" : "SCHED_OTHER"; }
};

/// Runs a servo at 1 kHz. Real-time scheduling and memory that stays are asked for and done without when
/// refused. However the thread ends, its last deed is Servo::let_go().
class DeviceLoop {
 public:
  explicit DeviceLoop(Servo& servo, double period = 0.001);
  ~DeviceLoop();
  DeviceLoop(const DeviceLoop&) = delete;
  DeviceLoop& operator=(const DeviceLoop&) = delete;

  /// Starts the thread and returns after its first tick, when every handle's pose has been posted.
  void start();
  /// Every device was sent zero when it returns. Once; it does not start again.
  void stop();

  double rate() const { return rate_.load(std::memory_order_relaxed); }  ///< Hz, lately; any thread
  const DeviceLoopReport& report() const { return report_; }             ///< after stop()

 private:
  void run();

  Servo& servo_;
  const std::int64_t period_ns_;
  DeviceLoopReport report_;
  std::thread thread_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> primed_{false};
  std::atomic<double> rate_{0.0};
};

}  // namespace slosh
