// Plug-ins that go wrong, real libraries: each is contained and named, its hand is asked for no force after
// 400 ms, and the other hand on the same loop goes on.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>

#include "peer/haptics/device_loop.h"
#include "plugin_kit.h"
#include "tests/peer/other_hand.h"
#include "tests/support/comes.h"

namespace slosh {
namespace {

using test::comes;
using test::plugin;
using test::Plugins;

struct Case {
  const char* name;
  const char* words;  // null: nothing can be said of a device that does not answer
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}
std::string short_name(const ::testing::TestParamInfo<Case>& info) {
  return std::string(info.param.name).substr(sizeof "slosh_plugin_" - 1);
}

class RefusedPlugins : public Plugins, public ::testing::WithParamInterface<Case> {};

TEST_P(RefusedPlugins, AreNamed) {
  auto device = plugin(GetParam().name);
  const Result<bool> opened = open_device(*device);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().text().find(GetParam().words), std::string::npos) << opened.error().text();
  EXPECT_FALSE(opened.error().mend.empty());
}
INSTANTIATE_TEST_SUITE_P(
    , RefusedPlugins,
    ::testing::Values(Case{"slosh_plugin_other_version", "version 4"},
                      Case{"slosh_plugin_lacks_move", "lacks the function slosh_device_move"},
                      Case{"slosh_plugin_no_speed", "max_speed_m_s is not a number above 0"},
                      Case{"slosh_plugin_lacks_write", "lacks the function slosh_device_write"},
                      Case{"slosh_plugin_throws_in_open", "threw: no licence"},
                      Case{"slosh_plugin_throws_in_capabilities", "threw: no data sheet"},
                      Case{"slosh_plugin_nan_capability", "max_force"},
                      Case{"slosh_plugin_blocks_in_open", "did not return within 5 s"},
                      Case{"slosh_plugin_blocks_in_capabilities", "did not return within 5 s"},
                      Case{"slosh_plugin_no_such_library", "cannot be loaded"}),
    short_name);

/// What a faulty library says of itself (faulty_plugin.cpp).
template <class T>
std::atomic<T>& said_by(const std::string& name, const char* what) {
  void* const library = dlopen(test::library(name).c_str(), RTLD_NOW | RTLD_NOLOAD);
  return *static_cast<std::atomic<T>*>(dlsym(library, what));
}

/// A faulty plug-in and another hand on a running loop.
class HeldPlugins : public Plugins {
 protected:
  void begin(const std::string& name) {
    channel_ = test::channel_of_two(scene_);
    std::vector<std::unique_ptr<Device>> devices;
    devices.push_back(plugin(name));
    const Result<bool> opened = open_device(*devices[0]);
    ASSERT_TRUE(opened) << opened.error().text();
    limits_ = devices[0]->limits();
    devices.push_back(std::make_unique<test::OtherDevice>(other_, *channel_, 20));
    ServoOptions options;
    options.sample_interval = 0.001;
    options.sample_capacity = 1 << 16;
    servo_ = std::make_unique<Servo>(scene_, std::move(devices), *channel_, options);
    loop_ = std::make_unique<DeviceLoop>(*servo_);
    loop_->start();
  }
  /// What the loop asked of the plug-in's device so far.
  double asked() {
    ServoSample sample;
    while (servo_->samples().pop(sample)) {
      if (sample.device != 0) continue;
      steepest_ = std::max(steepest_, glm::length(sample.on_hand.force - last_.force));
      last_ = sample.on_hand;
    }
    return glm::length(last_.force);
  }

