// The slow push along a device's axes finds the arm that the simulated operator has.
#include "peer/devices/device_test.h"

#include <gtest/gtest.h>

#include "peer/devices/operator_device.h"

namespace slosh {
namespace {

DeviceTestReport push(
    const std::string& hand, const DeviceTestOptions& options = {},
    const std::function<bool()>& over = [] { return false; }) {
  OperatorDevice device(PoseTrack({}, Pose{}), parse_operator(hand).value());
  return test_device(device, options, over);
}

TEST(DeviceTest, FindsTheStiffnessDampingAndMassOfAnArm) {
  for (const char* grip : {"tight,correction=0", "loose,correction=0"}) {
    const OperatorSettings arm = parse_operator(grip).value();
    const DeviceTestReport report = push(grip);
    EXPECT_EQ(report.stopped, "");
    ASSERT_EQ(report.axes.size(), 6u);
    for (const DeviceTestAxis& axis : report.axes) {
      const ArmImpedance& wanted = axis.turning ? arm.wrist : arm.arm;
      ASSERT_TRUE(axis.moved) << axis.name;
      EXPECT_NEAR(axis.stiffness, wanted.stiffness, 1e-3 * wanted.stiffness) << axis.name;
      EXPECT_NEAR(axis.damping, wanted.damping, 5e-3 * wanted.damping) << axis.name;
      EXPECT_NEAR(axis.mass, wanted.mass, 2e-2 * wanted.mass) << axis.name;
      EXPECT_GT(axis.fit, 0.999);
    }
  }
}

TEST(DeviceTest, NeverPushesHarderThanItSays) {
  DeviceTestOptions options;
  options.force = 0.5;
  options.torque = 0.0;
  const DeviceTestReport report = push("tight", options);
  EXPECT_EQ(report.axes.size(), 3u);
  double most = 0.0;
  for (const DeviceTestAxis& axis : report.axes)
    for (const DeviceTestSample& s : axis.samples) most = std::max(most, std::abs(s.push));
  EXPECT_LE(most, 0.5);
  EXPECT_GT(most, 0.3);
}

TEST(DeviceTest, StopsWhenItIsToldOrTheHandFliesOrTheDeviceFallsSilent) {
  int asked = 0;
  EXPECT_EQ(push("tight", {}, [&] { return ++asked > 500; }).stopped, "it was interrupted");
  EXPECT_EQ(push("mass=0.05,stiffness=1,damping=0.1").stopped, "the hand moved faster than 0.5 m/s");
  class Silent final : public Device {
   public:
    DeviceReport read(const DeviceMoment&) override {
      DeviceReport report;
      report.heard = ++reads_ < 50;
      return report;
    }
    void write(const Wrench& on_hand) override { last = on_hand; }
    DeviceLimits limits() const override { return limits_without_a_hand(); }
    std::string kind() const override { return "silent"; }
    Wrench last{{1, 1, 1}, {1, 1, 1}};

   private:
    int reads_ = 0;
  } silent;
  const DeviceTestReport report = test_device(silent, {}, [] { return false; });
  EXPECT_EQ(report.stopped, "the device says nothing");
  EXPECT_EQ(silent.last.force, glm::dvec3(0.0));
  EXPECT_EQ(silent.last.torque, glm::dvec3(0.0));
}

}  // namespace
}  // namespace slosh
