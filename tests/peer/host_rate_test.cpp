// What a hand feels of a host that is slower than the hand: against one of 1 kHz, and in which tick.
// Deterministic: a clock that the test moves (hand_rig.h).
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstdio>

#include "hand_rig.h"
#include "tests/physics/fluid_wrench_kit.h"

namespace slosh {
namespace {

using test::FeltTick;
using test::HandRig;
using test::RigOptions;

/// A hand that goes its way whatever the force: to and fro by 30 mm at 1 Hz, with a tremor; or stands, and
/// then is elsewhere.
class LedHand final : public Device {
 public:
  explicit LedHand(const Pose& start, double jumps = -1.0) : start_(start), jumps_(jumps) {}
  DeviceReport read(const DeviceMoment& moment) override {
    DeviceReport report;
    report.pose = start_;
    if (jumps_ > 0.0) {
      report.pose.position.x += moment.time >= jumps_ ? 0.002 : 0.0;
      return report;
    }
    const double t = moment.time, in = std::min(t, 1.0), swell = in * in * (3.0 - 2.0 * in);
    for (const auto& [size, pace] : {std::pair{0.03, 1.0}, {2e-4, 8.3}, {2e-4, 11.9}}) {
      const double w = 2.0 * lab::kPi * pace;
      report.pose.position.x += swell * size * std::sin(w * t);
      report.twist.linear.x += swell * size * w * std::cos(w * t);
      if (t < 1.0) report.twist.linear.x += 6.0 * t * (1.0 - t) * size * std::sin(w * t);
    }
    return report;
  }
  DeviceLimits limits() const override { return limits_without_a_hand(); }
  bool immediate() const override { return true; }
  bool goes_with_world() const override { return true; }
  std::string kind() const override { return "led"; }

 private:
  Pose start_;
  double jumps_;
};

std::vector<FeltTick> led(double viscosity, RigOptions options, double seconds, double jumps = -1.0) {
  const Scene scene = lab::spoon_in(viscosity);
  const double step = 0.001 * options.sub_steps;
  if (!options.step_takes) options.step_takes = [step](double) { return 0.5 * step; };
  HandRig rig(scene, std::make_unique<LedHand>(grip_start(scene, 0), jumps), options);
  rig.run(seconds);
  return rig.ticks();
}

/// Amplitude along x at `rate` Hz from 1 s on, over the force's RMS about its mean.
double tone(const std::vector<FeltTick>& ticks, double rate) {
  std::complex<double> sum = 0.0;
  double all = 0.0, square = 0.0, count = 0.0;
  for (const FeltTick& tick : ticks) {
    if (tick.wall < 1.0 || tick.wall >= 3.0) continue;
    const double f = tick.on_hand.force.x;
    sum += f * std::polar(1.0, -2.0 * lab::kPi * rate * tick.wall);
    all += f;
    square += f * f;
    count += 1.0;
  }
  return 2.0 * std::abs(sum) / count / std::sqrt(square / count - all * all / (count * count));
}

/// A spoon in 2 Pa·s at a host of 100 Hz.
TEST(HostRate, ASpoonInSyrupIsFeltAsAtAHostOf1kHz) {
  RigOptions fine;
  fine.sub_steps = 1;
  fine.models = false;  // the host's body as it comes
  const std::vector<FeltTick> reference = led(2.0, fine, 3.0);
  RigOptions coarse;
  coarse.sub_steps = 10;
  const std::vector<FeltTick> told = led(2.0, coarse, 3.0);
  coarse.models = false;
  const std::vector<FeltTick> bare = led(2.0, coarse, 3.0);
  const double off = force_off(told, reference, 1.0, 2.95), untold = force_off(bare, reference, 1.0, 2.95);
  std::printf(
      "host at 100 Hz: force off by %.2f %%, tone %.3f %%; the host's body as it comes: %.1f %%, %.2f %%\n",
      1e2 * off, 1e2 * tone(told, 100.0), 1e2 * untold, 1e2 * tone(bare, 100.0));
  EXPECT_LE(off, 0.03);                // 0.10 is asked for
  EXPECT_LE(tone(told, 100.0), 5e-4);  // 0.01
  EXPECT_GT(untold, 3.0 * off);
}

/// Own motion is felt in the tick that reads it, however slow the host's steps and the world are.
TEST(HostRate, OwnMotionIsFeltInItsTick) {
  for (const auto& [sub_steps, slower] : {std::pair{10, 0.5}, {2, 3.0}}) {
    {
      RigOptions options;
      options.sub_steps = sub_steps;
      const double takes = slower * 0.001 * sub_steps;
      options.step_takes = [takes](double) { return takes; };
      constexpr double kJumps = 0.6;  // s
      const std::vector<FeltTick> ticks = led(2.0, options, kJumps + 0.1, kJumps);
      std::size_t moved = 0;
      while (moved < ticks.size() && ticks[moved].time < kJumps) moved += 1;
      ASSERT_LT(moved, ticks.size());
      const double change = ticks[moved].on_hand.force.x - ticks[moved - 1].on_hand.force.x;
      std::printf("host's steps of %d ms, %.1f times their time: %.2f N in the tick of 2 mm at 1000 N/m\n",
                  sub_steps, slower, change);
      EXPECT_NEAR(change, -2.0, 0.2);
    }
  }
}

}  // namespace
}  // namespace slosh
