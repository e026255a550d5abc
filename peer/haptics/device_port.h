// Where a device meets the device loop: called by it directly, or on a thread of the device's own.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "peer/haptics/device.h"

namespace slosh {

/// What a device said, and when.
struct DeviceReading {
  DeviceReport report;
  std::uint64_t number = 0;  ///< rises by one with each; 0 = none yet
  std::int64_t stamp_ns =
      0;              ///< when it was read: the loop's clock, or the steady one on a thread of its own
  double time = 0.0;  ///< simulated s that it belongs to
};

/// Owns an open device with sound limits. An immediate one is read and written by whoever calls, which is the
/// device loop. Any other has a thread, which reads it just before the loop's tick and writes just after that
/// what the loop makes of it, or goes at the pace at which its read() returns, a reading and the newest
/// wrench in turn; newest readings and wrenches are exchanged without a lock, so that a device that does not
/// answer is late alone. The thread writes a wrench that the loop has not renewed only as long as freshness()
/// has it, never changes it faster than the device's limits, and writes zero last.
class DevicePort {
 public:
  explicit DevicePort(std::unique_ptr<Device> device);
  /// As stop().
  ~DevicePort();
  DevicePort(const DevicePort&) = delete;
  DevicePort& operator=(const DevicePort&) = delete;

  /// The newest reading; valid until the next call. `now_ns` is the loop's clock. Loop only.
  const DeviceReading& read(const DeviceMoment& moment, std::int64_t now_ns) noexcept;
  /// Loop only; after read().
  void write(const Wrench& on_hand) noexcept;
  /// For good: what is written after this is passed over. A device with a thread gets it from there, as soon
  /// as it answers. Loop only, or whoever owns the port when the loop is over.
  void write_zero() noexcept;

  /// A wrench of zero, the last thing that the device is sent. Returns when it was, or after kStopWait for a
  /// device that does not answer: its thread then writes zero, closes and frees it when it comes back, if
  /// ever. By the thread that owns the port, once the loop has released it.
  void stop() noexcept;

  /// The share (0–1) of its wrench that the device had left when it was written to last: less than 1 after
  /// the loop stood still, and the last write() counts by that share. 1 without a thread of its own, where
  /// nobody takes it away. Loop only.
  double left() const noexcept { return left_; }

  const Device& device() const { return *device_; }
  /// As Device::look_from; by the thread that owns the port.
  void look_from(const glm::dquat& axes) { device_->look_from(axes); }
  const DeviceLimits& limits() const { return limits_; }
  /// What the device threw: it is out of use. Else what it says itself that keeps it from working
  /// (Device::trouble). Empty while it works. Any thread.
  std::string failure() const;

  static constexpr double kStopWait = 0.5;  // s

 private:
  struct Own;  // what the device's thread shares with the port
  static void run(const std::shared_ptr<Own>& own);
  template <class Do>
  void guarded(Do&& act) noexcept;

  std::shared_ptr<Device> device_;
  DeviceLimits limits_;
  std::shared_ptr<Own> own_;  // null for an immediate device
  std::thread thread_;
  DeviceReading reading_;  // of an immediate device
  std::string failure_;    // the same; written once, before failed_
  std::atomic<bool> failed_{false};
  bool stopped_ = false;
  std::int64_t written_ns_ = 0;  // by the loop, for a device with a thread
  double left_ = 1.0;
};

}  // namespace slosh
