#include "peer/haptics/devices/plugin_device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "net/clock.h"
#include "net/text/clean.h"
#include "peer/haptics/devices/room_tie.h"

namespace slosh {
namespace {

constexpr double kLongestPeriod = 0.1;  // s

DeviceLimits sheet_of(const slosh_device_capabilities& c) {
  DeviceLimits l;
  l.max_force = c.max_force_n;
  l.max_torque = c.max_torque_nm;
  l.max_force_rate = c.max_force_rate_n_s;
  l.max_torque_rate = c.max_torque_rate_nm_s;
  l.max_stiffness = c.max_stiffness_n_m;
  l.max_damping = c.max_damping_n_s_m;
  l.max_rotational_stiffness = c.max_rotational_stiffness_nm_rad;
  l.max_rotational_damping = c.max_rotational_damping_nm_s_rad;
  l.workspace_radius = c.workspace_radius_m;
  return l;
}

bool above_zero(double value) {
  return std::isfinite(value) && value > 0.0;
}

/// Of a name that a plug-in gave, what may be a file's name.
std::string settings_name(const char* name) {
  std::string kept;
  for (const char* c = name; *c != '\0'; ++c) {
    const bool plain = (*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9');
    kept += plain || *c == '-' ? *c : '_';
  }
  return kept.empty() ? "plugin" : kept;
}

}  // namespace

struct PluginDevice::Handle {
  PluginLibrary library;
  void* device = nullptr;
  std::string error;  // of open
  slosh_device_capabilities capabilities{};
  slosh_device_reading reading{};
  int read_code = 0;
  std::optional<Error> refused;
};

PluginDevice::PluginDevice(std::string file, std::string options, HandPlace place)
    : file_(std::move(file)), options_(std::move(options)), place_(std::move(place)) {}

PluginDevice::~PluginDevice() {
  PluginDevice::close();
}

Error PluginDevice::failed(const std::string& what) const {
  return {"plug-in " + file_, what, "It is the plug-in that does so: ask who made it"};
}

Result<bool> PluginDevice::open() {
  auto handle = std::make_shared<Handle>();
  const std::string did = fenced(kPatience, [handle, file = file_, options = options_] {
    Result<PluginLibrary> loaded = load_plugin(file);
    if (!loaded) {
      handle->refused = loaded.error();
      return;
    }
    handle->library = loaded.value();
    std::array<char, 400> why{};
    void* device = nullptr;
    const int opened = handle->library.open(options.c_str(), &device, why.data(), why.size());
    if (opened != 0) {
      why.back() = '\0';
      handle->error = "cannot open its device: " + clean_text(why.data(), kMostTextBytes);
      return;
    }
    handle->device = device;
    if (handle->library.capabilities(device, &handle->capabilities) != 0) {
      handle->error = "does not say what its device can do";
      return;
    }
    handle->read_code = handle->library.read(device, &handle->reading);
  });
  if (!did.empty()) return failed("while it was opened it " + did);
  handle_ = handle;
  if (handle->refused) return *handle->refused;
  if (!handle->error.empty()) return failed(handle->error);
  if (handle->read_code < 0) return failed("its device is gone before it was read");
  return settle(handle->capabilities);
}

Result<bool> PluginDevice::settle(const slosh_device_capabilities& said) {
  std::array<char, sizeof said.name + 1> name{};
  std::memcpy(name.data(), said.name, sizeof said.name);
  for (const auto& [what, value] :
       {std::pair{"period_s", said.period_s}, std::pair{"own_damping_n_s_m", said.own_damping_n_s_m},
        std::pair{"own_rotational_damping_nm_s_rad", said.own_rotational_damping_nm_s_rad}}) {
    if (!above_zero(value)) return failed(std::string("its capability ") + what + " is not a number above 0");
  }
  if (said.period_s > kLongestPeriod) return failed("its period_s is longer than 0.1 s");
  if (const Result<bool> sound = check_limits(sheet_of(said), "plugin:" + file_); !sound) return sound;

  Result<DeviceFile> file = DeviceFile::read(device_settings_file(settings_name(name.data()), ""));
  if (!file) return file.error();
  HandMapSettings settings = read_hand_map(file.value(), HandMapSettings{});
  if (const Result<bool> fine = file.value().check(); !fine) return fine;
  if (place_.tie) {
    if (const Result<bool> begun = place_.tie->begin(settings_name(name.data())); !begun) return begun;
    if (place_.tie->shared()) tie_to_room(settings, place_.tie->scale());
  }
  const double period = std::max(said.period_s, 0.001);
  ChosenGains gains =
      choose_gains(sheet_of(said), said.own_damping_n_s_m, said.own_rotational_damping_nm_s_rad, period, settings,
                   clean_text(name.data(), 64));
  warnings_ = std::move(gains.warnings);
  map_.emplace(settings, place_, period);
  limits_ = map_->to_world(gains.limits);
  if (handle_->read_code == 0) first_ = taken(handle_->reading);
  return true;
}

DeviceReport PluginDevice::taken(const slosh_device_reading& r) {
  DeviceReport report;
  report.pose.position = {r.position_m[0], r.position_m[1], r.position_m[2]};
  report.pose.orientation = {r.orientation_wxyz[0], r.orientation_wxyz[1], r.orientation_wxyz[2],
                             r.orientation_wxyz[3]};
  if ((r.flags & SLOSH_READING_HAS_TWIST) != 0) {
    report.twist.linear = {r.velocity_m_s[0], r.velocity_m_s[1], r.velocity_m_s[2]};
    report.twist.angular = {r.angular_velocity_rad_s[0], r.angular_velocity_rad_s[1],
                            r.angular_velocity_rad_s[2]};
  }
  report.buttons = r.buttons;
  report.engaged = (r.flags & SLOSH_READING_LET_GO) == 0;
  const bool sound = is_sound(report);
  const bool shared = place_.tie && place_.tie->shared();
  if (const glm::dquat* axes = camera_now_.news(); axes && !shared) map_->look_from(*axes);
  if (sound == unsound_) {
    unsound_ = !sound;
    set_trouble(sound ? ""
                      : "the plug-in " + file_ + " says a pose or velocity that is no number or no rotation");
  }
  if (!sound) {
    velocity_.forget();
    return silent();
  }
  if ((r.flags & SLOSH_READING_HAS_TWIST) == 0) report.twist = velocity_.add(report.pose, steady_now_ns());
  const DeviceReport in_world = map_->to_world(report);
  if (place_.tie) {
    if (const auto axes = place_.tie->follow(report.pose, in_world.pose)) map_->look_from(*axes);
  }
  return in_world;
}

DeviceReport PluginDevice::silent() const {
  DeviceReport report;
  report.pose = place_.start;
  report.engaged = report.heard = false;
  return report;
}

DeviceReport PluginDevice::read(const DeviceMoment&) {
  if (first_) {
    const DeviceReport first = *first_;
    first_.reset();
    return first;
  }
  slosh_device_reading reading{};
  int code = 0;
  try {
    code = handle_->library.read(handle_->device, &reading);
  } catch (const std::exception& error) {
    throw std::runtime_error("the plug-in " + file_ + " threw from read: " + clean_text(error.what(), 200));
  } catch (...) {
    throw std::runtime_error("the plug-in " + file_ + " threw from read, without words");
  }
  if (code < 0) throw std::runtime_error("the plug-in " + file_ + " says that its device is gone");
  if (code == 0) return taken(reading);
  return silent();
}

void PluginDevice::write(const Wrench& on_hand) {
  const Wrench wrench = map_->filtered(on_hand);
  const double force[3] = {wrench.force.x, wrench.force.y, wrench.force.z};
  const double torque[3] = {wrench.torque.x, wrench.torque.y, wrench.torque.z};
  int code = 0;
  try {
    code = handle_->library.write(handle_->device, force, torque);
  } catch (const std::exception& error) {
    throw std::runtime_error("the plug-in " + file_ + " threw from write: " + clean_text(error.what(), 200));
  } catch (...) {
    throw std::runtime_error("the plug-in " + file_ + " threw from write, without words");
  }
  if (code < 0) throw std::runtime_error("the plug-in " + file_ + " says that its device is gone");
}

void PluginDevice::close() {
  if (!handle_ || handle_->device == nullptr) return;
  const std::string did =
      fenced(kCloseWait, [handle = std::move(handle_)] { handle->library.close(handle->device); });
  handle_.reset();
  if (!did.empty()) set_trouble("the plug-in " + file_ + " " + did + " while it was closed");
}

void PluginDevice::set_trouble(const std::string& words) {
  const std::lock_guard lock(mutex_);
  trouble_ = words;
}

std::string PluginDevice::trouble() const {
  const std::lock_guard lock(mutex_);
  return trouble_;
}

}  // namespace slosh
