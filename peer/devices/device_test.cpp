#include "peer/devices/device_test.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>

#include "net/clock.h"
#include "peer/haptics/let_go.h"
#include "sim/math/gauss.h"

namespace slosh {
namespace {

constexpr double kTestPeriod = 0.001;  // s
constexpr double kFullTurn = 6.283185307179586;
constexpr double kRest = 0.3;  // s without a push between two axes
constexpr double kRamp = 1.0;  // s
constexpr double kMinTravel = 1e-6;
constexpr std::array<const char*, 6> kNames{"x", "y", "z", "rx", "ry", "rz"};

/// −1 to 1: two slow tones, so that spring, damper and mass show apart, rising from nothing and ending in it.
double push_at(double time, double seconds) {
  const double ramp = std::min({time / kRamp, (seconds - time) / kRamp, 1.0});
  if (ramp <= 0.0) return 0.0;
  const double gentle = ramp * ramp * (3.0 - 2.0 * ramp);
  return gentle * (0.6 * std::sin(kFullTurn * 0.5 * time) + 0.4 * std::sin(kFullTurn * 2.3 * time));
}

double along(const glm::dvec3& v, std::size_t axis) {
  return v[static_cast<int>(axis % 3)];
}

class Run {
 public:
  Run(Device& device, const DeviceTestOptions& options, const std::function<bool()>& over)
      : device_(device), over_(over), paced_(!device.immediate()) {
    const DeviceLimits limits = device.limits();
    report_.force = std::min(options.force, limits.max_force);
    report_.torque = std::min(options.torque, limits.max_torque);
    seconds_ = options.seconds;
  }

  DeviceTestReport go() {
    next_ns_ = began_ns_ = received_ns_ = steady_now_ns();
    try {
      const std::size_t axes = report_.torque > 0.0 ? 6 : 3;
      for (std::size_t i = 0; i < axes && report_.stopped.empty(); ++i) {
        push_axis(i);
        rest();
      }
    } catch (const std::exception& error) {
      report_.stopped = error.what();
    } catch (...) {
      report_.stopped = "the device threw an exception without words";
    }
    for (DeviceTestAxis& axis : report_.axes) fit_axis(axis);
    return std::move(report_);
  }

 private:
  /// Reads; false when the test is to end or there is nothing new.
  bool read(DeviceReport& report) {
    if (over_()) return stop("it was interrupted");
    report = device_.read({time_, kTestPeriod});
    const std::int64_t now_ns = steady_now_ns();
    if (!report.heard || !is_sound(report)) {
      if (to_seconds(now_ns - received_ns_) > kTestSilence) return stop("the device says nothing");
      return false;
    }
    if (glm::length(report.twist.linear) > kTestFastest) return stop("the hand moved faster than 0.5 m/s");
    if (paced_ && last_ns_ != 0) report_.period.add(to_seconds(now_ns - last_ns_));
    last_ns_ = received_ns_ = read_ns_ = now_ns;
    return true;
  }
  bool stop(const char* why) {
    report_.stopped = why;
    return false;
  }
  void write(const Wrench& wrench) {
    device_.write(wrench);
    report_.turn.add(to_seconds(steady_now_ns() - read_ns_));
  }
  void pass() {
    if (!paced_) {
      time_ += kTestPeriod;
      return;
    }
    const std::int64_t now_ns = steady_now_ns();
    next_ns_ = std::max(next_ns_ + to_nanoseconds(kTestPeriod), now_ns - to_nanoseconds(kTestPeriod));
    sleep_until_ns(next_ns_);
    time_ = to_seconds(steady_now_ns() - began_ns_);
  }

