// A device that measures force, moved as a mass and a damper: closed forms, and the bound that a hand sets.
#include <gtest/gtest.h>

#include <cmath>

#include "peer/devices/admittance_motion.h"
#include "peer/devices/passive_gains.h"

namespace slosh {
namespace {

constexpr double kPeriod = 0.001;  // s

Wrench along_x(double force, double torque = 0.0) {
  return {{force, 0.0, 0.0}, {torque, 0.0, 0.0}};
}

/// A device that is where it is told to be.
void follow(AdmittanceMotion& motion, const Wrench& by_hand) {
  motion.sense(motion.pose(), by_hand);
}

TEST(AdmittanceMotion, AConstantForceBringsItToForceOverDamping) {
  AdmittanceSettings s;
  s.mass = 2.0;
  s.damping = 8.0;
  s.inertia = 0.01;
  s.rotational_damping = 0.1;
  AdmittanceMotion motion(s);
  motion.begin({});
  for (int i = 0; i < 250;
       ++i) {  // one time constant, M/D = 0.25 s, by half from the hand and from the world
    follow(motion, along_x(1.0, 0.005));
    motion.advance(along_x(1.0, 0.005), kPeriod);
  }
  const double share = 1.0 - std::exp(-1.0);
  EXPECT_NEAR(motion.twist().linear.x, 0.25 * share, 2e-4);
  EXPECT_NEAR(motion.pose().position.x, 0.25 * 0.25 * (1.0 - share), 2e-4);
  EXPECT_NEAR(motion.twist().angular.x, 0.1 * (1.0 - std::exp(-2.5)), 5e-4);
  EXPECT_EQ(motion.twist().linear.y, 0.0);
}

TEST(AdmittanceMotion, IsNeverFasterThanItsDeviceNorAheadOfItByMoreThanItCanBeBehind) {
  AdmittanceSettings s;
  s.max_speed = 0.3;
  AdmittanceMotion motion(s);
  motion.begin({});
  Pose stuck;
  stuck.orientation = rotate_by(stuck.orientation, {0.1, 0.0, 0.0});
  motion.begin(stuck);
  for (int i = 0; i < 2000; ++i) {  // at an end stop
    motion.sense(stuck, along_x(50.0, 3.0));
    motion.advance(along_x(20.0, 1.0), kPeriod);
    ASSERT_LE(glm::length(motion.twist().linear), 0.3 + 1e-12);
    ASSERT_LE(glm::length(motion.twist().angular), s.max_turning + 1e-12);
    ASSERT_LE(motion.pose().position.x, motion.leash() + 1e-12);
  }
  EXPECT_NEAR(motion.pose().position.x, 2.0 * 0.3 * 0.005, 1e-12);
  EXPECT_NEAR(rotation_between(stuck.orientation, motion.pose().orientation).x, motion.turning_leash(), 1e-9);
  EXPECT_NEAR(motion.twist().linear.x, 0.0, 1e-12) << "and it does not count as moving";
  motion.stand();
  motion.advance({}, kPeriod);
  EXPECT_EQ(motion.twist().linear, glm::dvec3(0.0));
}

// With the hardest coupling that its damping is given (Colgate's bound, though a mass that is computed needs
// it less), to a wall: it swings and dies away by (D + B)/2M, as a mass on a spring does.
TEST(AdmittanceMotion, OnTheHardestCouplingASwingDiesAwayAsTheDampersSay) {
  AdmittanceSettings s;
  const PassiveGains gains = passive_gains(s.damping, kPeriod);
  AdmittanceMotion motion(s);
  Pose at;
  at.position.x = 0.001;
  motion.begin(at);
  double late = 0.0;
  for (int i = 0; i < 1000; ++i) {
    follow(motion, {});
    const double force =
        -gains.stiffness * motion.pose().position.x - gains.damping * motion.twist().linear.x;
    motion.advance(along_x(force), kPeriod);
    if (i >= 900) late = std::max(late, std::abs(motion.pose().position.x));
  }
  const double rate = (s.damping + gains.damping) / (2.0 * s.mass);
  EXPECT_NEAR(late, 0.001 * std::exp(-0.9 * rate), 0.15 * 0.001 * std::exp(-0.9 * rate));
}

/// How much wider a hand of `stiffness` N/m without mass and damping swings after 2 s, on a device that
/// follows by a first order; 0.1 ms a step, so that what is found is the lag's.
double swings_by(double stiffness, const AdmittanceSettings& s) {
  constexpr double kStep = 1e-4;
  AdmittanceMotion motion(s);
  Pose at;
  at.position.x = 1e-5;
  motion.begin(at);
  double place = at.position.x, early = 0.0, late = 0.0;
  for (int i = 0; i < 20000; ++i) {
    place += (motion.pose().position.x - place) * (1.0 - std::exp(-kStep / s.following));
    Pose measured;
    measured.position.x = place;
    motion.sense(measured, along_x(-stiffness * place));
    motion.advance({}, kStep);
    if (i < 5000) early = std::max(early, std::abs(place));
    if (i >= 15000) late = std::max(late, std::abs(place));
  }
  return late / early;
}

TEST(AdmittanceMotion, HoldsAHandUpToTheStiffnessThatRouthGives) {
  AdmittanceSettings s;  // 1 kg, 5 N·s/m, 5 ms
  s.max_speed = 1e3;     // nothing but the lag limits it
  const double bound = s.damping / s.following * (1.0 + s.damping * s.following / s.mass);  // 1025 N/m
  EXPECT_LT(swings_by(0.9 * bound, s), 0.8);
  EXPECT_GT(swings_by(1.1 * bound, s), 1.25);
  s.damping = 10.0;
  s.mass = 3.0;
  const double harder = s.damping / s.following * (1.0 + s.damping * s.following / s.mass);
  EXPECT_LT(swings_by(0.9 * harder, s), 0.9);
  EXPECT_GT(swings_by(1.1 * harder, s), 1.1);
}

}  // namespace
}  // namespace slosh
