#include "peer/output/recorder.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <tuple>

#include "peer/haptics/script_device.h"

namespace slosh {

Result<std::unique_ptr<Recorder>> Recorder::start(Servo& servo, const std::filesystem::path& folder) {
  std::unique_ptr<Table> wrenches;
  std::unique_ptr<Table> poses;
  if (!folder.empty()) {
    for (const auto& [table, name, header] : {std::tuple{&wrenches, "wrenches.csv", kWrenchesHeader},
                                              std::tuple{&poses, "poses.csv", kPosesHeader}}) {
      Result<std::unique_ptr<Table>> created = Table::create(folder / name, header);
      if (!created) return created.error();
      *table = std::move(created.value());
    }
  }
  return std::unique_ptr<Recorder>(new Recorder(servo, std::move(wrenches), std::move(poses)));
}

Recorder::Recorder(Servo& servo, std::unique_ptr<Table> wrenches, std::unique_ptr<Table> poses)
    : servo_(servo), wrenches_(std::move(wrenches)), poses_(std::move(poses)), peaks_(servo.devices()) {
  thread_ = std::thread([this] {
    while (!stop_.load(std::memory_order_relaxed)) {
      drain();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
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
  if (!any || !wrenches_) return;
  const bool wrenches_whole = wrenches_->flush();
  const bool poses_whole = poses_->flush();
  if (wrenches_whole && poses_whole) return;
  const std::lock_guard lock(problem_mutex_);
  problem_ = wrenches_->problem();
  if (!poses_->problem().empty()) problem_ += (problem_.empty() ? "" : "; ") + poses_->problem();
}

}  // namespace slosh
