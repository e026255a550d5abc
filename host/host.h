// The authoritative loop: inputs in order, step, publish, at the pace of the steady clock.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <future>
#include <limits>
#include <mutex>
#include <thread>
#include <vector>

#include "host/fluid_demand.h"
#include "host/gone_bodies.h"
#include "host/input_gate.h"
#include "host/pace_line.h"
#include "host/rate_meter.h"
#include "host/snapshot_demand.h"
#include "host/tap.h"
#include "net/channel.h"
#include "net/histogram.h"
#include "scenes/scene.h"
#include "sim/fluid_models.h"
#include "sim/world.h"

namespace slosh {

struct HostOptions {
  /// Snapshots a simulated second while `demand` wants any; 0 = none at all.
  /// The first of each run comes in any case.
  double snapshot_rate = 30.0;
  SnapshotDemand* demand = nullptr;  ///< must outlive the host; null = snapshots are wanted always
  /// Which grips' bodies BodyMessage::fluid_models are made for; must outlive the host; null = none.
  const FluidDemand* fluid_demand = nullptr;
  double until = std::numeric_limits<double>::infinity();  ///< simulated s at which the run ends
  /// false: as fast as it goes, with a clock that goes on by a time step a step, so that a run is the same
  /// again whatever the machine does.
  bool paced = true;
  bool shell = false;     ///< snapshots say which particles are seen from outside (Snapshot::shell)
  bool paused = false;    ///< starts standing still
  std::uint32_t run = 0;  ///< what BodyMessage::run starts with: that of a world that was restored
  /// World::save of what a reset goes back to; empty = the world as it is handed over. For a world that was
  /// restored in mid-run.
  std::vector<std::uint8_t> start_state;
  /// Raised at each turn of the loop, a world's that stands still too, and 0 before and after the run: who
  /// looks on knows that it has not got stuck. Must outlive the host; null = nobody does.
  std::atomic<std::uint64_t>* pulse = nullptr;
};

/// What may be asked at any time, from any thread.
struct HostProgress {
  double time = 0.0;       ///< simulated s
  double rate = 0.0;       ///< simulated s a wall s, lately
  double step_rate = 0.0;  ///< steps a wall s, lately
  double step_ms = 0.0;    ///< mean step time, lately
  std::uint64_t tick = 0;
  std::uint32_t run = 0;  ///< rises by one with every reset
  bool paused = false;
  std::uint32_t status = 0;                      ///< StatusBits of about the last half second
  std::array<std::uint64_t, 32> status_steps{};  ///< in how many steps so far, one a bit
  std::uint64_t lost = 0;                        ///< as Diagnostics::lost, where walls hold
};

/// What a run amounted to; complete after it has ended.
struct HostReport {
  std::uint64_t steps = 0;
  double simulated = 0.0;   ///< s, over all resets
  double wall = 0.0;        ///< s, pauses left out
  Histogram step_time;      ///< of World::step alone
  StepTimes total;          ///< summed over the run, s
  std::uint64_t slips = 0;  ///< times the schedule was given up
  double slipped = 0.0;     ///< s
  std::uint64_t rejected_poses = 0;
  std::uint64_t snapshots = 0;
  std::uint64_t fluid_models = 0;                ///< made, over all bodies
  std::uint32_t status = 0;                      ///< every StatusBit that was ever set
  std::array<std::uint64_t, 32> status_steps{};  ///< in how many steps, one a bit
  std::vector<std::string> gone;                 ///< bodies that left for good, in words; kMaxGone at most
  Diagnostics diagnostics;                       ///< of the last state
  Diagnostics start;  ///< of the first: what had left by then did so while it settled
};

/// Of HostReport::gone.
constexpr std::size_t kMaxGone = 100;

/// Called on the host's thread with what came of a command.
using HostAnswer = std::function<void(const Result<bool>&)>;

/// Slower, steps would come so rarely that hands took the world for silent (peer/haptics/link_freshness.h).
constexpr double kSlowestPace = 0.05;

/// Owns the world and steps it on a thread of its own. Made, started and ended by one thread.
class Host {
 public:
  /// The channel must outlive the host. `scene` is read here only.
  Host(World world, const Scene& scene, Channel& channel, HostOptions options);
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  /// Listens from start() on; must outlive the host. Before start().
  void add_tap(HostTap& tap) { taps_.push_back(&tap); }

