#include "peer/devices/gamepad_device.h"

#include <cstdio>

#include "peer/devices/device_file.h"

namespace slosh {

SpaceMouseSettings gamepad_defaults() {
  SpaceMouseSettings s;
  s.rate = false;
  s.deadzone = 30;
  s.reach = 0.15;
  s.axes = {{{0, 1}, {2, 1}, {1, 1}, {3, 1}, {5, 1}, {4, -1}}};
  return s;
}

GamepadDevice::GamepadDevice(std::string which, const Pose& start, const glm::dquat& camera,
                             std::function<std::int64_t()> now_ns)
    : which_(std::move(which)), start_(start), camera_(camera), now_ns_(std::move(now_ns)) {}

GamepadDevice::~GamepadDevice() {
  GamepadDevice::close();
}

Result<bool> GamepadDevice::open_found(const GamepadFound& found) {
  Result<GamepadPort> port = GamepadPort::open(found.path);
  if (!port) return port.error();
  port_.emplace(std::move(port.value()));
  found_ = found;
  now_.name = found.name.empty() ? found.path : found.name;
  now_.there = true;
  advanced_ns_ = now_ns_();
  show();
  return true;
}

Result<bool> GamepadDevice::open_first() {
  const std::string spec = which_.empty() ? "--device gamepad" : "--device gamepad:" + which_;
  std::string taken;
  for (const GamepadFound& found : find_gamepads()) {
    if (!which_.empty() && found.path != which_ && found.name != which_ && found.serial != which_) continue;
    if (GamepadPort::claimed(found.path)) {
      taken = found.path;
      continue;
    }
    return open_found(found);
  }
  if (!taken.empty())
    return Error{spec, "every gamepad here (" + taken + ") is in another hand", "Plug in one more"};
  return Error{spec,
               which_.empty() ? "no gamepad is there" : "no gamepad with that number, name or node is there",
               "Plug it in; `./slosh devices` lists what is there"};
}

Result<bool> GamepadDevice::open() {
  const Result<bool> opened = open_first();
  if (!opened) return opened;
  Result<DeviceFile> file = DeviceFile::read(device_settings_file("gamepad", found_.serial));
  if (!file) return file.error();
  const Result<SpaceMouseSettings> settings =
      read_spacemouse_settings(std::move(file.value()), gamepad_defaults());
  if (!settings) return settings.error();
  motion_.emplace(settings.value(), start_, camera_);
  return true;
}

void GamepadDevice::look_again(std::int64_t now_ns) {
  if (now_ns - looked_ns_ < to_nanoseconds(kLookAgain)) return;
  looked_ns_ = now_ns;
  for (const GamepadFound& found : find_gamepads()) {
    const bool same = found.name == found_.name && found.serial == found_.serial;
    if (same && !GamepadPort::claimed(found.path) && open_found(found)) return;
  }
}

DeviceReport GamepadDevice::read(const DeviceMoment&) {
  DeviceReport report;
  const std::int64_t now_ns = now_ns_();
  const std::uint64_t events = now_.events;
  if (port_ && !port_->take(now_.state, now_.events)) {
    port_.reset();
    now_.there = false;
    now_.state = {};
    looked_ns_ = now_ns;
    show();
  }
  if (!port_) look_again(now_ns);
  if (!port_) {
    report.pose = motion_->pose();
    report.engaged = report.heard = false;
    return report;
  }
  if (now_.events != events) show();
  if (const glm::dquat* axes = camera_now_.news()) motion_->look_from(*axes);
  motion_->advance(now_.state, to_seconds(now_ns - advanced_ns_));
  advanced_ns_ = now_ns;
  report.pose = motion_->pose();
  report.twist = motion_->twist();
  report.buttons = now_.state.buttons;
  report.engaged = motion_->engaged();
  return report;
}

void GamepadDevice::close() {
  port_.reset();
}

void GamepadDevice::show() {
  const std::lock_guard lock(mutex_);
  shown_ = now_;
}

GamepadDevice::Live GamepadDevice::shown() const {
  const std::lock_guard lock(mutex_);
  return shown_;
}

std::string GamepadDevice::trouble() const {
  const Live now = shown();
  if (now.there || now.name.empty()) return {};
  return "the " + now.name + " is unplugged; it goes on when it is back";
}

std::string GamepadDevice::status() const {
  const Live now = shown();
  const SpaceMouseAxes& a = now.state.axes;
  char text[160];
  std::snprintf(text, sizeof text, "left stick %4d %4d, right stick %4d %4d, triggers %4d, %llu events", a[0],
                a[1], a[4], a[3], a[2], static_cast<unsigned long long>(now.events));
  return text;
}

}  // namespace slosh
