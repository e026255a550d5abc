// A deadman button through the whole servo: no hold before it is pressed, no force once it is let go of, and
// no blow.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "peer/devices/hand_map.h"
#include "servo_kit.h"

namespace slosh {
namespace {

constexpr double kRate = 2000.0;  // N/s, as a Falcon's

/// An arm with a deadman button, as any that gives a force is mapped.
class ButtonedArm final : public Device {
 public:
  ButtonedArm() : map_(settings(), HandPlace{}) {}
  DeviceReport read(const DeviceMoment&) override { return map_.to_world(raw); }
  void write(const Wrench& on_hand) override { last = map_.filtered(on_hand); }
  DeviceLimits limits() const override {
    DeviceLimits limits = limits_without_a_hand();
    limits.max_force = 20.0;
    limits.max_force_rate = kRate;
    limits.engagement_time = 2.0;
    return limits;
  }
  bool immediate() const override { return true; }
  std::string kind() const override { return "buttoned"; }

  DeviceReport raw;
  Wrench last;

 private:
  static HandMapSettings settings() {
    HandMapSettings s;
    s.by_camera = false;
    s.deadman_button = 1;
    return s;
  }
  HandMap map_;
};

class Deadman : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = std::make_unique<ButtonedArm>();
    arm_ = made.get();
    ASSERT_TRUE(kit_.servo->set_device(0, std::move(made)));
  }
  void press(bool on) { arm_->raw.buttons = on ? 1u : 0u; }
  /// `seconds` of ticks, in which the world says what its coupling puts on the hand.
  void run(double seconds) {
    for (const double end = now_ + seconds; now_ < end; now_ += 0.001) {
      kit_.publish(now_);
      const double before = force();
      kit_.tick(now_);
      kit_.channel.pose(0).update();
      steepest_ = std::max(steepest_, std::abs(force() - before));
      most_ = std::max(most_, std::abs(force()));
      if (force() != 0.0) last_felt_ = now_;
    }
  }
  void forget() { steepest_ = most_ = 0.0; }
  double force() const { return arm_->last.force.x; }
  bool said_to_hold() { return kit_.channel.pose(0).front().engaged; }

  test::ServoKit kit_;
  ButtonedArm* arm_ = nullptr;
  double now_ = 0.0;
  double steepest_ = 0.0;   // N from tick to tick
  double most_ = 0.0;       // N
  double last_felt_ = 0.0;  // s
};

TEST_F(Deadman, HoldsOnlyWhileItIsPressedAndStrikesNobody) {
  run(0.1);
  arm_->raw.pose.position.x = 0.01;  // 10 N for who holds on
  run(1.0);
  EXPECT_EQ(most_, 0.0) << "nobody is taken hold of before it is pressed";
  EXPECT_FALSE(said_to_hold());

  arm_->raw.pose.position.x = 0.0;
  press(true);
  run(0.1);
  EXPECT_TRUE(said_to_hold());
  arm_->raw.pose.position.x = 0.01;
  run(3.0);
  EXPECT_NEAR(force(), -10.0, 0.01);
  EXPECT_LT(steepest_, 0.1) << "it comes over two seconds: 10 mm at once are this, a tenth of a second in";

  for (int again = 0; again < 3; ++again) {
    forget();
    press(false);
    const double released = now_;
    run(1.0);
    std::printf("zero %.0f ms after it was let go of, %.2f N at most from ms to ms\n",
                1e3 * (last_felt_ + 0.001 - released), steepest_);
    EXPECT_LT(last_felt_ - released, 0.02) << "10 N at 2000 N/s, and a jerk";
    EXPECT_LE(steepest_, 1.001e-3 * kRate);
    EXPECT_FALSE(said_to_hold());

    forget();
    press(true);
    run(0.05);
    EXPECT_TRUE(said_to_hold());
    EXPECT_LT(most_, 0.1) << "not at once";
    run(6.0);
    EXPECT_LT(steepest_, 0.05);
    EXPECT_NEAR(force(), -10.0, 0.1) << "and all of it in the end: the hold is where the hand is again";
  }
}

/// Let go of while its force still comes, and pressed again while it still goes.
TEST_F(Deadman, PressedAndLetGoOfAgainAndAgainStrikesNobody) {
  press(true);
  run(0.1);
  arm_->raw.pose.position.x = 0.01;
  run(3.0);
  forget();
  for (int i = 0; i < 40; ++i) {
    press(i % 2 != 0);
    run(0.002 + 0.037 * (i % 7));
  }
  EXPECT_LE(steepest_, 1.001e-3 * kRate);
  EXPECT_LE(most_, 10.01);
  press(false);
  run(0.5);
  EXPECT_EQ(force(), 0.0);
}

}  // namespace
}  // namespace slosh