  void start();
  /// Asks the loop to end after its current step; any thread, also from a signal's flag.
  void request_stop() { stop_.store(true, std::memory_order_relaxed); }
  void pause(bool paused) { post({paused ? HostAction::kPause : HostAction::kContinue}); }
  /// Simulated s a wall s at most, kSlowestPace–1 (brought into that range): slow motion. Acts from the next
  /// step on; any thread. Changes nothing that the world does, so nothing of it is recorded.
  void set_pace(double pace) { pace_.store(std::clamp(pace, kSlowestPace, 1.0), std::memory_order_relaxed); }
  double pace() const { return pace_.load(std::memory_order_relaxed); }
  /// So many steps of a world that stands, each shown; nothing while it runs. Any thread.
  void step_standing(int steps) { steps_asked_.fetch_add(std::max(steps, 0), std::memory_order_relaxed); }
  /// Queues a command for the next step's boundary, also while paused; in order; any thread. `answer` may be
  /// empty; once the run is over it is called at once, with an error.
  void post(const HostCommand& command, HostAnswer answer = {});
  /// The same with the answer to wait for. Not on the host's thread.
  std::future<Result<bool>> ask(const HostCommand& command);
  /// Waits for the end of the run.
  void wait();
  bool running() const { return running_.load(std::memory_order_acquire); }

  HostProgress progress() const;
  /// Only when not running.
  const HostReport& report() const { return report_; }
  const World& world() const { return world_; }
  /// World::save of what a reset goes back to.
  const std::vector<std::uint8_t>& start_state() const { return start_state_; }
  /// Only when not running; while it runs, taps are told.
  HostState state() const;

 private:
  /// When steps are due, and how fast they go.
  struct Schedule {
    explicit Schedule(double time_step) : pacer(time_step) {}
    /// A run begins, or goes on after a pause.
    void restart();

    Pacer pacer;
    PaceLine line;
    RateMeter meter;
    std::int64_t begin_ns = 0;    ///< since when the wall time counts
    std::int64_t stepped_ns = 0;  ///< when the last step ended
  };
  struct Turn {
    Pacer::Turn at;
    double pace = 1.0;  ///< simulated s a s, as asked for
  };

  struct Order {
    HostCommand command;
    HostAnswer answer;
  };

  void run();
  void begin_run();
  void stand();
  Turn wait_for_turn(bool single);
  std::span<const HandleInput> take_inputs();
  /// Returns s that the world took.
  double step(std::span<const HandleInput> input);
  void publish(const Turn& turn, bool single);
  void count(double seconds);
  void end_run();
  std::int64_t clock_ns() const;
  void run_commands();
  void end_commands();
  void stand_still();
  bool take_asked_step();
  Result<bool> carry_out(const HostCommand& command);
  Result<bool> reset();
  void show_state();
  void show_lost();
  void model_fluid(std::span<const HandleInput> input);
  void publish_bodies(double rate, std::int64_t stamp_ns);
  void publish_snapshot();
  void publish_snapshot_if_due();
  void tell_published();
  void tell_refused();
  void tell_gone();
  void note_status(std::uint32_t status);
  std::uint32_t recent_status() const;

  World world_;
  Channel& channel_;
  HostOptions options_;
  InputGate gate_;
  Schedule schedule_;
  HostReport report_;
  BodySnapshot latest_;  // what the gate compares new hands with
  FluidModels fluid_models_;
  std::vector<int> grip_bodies_;  // one a grip
  std::vector<std::string> body_names_;
  GoneBodies gone_;
  std::vector<char> modelled_;            // one a body
  std::vector<FluidWrenchModel> models_;  // of the last step
  double next_snapshot_ = 0.0;            // simulated s
  double status_until_[32] = {};          // simulated s up to which each bit counts as recent

  std::vector<HostTap*> taps_;
  std::vector<std::uint8_t> start_state_;
  std::size_t fluids_ = 0;  // of the scene
  bool paused_ = false;
  std::uint32_t run_ = 0;
  std::int64_t simulated_ns_ = 0;  // the clock of a run that is not paced

  std::mutex orders_mutex_;
  std::condition_variable ordered_;
  std::vector<Order> orders_;  // under the mutex
  bool over_ = false;          // under the mutex: nobody carries orders out any more
  std::atomic<bool> has_orders_{false};

  std::thread thread_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> running_{false};
  std::atomic<double> pace_{1.0};
  std::atomic<int> steps_asked_{0};  // of a world that stands
  std::atomic<double> shown_time_{0.0};
  std::atomic<double> shown_rate_{0.0};
  std::atomic<double> shown_step_rate_{0.0};
  std::atomic<double> shown_step_ms_{0.0};
  std::atomic<std::uint64_t> shown_tick_{0};
  std::atomic<std::uint32_t> shown_run_{0};
  std::atomic<bool> shown_paused_{false};
  std::atomic<std::uint32_t> shown_status_{0};
  std::array<std::atomic<std::uint64_t>, 32> shown_status_steps_{};
  std::atomic<std::uint64_t> shown_lost_{0};
};

/// The message a channel starts with: the world before its first step, standing still.
BodyMessage initial_message(const World& world, std::uint32_t run = 0);

}  // namespace slosh
