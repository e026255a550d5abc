// One period of the device loop, for all devices: read, couple, limit, write, post. Reads no clock.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "net/channel.h"
#include "net/ring.h"
#include "peer/haptics/device_port.h"
#include "peer/haptics/force_budget.h"
#include "peer/haptics/force_rendering.h"
#include "peer/haptics/guidance.h"
#include "peer/haptics/held_bodies.h"
#include "peer/haptics/sample_line.h"
#include "peer/haptics/signal_sample.h"
#include "scenes/scene.h"

namespace slosh {

struct ServoOptions {
  double period = 0.001;           ///< s between ticks, nominal
  double sample_interval = 0.002;  ///< simulated s between recorded samples, > 0
  std::size_t sample_capacity = 1 << 15;
  Coupling coupling = Coupling::kReplica;  ///< of hands that give way to the force
  /// What every step put on the hands, in order, where the world is in this process; must outlive the servo.
  /// Null: what body states say, of which a busy loop misses some.
  Ring<StepWrench>* steps = nullptr;
  bool signals = false;              ///< each hand's signals in each tick are kept for signals()
  std::vector<GuidedHand> guided{};  ///< hands that give way to the force and are led
};

/// tick() and let_go() belong to the device loop's thread and neither allocate, lock nor log. samples() has
/// one reader. set_device() and what asks about devices belong to one other thread.
///
/// A rising BodyMessage::run means that the world was reset: simulated time starts anew for the devices, and
/// couplings ramp up as if every hand had just engaged. The time of samples goes on instead, so that files
/// and plots of a run never step back.
class Servo {
 public:
  /// The channel must outlive the servo. One device a grip; null where the hand is not ours: then its pose in
  /// the channel is left alone. A device that set_device() would refuse is left out.
  Servo(const Scene& scene, std::vector<std::unique_ptr<Device>> devices, Channel& channel,
        ServoOptions options);
  /// Disengages all hands. After the device loop has stopped.
  ~Servo();
  Servo(const Servo&) = delete;
  Servo& operator=(const Servo&) = delete;

  void tick(std::int64_t now_ns) noexcept;
  /// A tick at the moment that the newest body state belongs to, for a world that is not paced.
  void tick_in_lockstep() noexcept;
  /// A wrench of zero to every device, for good: what ticks come after this write nothing. By the device loop
  /// at its end, or by anybody once it is over.
  void let_go() noexcept;

  /// Hands `device`, already open, to grip `i` from the next tick on; null takes away what is there, once its
  /// force has gone by its limits; until then it is said not to hold on. What was there is sent zero, closed
  /// and freed as soon as the loop has released it: at a later call, or at the end. Errors: limits that are
  /// not sound (check_limits); then nothing changes.
  Result<bool> set_device(std::size_t i, std::unique_ptr<Device> device);

  /// The springs of grip `i` are so many times the scene's (World::set_grip_stiffness): the loop goes over to
  /// it by kGripStiffnessPace, as the world does, and no device is asked for more than it holds. > 0; the
  /// control thread's.
  void set_stiffness(std::size_t i, double scale) {
    hands_[i].stiffness_wanted.store(scale, std::memory_order_relaxed);
  }

  std::size_t devices() const { return hands_.size(); }  ///< grips, whoever holds them
  /// The grip's device, or the last one that it had; null when there never was one.
  const Device* device(std::size_t i) const {
    return hands_[i].owned.empty() ? nullptr : &hands_[i].owned.back()->device();
  }
  /// Why the grip's device is out of use (DevicePort::failure); empty while it works.
  std::string failure(std::size_t i) const {
    return hands_[i].owned.empty() ? std::string() : hands_[i].owned.back()->failure();
  }
  /// What the grip's coupling asks of its device and that gives; any thread.
  ForceBudget budget(std::size_t i) const { return hands_[i].budget.now(); }
  /// Tells every device where the viewer looks from (Device::look_from).
  void look_from(const glm::dquat& axes) {
    for (Hand& hand : hands_)
      if (!hand.owned.empty()) hand.owned.back()->look_from(axes);
  }
  bool holds(std::size_t i) const { return hands_[i].wanted.load(std::memory_order_relaxed) != nullptr; }
  bool holds_any() const;
  /// Sends every device zero and closes it. After the device loop has stopped; may be called again.
  void close_devices();
  Ring<ServoSample>& samples() { return samples_; }  ///< device loop → recorder
  /// As samples(), of a loop that was asked for them (ServoOptions::signals).
  Ring<SignalSample>& signals() { return signals_; }
  bool keeps_signals() const { return options_.signals; }
  std::uint64_t samples_lost() const { return lost_.load(std::memory_order_relaxed); }
  std::uint64_t reports_rejected() const { return rejected_.load(std::memory_order_relaxed); }
  /// StatusBits that were ever set here.
  std::uint32_t status() const { return status_.load(std::memory_order_relaxed); }
  double time() const { return shown_time_.load(std::memory_order_relaxed); }  ///< simulated s