  Scene scene_ = test::one_grip_scene();
  std::shared_ptr<test::OtherHand> other_ = std::make_shared<test::OtherHand>();
  std::unique_ptr<Channel> channel_;
  std::unique_ptr<Servo> servo_;
  std::unique_ptr<DeviceLoop> loop_;
  DeviceLimits limits_;
  Wrench last_;
  double steepest_ = 0.0;  // N from sample to sample
};

class FaultyWhileHeld : public HeldPlugins, public ::testing::WithParamInterface<Case> {};

TEST_P(FaultyWhileHeld, IsAskedForNoForceAfter400msAndStopsNoOtherHand) {
  const std::string name = GetParam().name;
  ASSERT_NO_FATAL_FAILURE(begin(name));
  ASSERT_TRUE(comes([&] { return asked() > 1.0; })) << "it comes over two seconds";
  said_by<bool>(name, "faulty_now") = true;
  auto& since_ns = said_by<std::int64_t>(name, "faulty_since_ns");
  ASSERT_TRUE(comes([&] { return since_ns != 0; }));
  const std::uint64_t before = other_->writes;
  steepest_ = 0.0;
  ASSERT_TRUE(comes([&] { return asked() == 0.0; }));
  const double took = to_seconds(steady_now_ns() - since_ns);
  // 1 kHz is what it has; half of that on a machine with other work.
  std::this_thread::sleep_for(std::chrono::milliseconds(600));
  const double rate = static_cast<double>(other_->writes - before) / to_seconds(steady_now_ns() - since_ns);
  std::printf("asked for none %.0f ms after; %.2f N at most from ms to ms; the other hand at %.0f Hz\n",
              1e3 * took, steepest_, rate);
  // This thread looks each 2 ms, and the device had said its last up to a period and a turn before.
  EXPECT_LT(took, kSilent + 0.05);
  EXPECT_LE(steepest_, 1.001e-3 * limits_.max_force_rate);
  EXPECT_GT(rate, 500.0);
  EXPECT_EQ(asked(), 0.0) << "and for none after that";
  EXPECT_NEAR(other_->felt, -10.0, 1e-6) << "the other hand holds on";
  EXPECT_TRUE(servo_->failure(1).empty());
  if (GetParam().words != nullptr) {
    EXPECT_NE(servo_->failure(0).find(GetParam().words), std::string::npos) << servo_->failure(0);
  }
  if (name.find("nan_reading") != std::string::npos) {
    EXPECT_EQ(said_by<double>(name, "faulty_force"), 0.0) << "which it was sent, as it can be";
  }
  loop_->stop();
  servo_->close_devices();  // returns
}
INSTANTIATE_TEST_SUITE_P(, FaultyWhileHeld,
                         ::testing::Values(Case{"slosh_plugin_throws_in_read",
                                                "threw from read: the cable is out"},
                                           Case{"slosh_plugin_throws_in_write", "threw from write"},
                                           Case{"slosh_plugin_throws_in_move", "threw from move"},
                                           Case{"slosh_plugin_nan_force", "no force of the hand"},
                                           Case{"slosh_plugin_gone", "its device is gone"},
                                           Case{"slosh_plugin_nan_reading", "no number"},
                                           Case{"slosh_plugin_blocks_in_read", nullptr},
                                           Case{"slosh_plugin_blocks_in_write", nullptr},
                                           Case{"slosh_plugin_blocks_in_move", nullptr}),
                         short_name);

class FaultyAtItsEnd : public HeldPlugins, public ::testing::WithParamInterface<Case> {};

/// Taken away while the loop runs: its hand has been given zero, the other hand goes on, and nobody waits for
/// ever.
TEST_P(FaultyAtItsEnd, IsGivenZeroAndStopsNoOtherHand) {
  const std::string name = GetParam().name;
  ASSERT_NO_FATAL_FAILURE(begin(name));
  ASSERT_TRUE(comes([&] { return asked() > 1.0; }));
  steepest_ = 0.0;
  const std::int64_t parted_ns = steady_now_ns();
  ASSERT_TRUE(servo_->set_device(0, nullptr));
  ASSERT_TRUE(comes([&] { return asked(), said_by<double>(name, "faulty_force") == 0.0; }));
  const double took = to_seconds(steady_now_ns() - parted_ns);
  std::printf("zero %.0f ms after it was taken away, %.2f N at most from ms to ms\n", 1e3 * took, steepest_);
  EXPECT_LT(took, kSilent + 0.05);
  EXPECT_LE(steepest_, 1.001e-3 * limits_.max_force_rate);
  // Closed by the control thread, which waits for a second at most, while the loop goes on.
  const std::uint64_t before = other_->writes;
  const std::int64_t begin_ns = steady_now_ns();
  ASSERT_TRUE(servo_->set_device(0, nullptr));
  const double closing = to_seconds(steady_now_ns() - begin_ns);
  ASSERT_TRUE(comes([&] { return other_->writes > before + 300; }));
  EXPECT_GT(static_cast<double>(other_->writes - before) / to_seconds(steady_now_ns() - begin_ns), 500.0);
  EXPECT_LT(closing, PluginDevice::kCloseWait + DevicePort::kStopWait + 1.0);
  EXPECT_NEAR(other_->felt, -10.0, 1e-6);
  loop_->stop();
  servo_->close_devices();
}
INSTANTIATE_TEST_SUITE_P(, FaultyAtItsEnd,
                         ::testing::Values(Case{"slosh_plugin_throws_in_close", "threw: it is in use"},
                                           Case{"slosh_plugin_blocks_in_close", "did not return within 1 s"}),
                         short_name);

TEST_F(Plugins, WhatGoesWrongAtItsEndIsNamed) {
  for (const Case& c : {Case{"slosh_plugin_throws_in_close", "threw: it is in use"},
                        Case{"slosh_plugin_blocks_in_close", "did not return within 1 s"}}) {
    auto device = plugin(c.name);
    ASSERT_TRUE(open_device(*device));
    device->close();
    EXPECT_NE(device->trouble().find(c.words), std::string::npos) << device->trouble();
    device->close();  // again, as it may be
  }
}

}  // namespace
}  // namespace slosh
