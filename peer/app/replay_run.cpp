#include "peer/app/replay_run.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "net/clock.h"
#include "peer/app/run_report.h"
#include "peer/output/recorder.h"

namespace slosh {
namespace {

constexpr std::size_t kReplayBytes = std::size_t{256} << 20;
constexpr std::size_t kSnapshotsAhead = 30;  // then the simulation waits for who draws
constexpr double kSampleInterval = 0.002;    // simulated s, as a live run's

}  // namespace

ReplayRun::ReplayRun(keep::Replayer& replayer, const Stage& stage, double snapshot_rate)
    : replayer_(replayer), stage_(stage), snapshot_rate_(snapshot_rate), snapshots_(kReplayBytes) {
  for (const Grip& grip : stage.scene.grips) peaks_.push_back({grip.name, "recorded", 0.0, 0.0});
  start_ = replayer.world().diagnostics();
}

Result<std::unique_ptr<ReplayRun>> ReplayRun::create(keep::Replayer& replayer, const Stage& stage,
                                                     double snapshot_rate) {
  std::unique_ptr<ReplayRun> run(new ReplayRun(replayer, stage, snapshot_rate));
  Result<std::unique_ptr<WorldFiles>> files = WorldFiles::create(stage, replayer.sampled(), true);
  if (!files) return files.error();
  run->files_ = std::move(files.value());
  if (!stage.scene.task.empty())
    run->task_ =
        std::make_unique<TaskTap>(stage.scene, replayer.sampled(), [](const HostCommand&, const auto&) {});
  if (stage.folder.empty()) return run;
  Result<std::unique_ptr<Table>> wrenches = Table::create(stage.folder / "wrenches.csv", kWrenchesHeader);
  if (!wrenches) return wrenches.error();
  run->wrenches_ = std::move(wrenches.value());
  return run;
}

void ReplayRun::start() {
  running_.store(true, std::memory_order_release);
  thread_ = std::thread([this] { run(); });
}

void ReplayRun::stop() {
  request_stop();
  if (thread_.joinable()) thread_.join();
  if (files_) files_->stop();
  snapshots_.close();
}

void ReplayRun::show() {
  const double half_step = 0.5 * replayer_.world().plan().time_step;
  if (snapshot_rate_ <= 0.0 || replayer_.elapsed() + half_step < next_snapshot_) return;
  while (snapshots_.waiting() >= kSnapshotsAhead && !stop_.load(std::memory_order_relaxed)) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  auto snapshot = std::make_shared<Snapshot>();
  replayer_.world().fill(*snapshot);
  snapshots_.push(std::move(snapshot));
  if ((replayer_.status() & kStatusNonFinite) != 0)
    shown_lost_.store(replayer_.world().diagnostics().lost, std::memory_order_relaxed);
  next_snapshot_ += 1.0 / snapshot_rate_;
}

void ReplayRun::write_samples() {
  const double half_step = 0.5 * replayer_.world().plan().time_step;
  if (replayer_.elapsed() + half_step < next_sample_) return;
  while (next_sample_ <= replayer_.elapsed() + half_step) next_sample_ += kSampleInterval;
  replayer_.world().fill(bodies_);
  for (std::size_t i = 0; i < bodies_.grips.size(); ++i) {
    const Wrench& w = bodies_.grips[i].on_hand;
    peaks_[i].peak_force = std::max(peaks_[i].peak_force, glm::length(w.force));
    peaks_[i].peak_torque = std::max(peaks_[i].peak_torque, glm::length(w.torque));
    if (!wrenches_) continue;
    char row[400];
    std::snprintf(row, sizeof row, "%.6f,%zu,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n", replayer_.elapsed(), i,
                  w.force.x, w.force.y, w.force.z, w.torque.x, w.torque.y, w.torque.z);
    wrenches_->add(row);
  }
}

void ReplayRun::run() {
  const std::int64_t begin_ns = steady_now_ns();
  const double time_step = replayer_.world().plan().time_step;
  show();
  files_->begin(replayer_.world(), replayer_.elapsed());
  if (task_) task_->on_start(replayer_.world(), {});
  while (!stop_.load(std::memory_order_relaxed) && replayer_.elapsed() + 0.5 * time_step < stage_.seconds) {
    const std::int64_t step_ns = steady_now_ns();
    const Result<bool> stepped = replayer_.step();
    if (!stepped) {
      problem_ = stepped.error().text();
      break;
    }
    if (!stepped.value()) break;
    const std::int64_t now_ns = steady_now_ns();
    step_time_.add(to_seconds(now_ns - step_ns));
    total_ += replayer_.world().times();
    if (task_) task_->after_step(replayer_.world());
    write_samples();
    files_->step(replayer_.world(), replayer_.elapsed());
    show();
    wall_ = to_seconds(now_ns - begin_ns);
    shown_time_.store(replayer_.elapsed(), std::memory_order_relaxed);
    shown_rate_.store(replayer_.elapsed() / std::max(wall_, 1e-9), std::memory_order_relaxed);
  }
  if (task_) task_->on_end(replayer_.world());
  if (wrenches_) wrenches_->flush();
  snapshots_.close();
  running_.store(false, std::memory_order_release);
}

HudFacts ReplayRun::facts(double picture_rate) const {
  HudFacts facts;
  facts.title = stage_.scene.name;
  facts.spacing = replayer_.head().spacing;
  facts.fluid_particles = replayer_.world().fluid_count();
  facts.boundary_particles = replayer_.world().boundary_count();
  facts.picture_rate = picture_rate;
  facts.counts_fluid = true;
  facts.walls_hold = replayer_.world().plan().walls_hold();
  return facts;
}

Rates ReplayRun::world_rates() {
  Rates rates;
  rates.time = shown_time_.load(std::memory_order_relaxed);
  rates.real_time = shown_rate_.load(std::memory_order_relaxed);
  rates.lost = shown_lost_.load(std::memory_order_relaxed);
  if (task_) {
    rates.task = task_->lines();
    stage_.ghost_clock->follow(rates.task.done, rates.time);
  }
  return rates;
}

void ReplayRun::report(RunSummary& s) const {
  const World& world = replayer_.world();
  const Diagnostics end = world.diagnostics();
  const keep::ReplayVerdict& verdict = replayer_.verdict();
  report_stage(stage_, s);
  report_time(replayer_.elapsed(), wall_, s);
  report_steps(total_, step_time_, s);
  s.spacing = replayer_.head().spacing;
  s.spacing_reason = "as it was recorded";
  s.fluid_particles = world.fluid_count();
  s.boundary_particles = world.boundary_count();
  report_left(end, start_, world.plan(), s);
  s.steps = verdict.steps;
  s.time_step = world.plan().time_step;
  s.status = replayer_.status();
  s.devices = peaks_;
  s.backend = backend_name(replayer_.backend());
  s.verdict = verdict.text(replayer_.head().spacing);
  if (task_) {
    report_task(stage_.scene, task_->done(), s);
    s.spilled_mass = task_->spilled();
  }
  if (wrenches_) s.files.emplace_back("wrenches.csv");
  if (wrenches_ && !wrenches_->problem().empty()) s.problems.push_back(wrenches_->problem());
  files_->report(world, s);
}

}  // namespace slosh