 private:
  struct Hand {
    Hand(const CouplingGains& of_scene, const Pose& s) : gains(of_scene), start(s), felt(of_scene) {}
    // Between the threads: what the loop shall use, is about to use, and uses.
    std::atomic<DevicePort*> wanted{nullptr};
    std::atomic<DevicePort*> claimed{nullptr};
    std::atomic<DevicePort*> in_use{nullptr};
    std::atomic<double> stiffness_wanted{1.0};       // times the scene's
    std::vector<std::unique_ptr<DevicePort>> owned;  // the newest last; the control thread's

    // The loop's.
    DevicePort* port = nullptr;
    DeviceLimits limits;
    CouplingGains gains;     // the scene's
    double stiffness = 1.0;  // times that, now
    Pose start;
    int body = 0;
    ForceRendering felt;
    std::optional<Guidance> guide;
    std::shared_ptr<const GhostClock> ghost;
    ForceBudgetNote budget;
    DeviceReport good;
    Wrench given;                // in the last tick
    std::uint64_t readings = 0;  // of the device so far
    bool with_world = false;     // it goes by simulated time
    std::int64_t read_ns = 0;    // when it last said something
    double read_time = 0.0;      // simulated s that it belongs to
    bool leapt = false;          // it is suddenly elsewhere, in this tick
  };
  /// The device that is wanted, safe from being freed.
  DevicePort* claim_device(Hand& hand) noexcept;
  void change_device(Hand& hand, DevicePort* port) noexcept;
  bool parts(const Hand& hand, const DevicePort* wanted) const noexcept;
  bool is_gone(const BodySnapshot& bodies, int body) const noexcept;
  void free_unused(Hand& hand);
  glm::dvec3 guidance(Hand& hand) noexcept;
  void follow_stiffness(std::size_t i, Hand& hand, const BodySnapshot& bodies, double elapsed) noexcept;
  void follow_run(const BodyMessage& message) noexcept;
  void follow_pace(const BodyMessage& message) noexcept;
  void follow_time(double now, double most, std::int64_t now_ns) noexcept;
  /// Simulated s a s of the hand's own time.
  double pace_of(const Hand& hand) const noexcept { return hand.with_world ? 1.0 : pace_; }
  void tick(std::int64_t now_ns, bool fresh) noexcept;
  /// Takes in what the device says; true when the hand leapt.
  bool read_device(Hand& hand, std::int64_t now_ns) noexcept;
  bool another_holds(const BodyMessage& message, std::size_t i) const noexcept;
  void post_pose(std::size_t i, const Hand& hand) noexcept;
  Wrench within_limits(std::size_t grip, const Wrench& wrench) const noexcept;
  void note_steps(const BodyMessage& message) noexcept;
  void pass_on(bool all) noexcept;
  bool sample_due(bool stopped) const noexcept;
  void note_signals(std::size_t i, SignalSample& signals, std::int64_t now_ns) noexcept;
  void note(std::uint32_t bits) { status_.fetch_or(bits, std::memory_order_relaxed); }

  Channel& channel_;
  ServoOptions options_;
  std::deque<Hand> hands_;  // a hand never moves: the loop and the control thread share it
  std::uint32_t run_ = 0;
  double time_ = 0.0;
  double pace_ = 1.0;      // simulated s a s on the wall, smoothed
  bool lockstep_ = false;  // tick_in_lockstep(): a run whose clock is the world's
  bool stands_ = false;    // the world does
  bool moving_ = false;
  std::int64_t ticked_ns_ = 0;
  double sample_offset_ = 0.0;  // s that samples' time is ahead of the world's, after resets
  LinkFreshness link_freshness_;
  HeldBodies held_;
  bool states_apart_ = false;  // Channel::newest() is written
  bool let_go_ = false;
  double next_sample_ = 0.0;
  double sampled_ = -1.0;  // simulated s of the newest sample
  std::uint64_t ticks_ = 0;
  std::int64_t first_tick_ns_ = 0, tick_before_ns_ = 0;
  SampleLine line_;
  Ring<ServoSample> samples_;
  Ring<SignalSample> signals_;
  std::atomic<std::uint64_t> lost_{0};
  std::atomic<std::uint64_t> rejected_{0};
  std::atomic<std::uint32_t> status_{0};
  std::atomic<double> shown_time_{0.0};
};

}  // namespace slosh
