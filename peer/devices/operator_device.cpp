#include "peer/devices/operator_device.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "peer/devices/device_file.h"

namespace slosh {
namespace {

constexpr double kMaxElapsed = 0.05;  // s
constexpr double kSeenApart = 0.001;  // s
// How far a person leans against a force: beyond that the arm just gives way.
constexpr double kMaxLift = 0.3;   // m
constexpr double kMaxBrace = 1.0;  // rad

constexpr double kTwoPi = 6.283185307179586;

/// Three tones that never meet, each in another direction.
ArmState tremor_at(double time, double amplitude) {
  constexpr std::array<double, 3> kTones{8.3, 9.7, 11.9};  // Hz
  ArmState tremor;
  for (int i = 0; i < 3; ++i) {
    const double pace = kTwoPi * kTones[static_cast<std::size_t>(i)];
    tremor.place[i] = amplitude * std::sin(pace * time + i);
    tremor.velocity[i] = amplitude * pace * std::cos(pace * time + i);
  }
  return tremor;
}

glm::dvec3 bounded(const glm::dvec3& v, double most) {
  const double length = glm::length(v);
  return length > most ? v * (most / length) : v;
}

struct Option {
  const char* name;
  double* value;
  double least, most;
};

Result<bool> set_option(const std::string& word, const std::array<Option, 7>& options) {
  constexpr const char* kMend =
      "Give tight or loose, then any of mass=0.05..20, damping=0.1..500, stiffness=1..10000, "
      "wrist=0.1..200, tremor=0..0.005, delay=0..0.5, correction=0..5";
  const std::size_t equals = word.find('=');
  const std::string name = word.substr(0, equals);
  const std::string text = equals == std::string::npos ? "" : word.substr(equals + 1);
  const auto at =
      std::find_if(options.begin(), options.end(), [&](const Option& o) { return name == o.name; });
  const Error bad{"--device operator", in_quotes(word) + " is nothing that an operator has", kMend};
  if (at == options.end()) return bad;
  double value = 0.0;
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (code != std::errc() || end != text.data() + text.size() || !(value >= at->least && value <= at->most))
    return bad;
  *at->value = value;
  return true;
}

}  // namespace

Result<OperatorSettings> parse_operator(const std::string& options) {
  OperatorSettings s;
  double wrist = 0.0;
  const std::array<Option, 7> known{{{"mass", &s.arm.mass, 0.05, 20.0},
                                     {"damping", &s.arm.damping, 0.1, 500.0},
                                     {"stiffness", &s.arm.stiffness, 1.0, 1e4},
                                     {"wrist", &wrist, 0.1, 200.0},
                                     {"tremor", &s.tremor, 0.0, 0.005},
                                     {"delay", &s.delay, 0.0, 0.5},
                                     {"correction", &s.correction, 0.0, 5.0}}};
  std::istringstream in(options);
  for (std::string word; std::getline(in, word, ',');) {
    if (word == "tight") {
      s.arm = OperatorSettings{}.arm;
      s.wrist = OperatorSettings{}.wrist;
    } else if (word == "loose") {
      s.arm = {1.0, 6.0, 120.0};
      s.wrist = {0.003, 0.02, 0.8};
    } else if (const Result<bool> set = set_option(word, known); !set) {
      return set.error();
    }
  }
  if (wrist > 0.0) {  // as well damped as it was
    s.wrist.damping *= std::sqrt(wrist / s.wrist.stiffness);
    s.wrist.stiffness = wrist;
  }
  return s;
}

OperatorDevice::OperatorDevice(PoseTrack track, const OperatorSettings& settings)
    : track_(std::move(track)), settings_(settings) {}

void OperatorDevice::begin(double time) noexcept {
  begun_ = true;
  took_weight_ = false;
  last_ = time;
  lived_ = 0.0;
  goal_ = track_.at(time);
  arm_ = wrist_ = ArmState{};
  lift_ = brace_ = glm::dvec3(0.0);
  felt_ = Wrench{};
  count_ = newest_ = 0;
}

/// Notes how far off the goal the hand is by now.
void OperatorDevice::see() noexcept {
  if (count_ > 0 && lived_ < seen_[newest_].time + kSeenApart - 1e-9) return;
  newest_ = (newest_ + 1) % kSeen;
  count_ = std::min(count_ + 1, kSeen);
  seen_[newest_] = {lived_, arm_.place + lift_, wrist_.place + brace_};
}

/// Wants the hand elsewhere by what was off `delay` ago.
void OperatorDevice::correct(double seconds) noexcept {
  for (std::size_t back = 0; back < count_; ++back) {
    const Seen& seen = seen_[(newest_ + kSeen - back) % kSeen];
    if (seen.time > lived_ - settings_.delay) continue;
    const glm::dvec3 lift = bounded(lift_ - settings_.correction * seconds * seen.place, kMaxLift);
    const glm::dvec3 brace = bounded(brace_ - settings_.correction * seconds * seen.turn, kMaxBrace);
    // The hand stays where it is; what is wanted moves.
    arm_.place -= lift - lift_;
    wrist_.place -= brace - brace_;
    lift_ = lift;
    brace_ = brace;
    return;
  }
}

void OperatorDevice::live(double seconds) noexcept {
  lived_ += seconds;
  arm_ = arm_after(settings_.arm, arm_, felt_.force, seconds);
  wrist_ = arm_after(settings_.wrist, wrist_, felt_.torque, seconds);
  see();
  correct(seconds);
}

DeviceReport OperatorDevice::read(const DeviceMoment& moment) noexcept {
  if (!begun_ || moment.time < last_) begin(moment.time);
  const double on = moment.time - last_;
  const double seconds = moment.stands ? std::max(on, moment.period) : on;
  last_ = moment.time;
  if (on > 0.0)
    goal_ = track_.at(moment.time);
  else if (moment.stands)
    goal_.twist = Twist{};
  if (seconds > 0.0) live(std::min(seconds, kMaxElapsed));
  DeviceReport report;
  const ArmState tremor = tremor_at(lived_, settings_.tremor);
  report.pose.position = goal_.pose.position + lift_ + arm_.place + tremor.place;
  report.pose.orientation = rotate_by(goal_.pose.orientation, brace_ + wrist_.place);
  report.twist.linear = goal_.twist.linear + arm_.velocity + tremor.velocity;
  const glm::dvec3 turn = brace_ + wrist_.place;
  report.twist.angular = angular_velocity_of(turn, wrist_.velocity) +
                         rotate_by({1.0, 0.0, 0.0, 0.0}, turn) * goal_.twist.angular;
  return report;
}

void OperatorDevice::write(const Wrench& on_hand) noexcept {
  felt_ = on_hand;
  if (took_weight_ || (on_hand.force == glm::dvec3(0.0) && on_hand.torque == glm::dvec3(0.0))) return;
  took_weight_ = true;
  lift_ = bounded(-on_hand.force / settings_.arm.stiffness, kMaxLift);
  brace_ = bounded(-on_hand.torque / settings_.wrist.stiffness, kMaxBrace);
  arm_.place -= lift_;
  wrist_.place -= brace_;
}

}  // namespace slosh
