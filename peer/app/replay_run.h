// A recording as a run to look at: simulated again from its inputs, as fast as it goes.
#pragma once

#include <atomic>
#include <memory>
#include <thread>

#include "host/keep/replay.h"
#include "host/task_tap.h"
#include "net/histogram.h"
#include "peer/app/live_run.h"
#include "peer/app/prepare.h"
#include "peer/app/world_files.h"
#include "peer/output/table.h"

namespace slosh {

class ReplayRun final : public LiveRun {
 public:
  /// `replayer` and `stage` must outlive it. `snapshot_rate` in snapshots a simulated second, 0 = none.
  /// Errors: a file cannot be written.
  static Result<std::unique_ptr<ReplayRun>> create(keep::Replayer& replayer, const Stage& stage,
                                                   double snapshot_rate);
  ~ReplayRun() override { stop(); }

  void start() override;
  void request_stop() override { stop_.store(true, std::memory_order_relaxed); }
  bool running() override { return running_.load(std::memory_order_acquire); }
  void stop() override;
  SnapshotQueue& snapshots() override { return snapshots_; }
  HudFacts facts(double picture_rate) const override;
  std::size_t exports_waiting() const override { return files_->frames_waiting(); }
  void report(RunSummary& summary) const override;

  /// Why the replay ended before its end; after stop(). Empty = it did not.
  const std::string& problem() const { return problem_; }

 private:
  ReplayRun(keep::Replayer& replayer, const Stage& stage, double snapshot_rate);
  Rates world_rates() override;
  void run();
  void show();
  void write_samples();

  keep::Replayer& replayer_;
  const Stage& stage_;
  double snapshot_rate_;
  SnapshotQueue snapshots_;
  std::unique_ptr<Table> wrenches_;  // null where nothing is written
  std::unique_ptr<WorldFiles> files_;
  std::unique_ptr<TaskTap> task_;  // null where the scene has no task; what steps bring is in the recording
  double next_snapshot_ = 0.0;     // s since the recording's start
  double next_sample_ = 0.0;
  BodySnapshot bodies_;
  std::vector<DeviceSummary> peaks_;
  Histogram step_time_;
  StepTimes total_;
  double wall_ = 0.0;
  Diagnostics start_;
  std::string problem_;
  std::thread thread_;
  std::atomic<bool> stop_{false};
  std::atomic<bool> running_{false};
  std::atomic<double> shown_time_{0.0};
  std::atomic<double> shown_rate_{0.0};
  std::atomic<std::uint64_t> shown_lost_{0};
};

}  // namespace slosh
