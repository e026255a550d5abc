// One period of the device loop, for all devices: read, couple, limit, write, post. Reads no clock.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include "net/channel.h"
#include "net/engagement.h"
#include "net/ring.h"
#include "peer/haptics/device.h"
#include "peer/haptics/force_limiter.h"
#include "scenes/scene.h"
#include "sim/math/coupling.h"

namespace slosh {

/// What was felt at one moment.
struct ServoSample {
  double time = 0.0;  ///< simulated s; goes on across a reset of the world, see Servo
  std::uint32_t device = 0;
  Wrench on_hand;  ///< as sent to the device; torque about the handle, world axes
  Pose handle;     ///< world
};

struct ServoOptions {
  double period = 0.001;           ///< s between ticks, nominal
  double sample_interval = 0.002;  ///< simulated s between recorded samples, > 0
  std::size_t sample_capacity = 1 << 15;
};

/// How long a body state that no longer comes is believed, s: then the force fades out over kFadeStale. Who
/// was not believed for a moment takes hold anew with the next state (net/engagement.h).
constexpr double kHoldStale = kHoldAnew;
constexpr double kFadeStale = 0.3;

/// Share of the coupling that is felt when the newest body state is `age` s old and one comes every
/// `interval` s.
double freshness(double age, double interval);

/// tick() belongs to the device loop's thread and neither allocates, locks nor logs. samples() has one
/// reader. set_device() and what asks about devices belong to one other thread.
///
/// A rising BodyMessage::run means that the world was reset: simulated time starts anew for the devices, and
/// couplings are let in as if every hand had just taken hold. The time of samples goes on instead, so that
/// files and plots of a run never step back.
class Servo {
 public:
  /// The channel must outlive the servo. One device a grip; null where the hand is not ours: then its pose in
  /// the channel is left alone.
  Servo(const Scene& scene, std::vector<std::unique_ptr<Device>> devices, Channel& channel,
        ServoOptions options);

  void tick(std::int64_t now_ns) noexcept;

  /// Hands `device`, already open, to grip `i` from the next tick on; null takes away what is there. What was
  /// there is closed and freed as soon as the loop has let go of it: at a later call, or at the end.
  void set_device(std::size_t i, std::unique_ptr<Device> device);

  std::size_t devices() const { return hands_.size(); }  ///< grips, whoever holds them
  /// The grip's device, or the last one that it had; null when there never was one.
  const Device* device(std::size_t i) const {
    return hands_[i].owned.empty() ? nullptr : hands_[i].owned.back().get();
  }
  bool holds(std::size_t i) const { return hands_[i].wanted.load(std::memory_order_relaxed) != nullptr; }
  bool holds_any() const;
  /// After the device loop has stopped; may be called again.
  void close_devices();
  Ring<ServoSample>& samples() { return samples_; }  ///< device loop → recorder
  std::uint64_t samples_lost() const { return lost_.load(std::memory_order_relaxed); }
  std::uint64_t reports_rejected() const { return rejected_.load(std::memory_order_relaxed); }
  /// StatusBits that were ever set here.
  std::uint32_t status() const { return status_.load(std::memory_order_relaxed); }
  double time() const { return shown_time_.load(std::memory_order_relaxed); }  ///< simulated s

 private:
  struct Hand {
    Hand(const CouplingGains& g, const Pose& s) : gains(g), start(s) {}
    // Between the threads: what the loop shall use, is about to use, and uses.
    std::atomic<Device*> wanted{nullptr};
    std::atomic<Device*> claimed{nullptr};
    std::atomic<Device*> in_use{nullptr};
    std::vector<std::unique_ptr<Device>> owned;  // the newest last; the control thread's

    // The loop's.
    Device* device = nullptr;
    CouplingGains gains;
    Pose start;
    ForceLimiter limiter{DeviceLimits{}};
    Engagement engagement;
    DeviceReport good;
  };
  /// The device that is wanted, safe from being freed.
  Device* claim_device(Hand& hand) noexcept;
  void change_device(Hand& hand, Device* device) noexcept;
  void free_unused(Hand& hand);
  void follow_run(const BodyMessage& message) noexcept;
  double freshness_now(const BodyMessage& message, double age) noexcept;
  void note(std::uint32_t bits) { status_.fetch_or(bits, std::memory_order_relaxed); }

  Channel& channel_;
  ServoOptions options_;
  std::deque<Hand> hands_;  // a hand never moves: the loop and the control thread share it
  std::uint32_t run_ = 0;
  double time_ = 0.0;
  double sample_offset_ = 0.0;  // s that samples' time is ahead of the world's, after resets
  double fresh_ = 1.0;
  bool hold_anew_ = false;  // states had stopped
  double next_sample_ = 0.0;
  Ring<ServoSample> samples_;
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<std::uint64_t> rejected_{0};
  std::atomic<std::uint32_t> status_{0};
  std::atomic<double> shown_time_{0.0};
};

}  // namespace slosh
