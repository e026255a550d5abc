// One period of the device loop, for all devices: read, couple, limit, write, post. Reads no clock.
#pragma once

#include <atomic>
#include <cstdint>
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
  double time = 0.0;  ///< simulated s
  std::uint32_t device = 0;
  Wrench on_hand;  ///< as sent to the device; torque about the handle, world axes
  Pose handle;     ///< world
};

struct ServoOptions {
  double period = 0.001;           ///< s between ticks, nominal
  double sample_interval = 0.002;  ///< simulated s between recorded samples, > 0
  std::size_t sample_capacity = 1 << 15;
};

/// How long a body state that no longer comes is believed, s: then the force fades out over kFade.
constexpr double kHoldStale = 0.1;
constexpr double kFadeStale = 0.3;

/// Share of the coupling that is felt when the newest body state is `age` s old and one comes every
/// `interval` s.
double freshness(double age, double interval);

/// tick() belongs to the device loop's thread and neither allocates, locks nor logs. samples() has one
/// reader.
class Servo {
 public:
  /// The channel must outlive the servo. One device a grip.
  Servo(const Scene& scene, std::vector<std::unique_ptr<Device>> devices, Channel& channel,
        ServoOptions options);

  void tick(std::int64_t now_ns) noexcept;

  std::size_t devices() const { return hands_.size(); }
  const Device& device(std::size_t i) const { return *hands_[i].device; }
  /// After the device loop has stopped; may be called again.
  void close_devices() {
    for (Hand& hand : hands_) hand.device->close();
  }
  Ring<ServoSample>& samples() { return samples_; }  ///< device loop → recorder
  std::uint64_t samples_lost() const { return lost_.load(std::memory_order_relaxed); }
  std::uint64_t reports_rejected() const { return rejected_.load(std::memory_order_relaxed); }
  /// StatusBits that were ever set here.
  std::uint32_t status() const { return status_.load(std::memory_order_relaxed); }
  double time() const { return shown_time_.load(std::memory_order_relaxed); }  ///< simulated s

 private:
  struct Hand {
    Hand(std::unique_ptr<Device> d, const CouplingGains& g, const Pose& start)
        : device(std::move(d)), gains(g), limiter(device->limits()) {
      good.pose = start;
      good.engaged = false;
    }
    std::unique_ptr<Device> device;
    CouplingGains gains;
    ForceLimiter limiter;
    Engagement engagement;
    DeviceReport good;
  };
  void note(std::uint32_t bits) { status_.fetch_or(bits, std::memory_order_relaxed); }

  Channel& channel_;
  ServoOptions options_;
  std::vector<Hand> hands_;
  double time_ = 0.0;
  double next_sample_ = 0.0;
  Ring<ServoSample> samples_;
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<std::uint64_t> rejected_{0};
  std::atomic<std::uint32_t> status_{0};
  std::atomic<double> shown_time_{0.0};
};

}  // namespace slosh
