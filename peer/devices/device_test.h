// A slow push along every axis of a device, and what it says about device and hand.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "net/histogram.h"
#include "peer/haptics/device.h"

namespace slosh {

struct DeviceTestOptions {
  double force = 1.0;    ///< N at most; never beyond the device's own limit
  double torque = 0.02;  ///< N·m at most; 0 leaves turning out
  double seconds = 6.0;  ///< an axis
};

struct DeviceTestSample {
  double time = 0.0;      ///< s since the test began
  double push = 0.0;      ///< N or N·m along the axis
  double place = 0.0;     ///< m or rad
  double velocity = 0.0;  ///< m/s or rad/s
};

/// What one axis gave: the least-squares fit of push = m·a + b·v + k·(x − x₀).
struct DeviceTestAxis {
  std::string name;  ///< "x" … "rz"
  bool turning = false;
  double stiffness = 0.0;  ///< N/m or N·m/rad
  double damping = 0.0;    ///< N·s/m or N·m·s/rad
  double mass = 0.0;       ///< kg or kg·m²
  double travel = 0.0;     ///< m or rad, from end to end
  double fit = 0.0;        ///< R², 0–1: below 0.8 it is no mass, damper and spring
  bool moved = false;      ///< else the fit means nothing
  std::vector<DeviceTestSample> samples;
};

struct DeviceTestReport {
  std::vector<DeviceTestAxis> axes;
  double force = 0.0;   ///< N, the most that was asked
  double torque = 0.0;  ///< N·m
  Histogram period;     ///< from reading to reading; of a device of no hardware nothing
  Histogram turn;       ///< from the reading to the end of the writing
  std::string stopped;  ///< why it ended early; empty: it did not
};

/// On an open device, at 1 kHz or its own pace; a device of no hardware goes by a clock of its own, as fast
/// as it can. Ends early, with a force of zero, when `over` says so, the hand is faster than kFastest, or the
/// device says nothing for kSilence. The last wrench written is zero, however it ends.
DeviceTestReport test_device(Device& device, const DeviceTestOptions& options,
                             const std::function<bool()>& over);

constexpr double kTestFastest = 0.5;  ///< m/s
constexpr double kTestSilence = 0.1;  ///< s

/// Fits one axis' samples, `period` s apart; for tests of its own.
void fit_axis(DeviceTestAxis& axis);

}  // namespace slosh
