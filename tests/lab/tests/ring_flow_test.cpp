// The reference of a gap's flow, against closed forms.
#include "tests/lab/report/reference/ring_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace slosh::report {
namespace {

constexpr double kInner = 0.03, kOuter = 0.05, kViscosity = 1.0, kDensity = 1000.0;
constexpr double kPi = std::numbers::pi;

TEST(RingFlow, EvenlyItsTorqueIsCouettes) {
  RingFlow flow(kInner, kOuter, kViscosity, kDensity);
  for (int i = 0; i < 1000; ++i) flow.step(1e-3, 1.0, 0.0);
  const double r1 = kInner * kInner, r2 = kOuter * kOuter;
  const double expected = 4.0 * kPi * kViscosity * r1 * r2 / (r2 - r1);
  EXPECT_NEAR(flow.inner_torque(), expected, 1e-5 * expected);
  const double middle = 0.04 * 0.04;
  EXPECT_NEAR(flow.turning_at(0.04), r1 / (r2 - r1) * (r2 / middle - 1.0), 1e-6);
}

// u = ωr in the walls' frame has μ(u'' + u'/r − u/r²) = ραr: u = (ρα/8μ)(r³ + A r + B/r).
TEST(RingFlow, StaysBehindWallsThatTurnFasterAndFaster) {
  constexpr double kGain = 10.0, kStep = 1e-4;
  RingFlow flow(kInner, kOuter, kViscosity, kDensity);
  double turning = 0.0;
  for (int i = 0; i < 5000; ++i) {
    turning += kGain * kStep;
    flow.step(kStep, turning, turning);
  }
  const double r1 = kInner * kInner, r2 = kOuter * kOuter;
  // Zero at both walls: r⁴ + A r² + B = (r² − R₁²)(r² − R₂²).
  const auto lag = [&](double r) {
    return kDensity * kGain / (8.0 * kViscosity) * (r * r - r1) * (r * r - r2) / (r * r);
  };
  // A step ends at its walls' turning and is half a step behind it in between.
  for (const double r : {0.032, 0.04, 0.048})
    EXPECT_NEAR(flow.turning_at(r) - turning, lag(r), 2e-3 * std::abs(lag(r))) << r;
}

// Long before the far wall is felt: a plate that starts has μU/√(πνt); a rod's bend adds μU/(2R) to first
// order, and turning takes another μU/R of what a plate has not (ω, not u, is what is even inside).
TEST(RingFlow, BeginsAsAPlateThatSuddenlyMoves) {
  constexpr double kTime = 2e-4, kNu = kViscosity / kDensity;
  RingFlow flow(kInner, kOuter, kViscosity, kDensity, 2000);
  for (int i = 0; i < 400; ++i) flow.step(kTime / 400, 1.0, 0.0);
  const double flat = kViscosity * kInner / std::sqrt(kPi * kNu * kTime);
  const double bent = flat + 1.5 * kViscosity;
  EXPECT_NEAR(flow.inner_torque() / (2.0 * kPi * kInner * kInner), bent, 2e-3 * bent);
}

// What the inner wall gave is what the fluid has.
TEST(RingFlow, KeepsAngularMomentum) {
  constexpr double kStep = 1e-5;
  RingFlow flow(kInner, kOuter, kViscosity, kDensity);
  double given = 0.0, before = 0.0;
  for (int i = 0; i < 300; ++i) {
    flow.step(kStep, 1e3 * kStep * i, 0.0);
    given += 0.5 * kStep * (before + flow.inner_torque());
    before = flow.inner_torque();
  }
  double has = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const double r = kInner + (kOuter - kInner) * (i + 0.5) / 4000.0;
    has += 2.0 * kPi * kDensity * std::pow(r, 3) * flow.turning_at(r) * (kOuter - kInner) / 4000.0;
  }
  EXPECT_NEAR(given, has, 5e-3 * has);
}

}  // namespace
}  // namespace slosh::report
