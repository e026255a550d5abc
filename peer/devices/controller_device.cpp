#include "peer/devices/controller_device.h"

#include <algorithm>
#include <cstdio>

namespace slosh {
namespace {

constexpr double kCloses = 0.6;  // of the button's way; opens below kOpens
constexpr double kOpens = 0.4;
constexpr double kShakeEvery = 0.02;  // s: a motor takes about as long to answer
constexpr double kShakeFor = 0.03;    // s
constexpr double kTorqueArm = 0.1;    // m
constexpr int kOpenHand = 32;         // the button by which HandMap knows an open hand

HandMapSettings as_it_is() {
  HandMapSettings settings;
  settings.by_camera = false;
  settings.clutch_button = kOpenHand;
  return settings;
}

}  // namespace

Result<ControllerSettings> read_controller_settings(DeviceFile file) {
  ControllerSettings s;
  const std::string hold = file.word("hold_with", "squeeze", {"squeeze", "trigger", "always"});
  using HoldWith = ControllerSettings::HoldWith;
  s.hold_with = hold == "trigger"  ? HoldWith::kTrigger
                : hold == "always" ? HoldWith::kAlways
                                   : HoldWith::kSqueeze;
  s.open_hand_lets_go = file.word("open_hand", "stays", {"stays", "lets_go"}) == "lets_go";
  s.vibration = file.number("vibration", s.vibration, 0.0, 1.0);
  s.full_vibration = file.number("full_vibration_n", s.full_vibration, 0.01, 1000.0);
  if (const Result<bool> fine = file.check(); !fine) return fine.error();
  return s;
}

double ForceChange::strength(const Wrench& on_hand, double seconds, double full) noexcept {
  if (!begun_) mean_ = on_hand;
  begun_ = true;
  const double share = std::clamp(seconds / kMeanOver, 0.0, 1.0);
  mean_.force += share * (on_hand.force - mean_.force);
  mean_.torque += share * (on_hand.torque - mean_.torque);
  const double change =
      glm::length(on_hand.force - mean_.force) + glm::length(on_hand.torque - mean_.torque) / kTorqueArm;
  return std::clamp((change / full - kUnfelt) / (1.0 - kUnfelt), 0.0, 1.0);
}

ControllerDevice::ControllerDevice(std::shared_ptr<HeadsetLink> link, HandSide side, const Pose& start,
                                   std::function<std::int64_t()> now_ns)
    : link_(std::move(link)),
      side_(side),
      now_ns_(std::move(now_ns)),
      map_(as_it_is(), HandPlace{start, {1.0, 0.0, 0.0, 0.0}, {}}),
      last_(start) {}

Result<bool> ControllerDevice::open() {
  Result<DeviceFile> file = DeviceFile::read(device_settings_file("xr", ""));
  if (!file) return file.error();
  const Result<ControllerSettings> settings = read_controller_settings(std::move(file.value()));
  if (!settings) return settings.error();
  settings_ = settings.value();
  return true;
}

bool ControllerDevice::held(const HandReading& reading) const {
  if (settings_.hold_with == ControllerSettings::HoldWith::kAlways) return true;
  const bool trigger = settings_.hold_with == ControllerSettings::HoldWith::kTrigger;
  return static_cast<double>(trigger ? reading.trigger : reading.squeeze) > (closed_ ? kOpens : kCloses);
}

DeviceReport ControllerDevice::read(const DeviceMoment&) {
  const std::optional<RoomInWorld> room = link_->room();
  HandReading reading;
  if (room) reading = link_->hands->read(side_);
  DeviceReport report;
  if (reading.tracked) {
    last_ = room->to_world(reading.pose);
    const Twist seen = velocity_.add(last_, now_ns_());
    report.twist = reading.twist_known ? room->to_world(reading.twist) : seen;
  } else {
    velocity_.forget();
  }
  closed_ = reading.tracked && held(reading);
  report.pose = last_;
  report.buttons = closed_ ? 0u : 1u << (kOpenHand - 1);
  report = map_.to_world(report);
  report.buttons = reading.buttons;
  report.engaged = closed_ || !settings_.open_hand_lets_go;
  const std::lock_guard lock(mutex_);
  tracked_ = reading.tracked;
  ever_tracked_ = ever_tracked_ || tracked_;
  shown_ = reading;
  return report;
}

void ControllerDevice::write(const Wrench& on_hand) {
  const std::int64_t now_ns = now_ns_();
  const double passed = wrote_ns_ == 0 ? 0.0 : to_seconds(now_ns - wrote_ns_);
  wrote_ns_ = now_ns;
  const double strength = change_.strength(on_hand, passed, settings_.full_vibration);
  if (!closed_) {  // an open hand feels nothing
    strongest_ = 0.0;
    return;
  }
  strongest_ = std::max(strongest_, settings_.vibration * strength);
  if (to_seconds(now_ns - shaken_ns_) < kShakeEvery) return;
  shaken_ns_ = now_ns;
  if (strongest_ > 0.0) link_->hands->vibrate(side_, strongest_, kShakeFor);
  strongest_ = 0.0;
}

void ControllerDevice::close() {
  link_->hands->vibrate(side_, 0.0, 0.0);
}

std::string ControllerDevice::trouble() const {
  const std::lock_guard lock(mutex_);
  if (tracked_ || !ever_tracked_) return {};
  return std::string("the ") + (side_ == HandSide::kLeft ? "left" : "right") +
         " controller is not seen; its hand stays where it was";
}

std::string ControllerDevice::status() const {
  const std::lock_guard lock(mutex_);
  if (!tracked_) return "not seen";
  char text[160];
  const glm::dvec3& p = shown_.pose.position;
  std::snprintf(text, sizeof text, "at %.3f %.3f %.3f m in the room, squeeze %.2f, trigger %.2f", p.x, p.y,
                p.z, static_cast<double>(shown_.squeeze), static_cast<double>(shown_.trigger));
  return text;
}

}  // namespace slosh
