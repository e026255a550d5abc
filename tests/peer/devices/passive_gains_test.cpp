// Gains from a device's own damping, against a simulation of what they promise.
#include "peer/devices/passive_gains.h"

#include <gtest/gtest.h>

#include <cmath>

#include "peer/devices/hand_map.h"

namespace slosh {
namespace {

/// A frictionless mass with damping `own` on a spring and damper sampled every `period` s with a zero-order
/// hold, the force through a low pass of `hz`: the largest swing in the last quarter of 4 s over that of the
/// first.
double growth(double mass, double own, double period, double stiffness, double damping, double hz = 0.0) {
  double x = 0.001, v = 0.0, before = x, early = 0.0, late = 0.0;
  const int ticks = static_cast<int>(4.0 / period);
  LowPass filter(hz, period);
  for (int i = 0; i < ticks; ++i) {
    const double wanted = -stiffness * x - damping * (x - before) / period;
    const double force = filter.pass({{wanted, 0.0, 0.0}, {}}).force.x;
    before = x;
    const int steps = 50;
    for (int k = 0; k < steps; ++k) {
      const double dt = period / steps;
      v += dt * (force - own * v) / mass;
      x += dt * v;
    }
    if (i < ticks / 4) early = std::max(early, std::abs(x));
    if (i >= 3 * ticks / 4) late = std::max(late, std::abs(x));
    if (!std::isfinite(x)) return INFINITY;
  }
  return late / early;
}

TEST(PassiveGains, LieInsideColgatesBound) {
  for (const double own : {0.1, 1.0, 5.0}) {
    for (const double period : {0.0005, 0.001, 0.004}) {
      const PassiveGains gains = passive_gains(own, period);
      EXPECT_TRUE(renders_passively(own, period, gains.stiffness, gains.damping));
      EXPECT_FALSE(renders_passively(own, period, 1.06 * gains.stiffness, 1.06 * gains.damping));
      EXPECT_TRUE(renders_passively(own, period, gains.stiffness, 0.0)) << "and every smaller pair";
    }
  }
}

TEST(PassiveGains, AHandOfAnyMassComesToRestOnThemAndNotFarBeyond) {
  const double own = 1.0;
  const double period = 0.001;
  const PassiveGains gains = passive_gains(own, period);
  for (const double mass : {0.02, 0.1, 0.5, 2.0})
    EXPECT_LT(growth(mass, own, period, gains.stiffness, gains.damping), 0.9) << mass;
  EXPECT_GT(growth(0.1, own, period, 4.0 * gains.stiffness, 0.0), 1.0) << "twice the bound runs away";
}

TEST(PassiveGains, AreSofterWhereTheForceIsHeldBackAndHoldThere) {
  const double own = 1.0;
  const double period = 0.001;
  HandMapSettings settings;
  settings.low_pass_hz = 30.0;
  DeviceLimits sheet;
  sheet.max_stiffness = sheet.max_damping = 1e6;
  sheet.max_rotational_stiffness = sheet.max_rotational_damping = 1e6;
  const DeviceLimits limits = choose_gains(sheet, own, 0.01, period, settings, "arm").limits;
  // 0.95 · b / (T + 2/(2π · 30 Hz))
  EXPECT_NEAR(limits.max_stiffness, 81.8, 0.1);
  for (const double mass : {0.02, 0.1, 0.5, 2.0}) {
    EXPECT_LT(growth(mass, own, period, limits.max_stiffness, 0.0, 30.0), 0.9) << mass;
    EXPECT_LT(growth(mass, own, period, limits.max_stiffness, limits.max_damping, 30.0), 0.9) << mass;
  }
  EXPECT_GT(growth(0.1, own, period, passive_gains(own, period).stiffness, 0.0, 30.0), 1.0)
      << "what holds without the filter runs away behind it";
}

TEST(PassiveGains, CutOnlyWhatTheSheetAllowsBeyond) {
  DeviceLimits sheet;
  sheet.max_stiffness = 3000.0;
  sheet.max_damping = 0.1;
  sheet.max_rotational_stiffness = 1.0;
  sheet.max_rotational_damping = 1.0;
  const DeviceLimits limits = passive_limits(sheet, 1.0, 0.01, 0.001);
  EXPECT_NEAR(limits.max_stiffness, 950.0, 1e-9);
  EXPECT_EQ(limits.max_damping, 0.1);
  EXPECT_EQ(limits.max_rotational_stiffness, 1.0);
  EXPECT_NEAR(limits.max_rotational_damping, 0.00475, 1e-12);
}

}  // namespace
}  // namespace slosh
