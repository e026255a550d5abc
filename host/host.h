// The authoritative loop: inputs in order, step, publish, at the pace of the steady clock.
#pragma once

#include <atomic>
#include <cstdint>
#include <limits>
#include <thread>

#include "host/input_gate.h"
#include "net/channel.h"
#include "net/histogram.h"
#include "scenes/scene.h"
#include "sim/world.h"

namespace slosh {

struct HostOptions {
  double picture_rate = 30.0;  ///< pictures a simulated second, > 0; 0 = none (no viewer, nothing to publish)
  double until = std::numeric_limits<double>::infinity();  ///< simulated s at which the run ends
  bool paced = true;  ///< false: as fast as it goes, for tests that must not depend on the wall clock
};

/// What may be asked at any time, from any thread.
struct HostProgress {
  double time = 0.0;       ///< simulated s
  double rate = 0.0;       ///< simulated s a wall s, lately
  double step_rate = 0.0;  ///< steps a wall s, lately
  double step_ms = 0.0;    ///< mean step time, lately
  std::uint64_t tick = 0;
  std::uint32_t status = 0;  ///< StatusBits of about the last half second
};

/// What a run amounted to; complete after it has ended.
struct HostReport {
  std::uint64_t steps = 0;
  double simulated = 0.0;   ///< s
  double wall = 0.0;        ///< s, pauses left out
  Histogram step_time;      ///< of World::step alone
  StepTimes total;          ///< summed over the run, s
  std::uint64_t slips = 0;  ///< times the schedule was given up
  double slipped = 0.0;     ///< s
  std::uint64_t rejected_poses = 0;
  std::uint64_t pictures = 0;
  std::uint32_t status = 0;  ///< every StatusBit that was ever set
  Diagnostics diagnostics;   ///< of the last state
  double start_mass = 0.0;   ///< kg of fluid at the start
};

/// Owns the world and steps it on a thread of its own. Made, started and ended by one thread.
class Host {
 public:
  /// The channel must outlive the host. `scene` is read here only.
  Host(World world, const Scene& scene, Channel& channel, HostOptions options);
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  void start();
  /// Asks the loop to end after its current step; any thread, also from a signal's flag.
  void request_stop() { stop_.store(true, std::memory_order_relaxed); }
  void pause(bool paused) { pause_.store(paused, std::memory_order_relaxed); }
  /// Waits for the end of the run.
  void wait();
  bool running() const { return running_.load(std::memory_order_acquire); }

  HostProgress progress() const;
  /// Only when not running.
  const HostReport& report() const { return report_; }
  const World& world() const { return world_; }

 private:
  void run();
  void publish_bodies(double rate, std::int64_t stamp_ns);
  void publish_picture_if_due();
  void note_status(std::uint32_t status);
  std::uint32_t recent_status() const;

  World world_;
  Channel& channel_;
  HostOptions options_;
  InputGate gate_;
  HostReport report_;
  BodySnapshot latest_;           // what the gate compares new hands with
  double next_picture_ = 0.0;     // simulated s
  double status_until_[32] = {};  // simulated s up to which each bit counts as recent

  std::thread thread_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> pause_{false};
  std::atomic<bool> running_{false};
  std::atomic<double> shown_time_{0.0};
  std::atomic<double> shown_rate_{0.0};
  std::atomic<double> shown_step_rate_{0.0};
  std::atomic<double> shown_step_ms_{0.0};
  std::atomic<std::uint64_t> shown_tick_{0};
  std::atomic<std::uint32_t> shown_status_{0};
};

/// The message a channel starts with: the world before its first step, standing still.
BodyMessage initial_message(const World& world);

}  // namespace slosh
