#include "peer/devices/hand_map.h"

#include <cstdio>

#include "peer/devices/passive_gains.h"

namespace slosh {
namespace {

constexpr double kAnywhere = 10.0;  // m: the reach of a hand that may clutch

std::optional<double> optional_number(DeviceFile& file, const std::string& key, double least, double most) {
  if (!file.has(key)) {
    (void)file.text(key);  // known, though not there
    return std::nullopt;
  }
  return file.number(key, least, least, most);
}

std::string warning(const std::string& device, const char* what, double asked, double holds, double own,
                    double period, bool held_back) {
  char text[360];
  std::snprintf(
      text, sizeof text,
      "%s: its file asks for a %s of %g, and by its own damping of %g at a period of %g ms%s it holds "
      "%.3g (Colgate: b > K·T/2 + B): it may hum or run away. Hold it loosely at first",
      device.c_str(), what, asked, own, 1e3 * period, held_back ? " (low_pass_hz counted)" : "", holds);
  return text;
}

}  // namespace

HandMapSettings read_hand_map(DeviceFile& file, HandMapSettings s) {
  s.scale = file.number("scale", s.scale, 0.01, 100.0);
  s.force_scale = file.number("force_scale", s.force_scale, 0.001, 10.0);
  s.low_pass_hz = file.number("low_pass_hz", s.low_pass_hz, 0.0, 1000.0);
  s.by_camera = file.word("relative_to", s.by_camera ? "camera" : "world", {"camera", "world"}) == "camera";
  s.clutch_button = file.whole("clutch_button", s.clutch_button, 0, kMaxButtons);
  s.deadman_button = file.whole("deadman_button", s.deadman_button, 0, kMaxButtons);
  s.stiffness = optional_number(file, "stiffness_n_m", 1.0, 1e5);
  s.damping = optional_number(file, "damping_n_s_m", 0.001, 1e3);
  s.rotational_stiffness = optional_number(file, "rotational_stiffness_nm_rad", 1e-4, 1e3);
  s.rotational_damping = optional_number(file, "rotational_damping_nm_s_rad", 1e-6, 10.0);
  s.own_damping = optional_number(file, "own_damping_n_s_m", 0.001, 1e3);
  s.own_rotational_damping = optional_number(file, "own_rotational_damping_nm_s_rad", 1e-6, 10.0);
  return s;
}

ChosenGains choose_gains(const DeviceLimits& sheet, double own_damping, double own_rotational_damping,
                         double period, const HandMapSettings& settings, const std::string& device) {
  period += 2.0 * LowPass::lag(settings.low_pass_hz);
  const double own = settings.own_damping.value_or(own_damping);
  const double turning = settings.own_rotational_damping.value_or(own_rotational_damping);
  ChosenGains chosen{passive_limits(sheet, own, turning, period), {}};
  struct Asked {
    const char* what;
    std::optional<double> value;
    double* limit;
    double own;
  };
  DeviceLimits& l = chosen.limits;
  for (const Asked& asked :
       {Asked{"stiffness", settings.stiffness, &l.max_stiffness, own},
        Asked{"damping", settings.damping, &l.max_damping, own},
        Asked{"rotational stiffness", settings.rotational_stiffness, &l.max_rotational_stiffness, turning},
        Asked{"rotational damping", settings.rotational_damping, &l.max_rotational_damping, turning}}) {
    if (!asked.value) continue;
    if (*asked.value > *asked.limit)
      chosen.warnings.push_back(warning(device, asked.what, *asked.value, *asked.limit, asked.own, period,
                                        settings.low_pass_hz > 0.0));
    *asked.limit = *asked.value;
  }
  return chosen;
}

void tie_to_room(HandMapSettings& settings, double scale) {
  settings.scale = scale;
  settings.by_camera = true;  // so that look_from() counts, which the room calls and the camera does not
}

HandMap::HandMap(const HandMapSettings& settings, const HandPlace& place, double period)
    : settings_(settings),
      low_pass_(settings.low_pass_hz, period),
      axes_(settings.by_camera ? place.camera : glm::dquat(1.0, 0.0, 0.0, 0.0)),
      start_(place.start) {}

Pose HandMap::mapped(const Pose& pose) const noexcept {
  const glm::dquat turned = pose.orientation * glm::conjugate(origin_.orientation);
  return {start_.position + axes_ * (settings_.scale * (pose.position - origin_.position)),
          glm::normalize(axes_ * turned * glm::conjugate(axes_) * start_.orientation)};
}

void HandMap::look_from(const glm::dquat& axes) noexcept {
  if (!settings_.by_camera) return;
  if (begun_ && !clutched_) {
    start_ = mapped(device_);
    origin_ = device_;
  }
  axes_ = axes;
}

DeviceReport HandMap::to_world(const DeviceReport& at_device) noexcept {
  if (!begun_) {
    begun_ = true;
    origin_ = at_device.pose;
  }
  device_ = at_device.pose;
  DeviceReport report = at_device;
  report.at_device = at_device.pose;
  report.rendered = rendered_;
  report.engaged = at_device.engaged && (settings_.deadman_button == 0 ||
                                         button_down(at_device.buttons, settings_.deadman_button));
  const bool clutched = button_down(at_device.buttons, settings_.clutch_button);
  if (clutched && !clutched_) held_ = mapped(at_device.pose);
  if (clutched_ && !clutched) {  // the hand goes on from where it stayed
    start_ = held_;
    origin_ = at_device.pose;
  }
  clutched_ = clutched;
  report.pose = clutched ? held_ : mapped(at_device.pose);
  report.twist =
      clutched ? Twist{}
               : Twist{axes_ * (settings_.scale * at_device.twist.linear), axes_ * at_device.twist.angular};
  return report;
}

Wrench HandMap::to_device(const Wrench& in_world) const noexcept {
  const glm::dquat back = glm::conjugate(axes_);
  return {back * (settings_.force_scale * in_world.force), back * (settings_.force_scale * in_world.torque)};
}

DeviceLimits HandMap::to_world(const DeviceLimits& at_device) const {
  const double f = settings_.force_scale;
  const double s = settings_.scale;
  DeviceLimits l = at_device;
  l.max_force /= f;
  l.max_torque /= f;
  l.max_force_rate /= f;
  l.max_torque_rate /= f;
  l.max_force_jerk /= f;
  l.max_torque_jerk /= f;
  l.max_stiffness /= f * s;
  l.max_damping /= f * s;
  l.max_rotational_stiffness /= f;
  l.max_rotational_damping /= f;
  l.workspace_center = start_.position;
  // The handle may begin at one edge of its reach and go to the other.
  l.workspace_radius = settings_.clutch_button != 0 ? kAnywhere : 2.0 * s * at_device.workspace_radius;
  return l;
}

}  // namespace slosh
