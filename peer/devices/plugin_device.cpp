#include "peer/devices/plugin_device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "net/clock.h"
#include "net/text/clean.h"
#include "peer/devices/room_tie.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr double kLongestPeriod = 0.1;  // s
constexpr double kLongestStep =
    0.005;                           // s that a device is moved on by: a thread that was late makes no leap
constexpr double kFirmHand = 800.0;  // N/m, a firm grip's, as the simulated operator's

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

Wrench wrench_of(const slosh_device_reading& r) {
  return {{r.force_n[0], r.force_n[1], r.force_n[2]}, {r.torque_nm[0], r.torque_nm[1], r.torque_nm[2]}};
}

bool is_finite(const Wrench& w) {
  return std::isfinite(w.force.x + w.force.y + w.force.z + w.torque.x + w.torque.y + w.torque.z);
}

slosh_device_motion motion_of(const AdmittanceMotion& motion) {
  const glm::dvec3& p = motion.pose().position;
  const glm::dquat& q = motion.pose().orientation;
  const glm::dvec3& v = motion.twist().linear;
  const glm::dvec3& w = motion.twist().angular;
  return {{p.x, p.y, p.z}, {q.w, q.x, q.y, q.z}, {v.x, v.y, v.z}, {w.x, w.y, w.z}};
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
      handle->error = "cannot open its device: " + clean_text(why.data(), kMaxTextBytes);
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
  only_tells_ = said.kind == SLOSH_DEVICE_POSITION;
  for (const auto& [what, value] :
       {std::pair{"period_s", said.period_s}, std::pair{"own_damping_n_s_m", said.own_damping_n_s_m},
        std::pair{"own_rotational_damping_nm_s_rad", said.own_rotational_damping_nm_s_rad}}) {
    if (!above_zero(value)) return failed(std::string("its capability ") + what + " is not a number above 0");
    if (only_tells_) break;
  }
  if (said.period_s > kLongestPeriod) return failed("its period_s is longer than 0.1 s");
  if (said.kind > SLOSH_DEVICE_POSITION) return failed("its capability kind is none that this slosh knows");
  if (!only_tells_) {
    if (const Result<bool> sound = check_limits(sheet_of(said), "plugin:" + file_); !sound) return sound;
  }

  Result<DeviceFile> file = DeviceFile::read(device_settings_file(settings_name(name.data()), ""));
  if (!file) return file.error();
  HandMapSettings settings = read_hand_map(file.value(), HandMapSettings{});
  if (said.kind == SLOSH_DEVICE_ADMITTANCE) {
    const Result<bool> moves =
        settle_motion(said, file.value(), settings.own_damping.value_or(said.own_damping_n_s_m),
                      settings.own_rotational_damping.value_or(said.own_rotational_damping_nm_s_rad));
    if (!moves) return moves;
  }
  if (const Result<bool> fine = file.value().check(); !fine) return fine;
  if (place_.tie) {
    if (const Result<bool> begun = place_.tie->begin(settings_name(name.data())); !begun) return begun;
    if (place_.tie->shared()) tie_to_room(settings, place_.tie->scale());
  }
  const double period = period_ = std::max(said.period_s, 0.001);
  map_.emplace(settings, place_, period);
  if (only_tells_) {
    limits_ = limits_without_a_hand();
  } else {
    ChosenGains gains =
        choose_gains(sheet_of(said), said.own_damping_n_s_m, said.own_rotational_damping_nm_s_rad, period,
                     settings, clean_text(name.data(), 64));
    warnings_.insert(warnings_.end(), gains.warnings.begin(), gains.warnings.end());
    limits_ = map_->to_world(gains.limits);
  }
  if (handle_->read_code == 0) first_ = taken(handle_->reading);
  return true;
}

/// What moves a device that measures force: its sheet's mass and damper, or its user's.
Result<bool> PluginDevice::settle_motion(const slosh_device_capabilities& said, DeviceFile& file, double own,
                                         double own_turning) {
  for (const auto& [what, value] :
       {std::pair{"virtual_mass_kg", said.virtual_mass_kg},
        std::pair{"virtual_inertia_kg_m2", said.virtual_inertia_kg_m2},
        std::pair{"max_speed_m_s", said.max_speed_m_s},
        std::pair{"max_turning_rad_s", said.max_turning_rad_s}, std::pair{"following_s", said.following_s}}) {
    if (!above_zero(value)) return failed(std::string("its capability ") + what + " is not a number above 0");
  }
  if (handle_->library.move == nullptr)
    return failed("it measures force and lacks the function slosh_device_move");
  AdmittanceSettings s;
  s.mass = file.number("virtual_mass_kg", said.virtual_mass_kg, 0.01, 100.0);
  s.inertia = file.number("virtual_inertia_kg_m2", said.virtual_inertia_kg_m2, 1e-6, 10.0);
  s.damping = own;
  s.rotational_damping = own_turning;
  s.max_speed = said.max_speed_m_s;
  s.max_turning = said.max_turning_rad_s;
  s.following = said.following_s;
  const std::string name = clean_text(said.name, sizeof said.name);
  if (s.mass < said.virtual_mass_kg || s.inertia < said.virtual_inertia_kg_m2)
    warnings_.push_back(
        name +
        ": its file asks for a lighter handle than the device is made for: it may hum. Hold it "
        "loosely at first");
  if (s.damping < s.following * kFirmHand)
    warnings_.push_back(
        name + format(": a hand stiffer than %.0f N/m may make it hum: it is %.1f ms behind, and its "
                      "damping of %.3g N·s/m holds no more (own_damping_n_s_m)",
                      s.damping / s.following, 1e3 * s.following, s.damping));
  motion_.emplace(s);
  moves_ = false;
  return true;
}

