#include "peer/output/recorder.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <tuple>

#include "peer/haptics/script_device.h"
#include "peer/output/signal_table.h"

namespace slosh {

Result<std::unique_ptr<Recorder>> Recorder::start(Servo& servo, const std::filesystem::path& folder) {
  std::unique_ptr<Recorder> recorder(new Recorder(servo));
  if (!folder.empty()) {
    const std::string signals = signals_header();
    for (const auto& [table, name, header] :
         {std::tuple{&recorder->wrenches_, "wrenches.csv", kWrenchesHeader},
          std::tuple{&recorder->poses_, "poses.csv", kPosesHeader},
          std::tuple{&recorder->signals_, "signals.csv", signals.c_str()}}) {
      if (table == &recorder->signals_ && !servo.keeps_signals()) continue;
      Result<std::unique_ptr<Table>> created = Table::create(folder / name, header);
      if (!created) return created.error();
      *table = std::move(created.value());
    }
  }
  recorder->thread_ = std::thread([own = recorder.get()] { own->run(); });
  return recorder;
}

void Recorder::run() {
  while (!stop_.load(std::memory_order_relaxed)) {
    drain();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

Recorder::~Recorder() {
  stop();
}

void Recorder::stop() {
  if (!thread_.joinable()) return;
  stop_.store(true, std::memory_order_relaxed);
  thread_.join();
  drain();
  wrenches_.reset();
  poses_.reset();
  signals_.reset();
}

std::string Recorder::problem() const {
  const std::lock_guard lock(problem_mutex_);
  return problem_;
}

void Recorder::drain() {
  ServoSample s;
  bool any = false;
  char row[400];
  while (servo_.samples().pop(s)) {
    any = true;
    rows_ += 1;
    Peak& peak = peaks_[s.device];
    peak.force = std::max(peak.force, glm::length(s.on_hand.force));
    peak.torque = std::max(peak.torque, glm::length(s.on_hand.torque));
    if (const double force = glm::length(s.on_hand.force); force > 0.0)
      peak.mean_force += (force - peak.mean_force) / static_cast<double>(++peak.felt);
    if (!wrenches_) continue;
    const glm::dvec3& f = s.on_hand.force;
    const glm::dvec3& t = s.on_hand.torque;
    std::snprintf(row, sizeof row, "%.6f,%u,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g\n", s.time, s.device, f.x, f.y, f.z,
                  t.x, t.y, t.z);
    wrenches_->add(row);
    const glm::dvec3& p = s.handle.position;
    const glm::dquat& q = s.handle.orientation;
    std::snprintf(row, sizeof row, "%.6f,%u,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g\n", s.time, s.device, p.x, p.y,
                  p.z, q.w, q.x, q.y, q.z);
    poses_->add(row);
  }
  drain_signals();
  if (!any || !wrenches_) return;
  const bool wrenches_whole = wrenches_->flush();
  const bool poses_whole = poses_->flush();
  if (!wrenches_whole || !poses_whole) note_problems();
}

void Recorder::drain_signals() {
  SignalSample s;
  bool any = false;
  while (servo_.signals().pop(s)) {
    any = true;
    if (signals_) signals_->add(signals_row(s));
  }
  if (any && signals_ && !signals_->flush()) note_problems();
}

void Recorder::note_problems() {
  const std::lock_guard lock(problem_mutex_);
  problem_.clear();
  for (const Table* table : {wrenches_.get(), poses_.get(), signals_.get()})
    if (table != nullptr && !table->problem().empty())
      problem_ += (problem_.empty() ? "" : "; ") + table->problem();
}

}  // namespace slosh
