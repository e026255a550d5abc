#include "peer/app/own_hands.h"

#include <algorithm>

#include "peer/app/hand_trouble.h"
#include "peer/app/run_report.h"

namespace slosh {

OwnHands::OwnHands(const Stage& stage, DeviceSet devices, Channel& channel, const ServoOptions& servo)
    : stage_(stage),
      mice_(std::move(devices.mouse_targets)),
      lent_(std::move(devices.lent)),
      servo_(stage.scene, std::move(devices.devices), channel, servo),
      loop_(servo_) {
  mice_.resize(stage.scene.grips.size());
  lent_.resize(stage.scene.grips.size());
}

Result<std::unique_ptr<OwnHands>> OwnHands::create(const Stage& stage, DeviceSet devices, Channel& channel,
                                                   ServoOptions servo, const std::filesystem::path& folder) {
  servo.sample_interval = 1.0 / stage.row_rate;
  servo.signals = stage.signals;
  servo.guided = stage.ghost;
  std::unique_ptr<OwnHands> hands(new OwnHands(stage, std::move(devices), channel, servo));
  Result<std::unique_ptr<Recorder>> recorder = Recorder::start(hands->servo_, folder);
  if (!recorder) return recorder.error();
  hands->recorder_ = std::move(recorder.value());
  return hands;
}

void OwnHands::stop() {
  loop_.stop();
  servo_.close_devices();
  if (recorder_) recorder_->stop();
}

void OwnHands::set(std::size_t i, HandDevice hand) {
  mice_[i] = std::move(hand.mouse);
  lent_[i] = std::move(hand.lent);
  (void)servo_.set_device(i, std::move(hand.device));  // open_device saw its limits
}

void OwnHands::follow_stiffness(const std::vector<double>& stiffness) {
  for (std::size_t i = 0; i < std::min(stiffness.size(), servo_.devices()); ++i)
    servo_.set_stiffness(i, stiffness[i]);
}

std::vector<LiveGrip> OwnHands::live_grips(const std::vector<double>& stiffness) const {
  const std::vector<Grip>& of_scene = stage_.scene.grips;
  std::vector<LiveGrip> grips;
  for (std::size_t i = 0; i < std::min(stiffness.size(), of_scene.size()); ++i) {
    LiveGrip grip{stiffness[i], of_scene[i].stiffness, 0.0};
    const Device* const device = servo_.holds(i) ? servo_.device(i) : nullptr;
    if (device != nullptr && device->gives_way()) grip.of_device = device->limits().max_stiffness;
    grips.push_back(grip);
  }
  return grips;
}

void OwnHands::note(Rates& rates) const {
  rates.device_rate = servo_.holds_any() ? loop_.rate() : 0.0;
  rates.device_status = servo_.status();
  for (std::size_t i = 0; i < servo_.devices(); ++i) {
    const std::string line =
        servo_.holds(i) ? budget_line(stage_.scene.grips[i].name, servo_.budget(i)) : std::string();
    if (!line.empty()) rates.budgets += (rates.budgets.empty() ? "" : "\n") + line;
  }
}

std::string OwnHands::trouble(const std::string& others) const {
  const std::string own = recorder_->problem();
  return run_trouble(own.empty() ? others : own, servo_, stage_.scene);
}

void OwnHands::report(RunSummary& s) const {
  const DeviceLoopReport& ran = loop_.report();
  s.device_loop_us = spread_of(ran.period, 1e6);
  s.device_ticks = ran.ticks;
  s.device_missed = ran.missed;
  s.device_scheduler = ran.scheduler();
  s.device_memory_locked = ran.memory_locked;
  s.status |= servo_.status();
  s.rejected_poses += servo_.reports_rejected();
  s.samples_lost = servo_.samples_lost();
  for (std::size_t i = 0; i < servo_.devices(); ++i) {
    if (servo_.device(i) == nullptr) continue;
    const Peak& peak = recorder_->peaks()[i];
    s.devices.push_back({stage_.scene.grips[i].name, servo_.device(i)->kind(), peak.force, peak.torque,
                         servo_.budget(i).clipped, peak.mean_force});
  }
  for (const std::string& each : run_troubles(recorder_->problem(), servo_, stage_.scene))
    s.problems.push_back(each);
}

}  // namespace slosh