/// The hand of a device that is moved is where it is told to be: a coupling to a place that comes later would
/// hum.
void PluginDevice::sense(const slosh_device_reading& reading, const DeviceReport& measured) {
  if (!moves_) motion_->begin(measured.pose);
  moves_ = true;
  motion_->sense(measured.pose, wrench_of(reading));
  sensed_ns_ = steady_now_ns();
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
  const bool forced = !motion_ || ((r.flags & SLOSH_READING_HAS_WRENCH) != 0 && is_finite(wrench_of(r)));
  const bool sound = is_sound(report) && forced;
  const bool shared = place_.tie && place_.tie->shared();
  if (const glm::dquat* axes = camera_now_.news(); axes && !shared) map_->look_from(*axes);
  if (sound == unsound_) {
    unsound_ = !sound;
    set_trouble(sound ? ""
                : forced
                    ? "the plug-in " + file_ + " says a pose or velocity that is no number or no rotation"
                    : "the plug-in " + file_ + " says no force of the hand, or one that is no number");
  }
  if (!sound) {
    velocity_.forget();
    sensed_ns_ = 0;
    return silent();
  }
  if (motion_) {
    sense(r, report);
    report.pose = motion_->pose();
    report.twist = motion_->twist();
  } else if ((r.flags & SLOSH_READING_HAS_TWIST) == 0)
    report.twist = velocity_.add(report.pose, steady_now_ns());
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
  const int code = asked("read", [&] { return handle_->library.read(handle_->device, &reading); });
  if (handle_->library.say != nullptr) ask_words();
  return code == 0 ? taken(reading) : silent();
}

void PluginDevice::ask_words() {
  const std::int64_t now_ns = steady_now_ns();
  if (asked_ns_ != 0 && to_seconds(now_ns - asked_ns_) < kAskedAgain) return;
  asked_ns_ = now_ns;
  std::array<char, 400> words{};
  const int code =
      asked("say", [&] { return handle_->library.say(handle_->device, words.data(), words.size()); });
  words.back() = '\0';
  const std::string text = clean_text(words.data(), kMaxTextBytes);
  const std::lock_guard lock(mutex_);
  its_trouble_ = code == 0 ? "" : text;
  its_status_ = code == 0 ? text : "";
}

template <class Call>
int PluginDevice::asked(const char* function, Call&& call) const {
  int code = 0;
  try {
    code = call();
  } catch (const std::exception& error) {
    throw std::runtime_error("the plug-in " + file_ + " threw from " + function + ": " +
                             clean_text(error.what(), 200));
  } catch (...) {
    throw std::runtime_error("the plug-in " + file_ + " threw from " + function + ", without words");
  }
  if (code < 0) throw std::runtime_error("the plug-in " + file_ + " says that its device is gone");
  return code;
}

void PluginDevice::write(const Wrench& on_hand) {
  if (only_tells_) return;
  const Wrench wrench = map_->filtered(on_hand);
  if (motion_) {
    move(wrench);
    return;
  }
  const double force[3] = {wrench.force.x, wrench.force.y, wrench.force.z};
  const double torque[3] = {wrench.torque.x, wrench.torque.y, wrench.torque.z};
  asked("write", [&] { return handle_->library.write(handle_->device, force, torque); });
}

void PluginDevice::move(const Wrench& wrench) {
  if (!moves_) return;  // nobody knows yet where it is
  const std::int64_t now_ns = steady_now_ns();
  const double seconds = moved_ns_ == 0 ? 0.0 : to_seconds(now_ns - moved_ns_);
  moved_ns_ = now_ns;
  if (to_seconds(now_ns - sensed_ns_) > std::max(kForceHolds, 3.0 * period_))
    motion_->stand();
  else
    motion_->advance(wrench, std::min(seconds, std::max(kLongestStep, 2.0 * period_)));
  const slosh_device_motion motion = motion_of(*motion_);
  asked("move", [&] { return handle_->library.move(handle_->device, &motion); });
}

void PluginDevice::rest() {
  sensed_ns_ = 0;  // what is moved stands; it takes no wrench
  write(Wrench{});
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
  return trouble_.empty() ? its_trouble_ : trouble_;
}

std::string PluginDevice::status() const {
  const std::lock_guard lock(mutex_);
  return its_status_;
}

}  // namespace slosh