  void push_axis(std::size_t i) {
    DeviceTestAxis axis;
    axis.name = kNames[i];
    axis.turning = i >= 3;
    const double most = axis.turning ? report_.torque : report_.force;
    const double begin = time_;
    bool first = true;
    glm::dquat reference{1.0, 0.0, 0.0, 0.0};
    while (time_ - begin < seconds_ && report_.stopped.empty()) {
      DeviceReport report;
      if (read(report)) {
        if (first) reference = report.pose.orientation;
        first = false;
        const double push = most * push_at(time_ - begin, seconds_);
        Wrench wrench;
        (axis.turning ? wrench.torque : wrench.force)[static_cast<int>(i % 3)] = push;
        // Before the reading the last push acted, after it this one.
        axis.samples.push_back(
            {time_, 0.5 * (last_push_ + push),
             along(axis.turning ? rotation_between(reference, report.pose.orientation) : report.pose.position,
                   i),
             along(axis.turning ? report.twist.angular : report.twist.linear, i)});
        last_push_ = push;
        write(wrench);
      }
      pass();
    }
    device_.write(Wrench{});
    last_push_ = 0.0;
    report_.axes.push_back(std::move(axis));
  }
  void rest() {
    const double begin = time_;
    while (time_ - begin < kRest && report_.stopped.empty()) {
      DeviceReport report;
      if (read(report)) write(Wrench{});
      pass();
    }
  }

  Device& device_;
  const std::function<bool()>& over_;
  const bool paced_;
  DeviceTestReport report_;
  double seconds_ = 0.0;
  double time_ = 0.0;
  double last_push_ = 0.0;
  std::int64_t began_ns_ = 0, next_ns_ = 0, last_ns_ = 0, received_ns_ = 0, read_ns_ = 0;
};

void write_zero_to(void* device) noexcept {
  try {
    static_cast<Device*>(device)->rest();
  } catch (...) {
    // It was told.
  }
}

}  // namespace

void fit_axis(DeviceTestAxis& axis) {
  const std::vector<DeviceTestSample>& s = axis.samples;
  constexpr std::size_t kSpan = 5;  // samples on each side of a difference of velocities
  if (s.size() < 8 * kSpan) return;
  const auto [low, high] = std::minmax_element(
      s.begin(), s.end(),
      [](const DeviceTestSample& a, const DeviceTestSample& b) { return a.place < b.place; });
  axis.travel = high->place - low->place;
  axis.moved = axis.travel > kMinTravel;
  if (!axis.moved) return;
  // Each column by its own size, so that metres and metres a second² weigh alike.
  double fastest = 1e-12, hardest = 1e-12, strongest = 1e-12;
  const auto acceleration = [&](std::size_t i) {
    return (s[i + kSpan].velocity - s[i - kSpan].velocity) / (s[i + kSpan].time - s[i - kSpan].time);
  };
  for (std::size_t i = kSpan; i + kSpan < s.size(); ++i) {
    fastest = std::max(fastest, std::abs(s[i].velocity));
    hardest = std::max(hardest, std::abs(acceleration(i)));
    strongest = std::max(strongest, std::abs(s[i].push));
  }
  std::array<double, 16> a{};  // 4 × 4, row by row
  std::array<double, 4> x{};
  double sum = 0.0, squares = 0.0, count = 0.0;
  const auto row_at = [&](std::size_t i) {
    return std::array<double, 4>{acceleration(i) / hardest, s[i].velocity / fastest,
                                 (s[i].place - low->place) / axis.travel, 1.0};
  };
  for (std::size_t i = kSpan; i + kSpan < s.size(); ++i) {
    const std::array<double, 4> row = row_at(i);
    const double push = s[i].push / strongest;
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < 4; ++k) a[4 * j + k] += row[j] * row[k];
      x[j] += row[j] * push;
    }
    sum += push;
    squares += push * push;
    count += 1.0;
  }
  if (!solve_dense(a, x, 1e-12)) {
    axis.moved = false;
    return;
  }
  double left = 0.0;
  for (std::size_t i = kSpan; i + kSpan < s.size(); ++i) {
    const std::array<double, 4> row = row_at(i);
    const double off = s[i].push / strongest - (row[0] * x[0] + row[1] * x[1] + row[2] * x[2] + x[3]);
    left += off * off;
  }
  axis.mass = strongest * x[0] / hardest;
  axis.damping = strongest * x[1] / fastest;
  axis.stiffness = strongest * x[2] / axis.travel;
  axis.fit = std::max(0.0, 1.0 - left / std::max(squares - sum * sum / count, 1e-300));
}

DeviceTestReport test_device(Device& device, const DeviceTestOptions& options,
                             const std::function<bool()>& over) {
  const WrenchWriter writer(write_zero_to, &device);
  const auto ends = [&over] { return asked_to_let_go() || over(); };
  DeviceTestReport report = Run(device, options, ends).go();
  write_zero_to(&device);
  return report;
}

}  // namespace slosh
