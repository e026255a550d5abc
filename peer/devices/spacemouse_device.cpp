#include "peer/devices/spacemouse_device.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "peer/devices/device_file.h"

namespace slosh {
namespace {

constexpr std::size_t kMaxReport = 64;
constexpr int kMaxReports = 64;  // at once: a device that never stops must not keep the thread
constexpr std::uint8_t kLight = 0x04;

bool is_named(const SpaceMouseFound& found, const std::string& which) {
  return found.hid.serial == which || found.hid.path == which;
}

}  // namespace

std::vector<SpaceMouseFound> find_spacemice() {
  std::vector<SpaceMouseFound> found;
  for (HidInfo& info : list_hid()) {
    if (const SpaceMouseModel* model = spacemouse_model(info.vendor, info.product))
      found.push_back({std::move(info), model});
  }
  return found;
}

SpaceMouseDevice::SpaceMouseDevice(std::string which, const Pose& start, const glm::dquat& camera,
                                   std::function<std::int64_t()> now_ns)
    : which_(std::move(which)), start_(start), camera_(camera), now_ns_(std::move(now_ns)) {}

SpaceMouseDevice::~SpaceMouseDevice() {
  SpaceMouseDevice::close();
}

Result<bool> SpaceMouseDevice::open_path(const SpaceMouseFound& found) {
  Result<HidPort> port = HidPort::open(found.hid.path);
  if (!port) return port.error();
  port_.emplace(std::move(port.value()));
  serial_ = found.hid.serial;
  product_ = found.hid.product;
  now_.name = found.model->name;
  now_.there = true;
  now_.state = {};
  received_ns_ = advanced_ns_ = now_ns_();
  light(true);
  show();
  return true;
}

Result<bool> SpaceMouseDevice::open_first() {
  constexpr const char* kMend = "Plug it in; `./slosh devices` lists what is there";
  const std::string spec = which_.empty() ? "--device spacemouse" : "--device spacemouse:" + which_;
  std::string taken;
  for (const SpaceMouseFound& found : find_spacemice()) {
    if (!which_.empty() && !is_named(found, which_)) continue;
    if (HidPort::claimed(found.hid.path)) {
      taken = found.hid.path;
      continue;
    }
    return open_path(found);
  }
  if (!taken.empty())
    return Error{spec, "every SpaceMouse here (" + taken + ") is in another hand", "Plug in one more"};
  return Error{spec,
               which_.empty() ? "no SpaceMouse is there" : "no SpaceMouse with that number or path is there",
               kMend};
}

Result<bool> SpaceMouseDevice::open() {
  const Result<bool> opened = open_first();
  if (!opened) return opened;
  Result<DeviceFile> file = DeviceFile::read(device_settings_file("spacemouse", serial_));
  if (!file) return file.error();
  const Result<SpaceMouseSettings> settings = read_spacemouse_settings(std::move(file.value()));
  if (!settings) return settings.error();
  motion_.emplace(settings.value(), start_, camera_);
  return true;
}

void SpaceMouseDevice::look_again(std::int64_t now_ns) {
  if (now_ns - looked_ns_ < to_nanoseconds(kLookAgain)) return;
  looked_ns_ = now_ns;
  for (const SpaceMouseFound& found : find_spacemice()) {
    const bool same = serial_.empty() ? found.hid.product == product_ : found.hid.serial == serial_;
    if (same && !HidPort::claimed(found.hid.path) && open_path(found)) return;
  }
}

bool SpaceMouseDevice::take_reports(std::int64_t now_ns) {
  std::array<std::uint8_t, kMaxReport> bytes{};
  bool news = false;
  for (int i = 0; i < kMaxReports; ++i) {
    const int size = port_->read(bytes.data(), bytes.size());
    if (size == 0) break;
    if (size < 0) return false;
    news = true;
    const SpaceMouseReport report =
        take_spacemouse_report(bytes.data(), static_cast<std::size_t>(size), now_.state);
    if (report == SpaceMouseReport::kMalformed) {
      now_.malformed += 1;
    } else {
      now_.reports += 1;
    }
    if (report == SpaceMouseReport::kAxes) received_ns_ = now_ns;
  }
  if (now_ns - received_ns_ > to_nanoseconds(kSilence)) now_.state.axes = {};
  if (news) show();
  return true;
}

DeviceReport SpaceMouseDevice::read(const DeviceMoment&) {
  DeviceReport report;
  const std::int64_t now_ns = now_ns_();
  if (port_ && !take_reports(now_ns)) {
    port_.reset();
    now_.there = false;
    looked_ns_ = now_ns;
    show();
  }
  if (!port_) look_again(now_ns);
  if (!port_) {
    report.pose = motion_->pose();
    report.engaged = report.heard = false;
    return report;
  }
  if (const glm::dquat* axes = camera_now_.news()) motion_->look_from(*axes);
  motion_->advance(now_.state, to_seconds(now_ns - advanced_ns_));
  advanced_ns_ = now_ns;
  report.pose = motion_->pose();
  report.twist = motion_->twist();
  report.buttons = now_.state.buttons;
  report.engaged = motion_->engaged();
  return report;
}

void SpaceMouseDevice::light(bool on) {
  const std::array<std::uint8_t, 2> bytes{kLight, static_cast<std::uint8_t>(on ? 1 : 0)};
  if (port_) (void)port_->write(bytes.data(), bytes.size());  // some have no light
}

void SpaceMouseDevice::close() {
  light(false);
  port_.reset();
}

void SpaceMouseDevice::show() {
  const std::lock_guard lock(mutex_);
  shown_ = now_;
}

SpaceMouseLive SpaceMouseDevice::live() const {
  const std::lock_guard lock(mutex_);
  return shown_;
}

std::string SpaceMouseDevice::trouble() const {
  const SpaceMouseLive now = live();
  if (now.there || now.name.empty()) return {};
  return "the " + now.name + " is unplugged; it goes on when it is back";
}

std::string SpaceMouseDevice::status() const {
  const SpaceMouseLive now = live();
  const SpaceMouseAxes& a = now.state.axes;
  char text[200];
  std::snprintf(text, sizeof text, "cap %4d %4d %4d turned %4d %4d %4d, %llu reports, %llu malformed", a[0],
                a[1], a[2], a[3], a[4], a[5], static_cast<unsigned long long>(now.reports),
                static_cast<unsigned long long>(now.malformed));
  std::string line = text;
  if (now.state.battery >= 0) line += ", battery " + std::to_string(now.state.battery) + " %";
  return line;
}

}  // namespace slosh
