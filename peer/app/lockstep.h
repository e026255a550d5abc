// The devices of a run that is not paced: read and written once a step, on the host's thread.
#pragma once

#include <atomic>
#include <chrono>
#include <thread>

#include "host/tap.h"
#include "net/snapshot_queue.h"
#include "peer/haptics/servo.h"

namespace slosh {

/// In place of a DeviceLoop. The host's clock is simulated then (HostOptions::paced), so a run is the same
/// again, bitwise identical, whatever the machine does. Waits for who draws, so that no snapshot is lost.
class Lockstep final : public HostTap {
 public:
  /// Both must outlive it.
  Lockstep(Servo& servo, Channel& channel) : servo_(servo), channel_(channel) {}

  /// Bodies are in the channel: the hands answer before the next step.
  void after_publish() override {
    servo_.tick_in_lockstep();
    while (channel_.snapshots().waiting() >= kSnapshotsAhead && !stop_.load(std::memory_order_relaxed))
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  /// Any thread: nobody is waited for any more.
  void request_stop() { stop_.store(true, std::memory_order_relaxed); }

 private:
  static constexpr std::size_t kSnapshotsAhead = 30;

  Servo& servo_;
  Channel& channel_;
  std::atomic<bool> stop_{false};
};

}  // namespace slosh
