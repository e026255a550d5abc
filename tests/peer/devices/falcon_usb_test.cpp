// The Falcon's driver, unmodified down to libusb, on a USB device that umockdev makes.
#include "peer/devices/falcon_usb.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <thread>
#include <utility>

#include "net/clock.h"
#include "net/histogram.h"
#include "peer/devices/falcon_device.h"
#include "peer/haptics/real_time.h"
#include "tests/peer/devices/mocked_falcon.h"
#include "tests/peer/devices/own_folder.h"
#include "tests/peer/servo_kit.h"
#include "tests/support/process.h"

namespace slosh {
namespace {

using test::FakeFalcon;
using test::MockedFalcon;

class FalconUsb : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_.path() / "slosh" / "devices");
    falcon_ = fresh();
    std::ofstream(folder_.path() / "firmware.bin", std::ios::binary)
        .write(reinterpret_cast<const char*>(falcon_.firmware.data()), 7357);
    std::ofstream(folder_.path() / "slosh" / "devices" / "falcon.conf")
        << "firmware = " << (folder_.path() / "firmware.bin").string()
        << "\nscale = 1\nrelative_to = world\n";
  }
  /// As after power-up.
  static FakeFalcon fresh() {
    FakeFalcon falcon;
    for (int i = 0; i < 7357; ++i) falcon.firmware.push_back(static_cast<std::uint8_t>(i * 31 + i / 251));
    falcon.homed = false;
    return falcon;
  }
  static std::array<int, 3> motors_of(const FalconPacket& packet) { return parse_falcon(packet)->counts; }

  test::OwnFolder folder_;
  const test::SetVariable config_{"XDG_CONFIG_HOME", folder_.path()};
  test::MockedMachine machine_;
  FakeFalcon falcon_;
};

constexpr std::array<int, 3> kNoForce{0, 0, 0};

TEST_F(FalconUsb, GetsItsFirmwareAndNoForceUntilItKnowsItsPlace) {
  MockedFalcon plugged(machine_, falcon_, 4);
  FalconDevice device([] { return open_falcon(""); }, HandPlace{});
  const Result<bool> opened = open_device(device);
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_EQ(falcon_.received, falcon_.firmware);
  for (int i = 0; i < 10; ++i) {
    EXPECT_FALSE(device.read({}).heard);
    device.write({{3.0, 0.0, 0.0}, {}});
    EXPECT_EQ(motors_of(falcon_.commands.back()), kNoForce);
  }
  plugged.with([](FakeFalcon& f) { f.homed = true; });
  while (!device.read({}).heard) device.write({{3.0, 0.0, 0.0}, {}});
  device.write({{3.0, 0.0, 0.0}, {}});
  EXPECT_NE(motors_of(falcon_.commands.back()), kNoForce);
  device.close();
  EXPECT_EQ(motors_of(falcon_.commands.back()), kNoForce);
}

/// With the frames of the bus, by the clock: how quick it is is told, as the machine may have other work;
/// that no report is missing, none comes twice and each has its answer is no matter of time.
TEST_F(FalconUsb, ThreeThousandReportsAtAKilohertzWithoutAGap) {
  falcon_.homed = true;
  falcon_.counts = true;
  MockedFalcon plugged(machine_, falcon_, 4, MockedFalcon::Pace::kFrames);
  FalconDevice device([] { return open_falcon(""); }, HandPlace{});
  const Result<bool> opened = open_device(device);
  ASSERT_TRUE(opened) << opened.error().text();
  constexpr int kReports = 3000;
  Histogram apart;
  std::size_t commands = 0;
  std::int64_t begin_ns = 0, last_ns = 0;
  std::uint32_t last_number = 0;
  int reports = 0;
  // As a device's own thread is (DevicePort).
  std::thread([&] {
    become_device_thread("slosh-hand");
    for (int i = 0; i < kReports; ++i) {
      const DeviceReport report = device.read({});
      const std::int64_t now_ns = steady_now_ns();
      reports += report.heard ? 1 : 0;
      if (i == 0) {
        begin_ns = now_ns;
        commands = plugged.with([](FakeFalcon& f) { return f.commands.size(); });
      } else {
        apart.add(to_seconds(now_ns - last_ns));
        EXPECT_EQ(report.buttons, (last_number + 1) % 16) << "report " << i;
      }
      last_ns = now_ns;
      last_number = report.buttons;
      device.write({{1.0, 0.0, 0.0}, {}});
    }
  }).join();
  EXPECT_EQ(reports, kReports);
  EXPECT_EQ(plugged.with([](FakeFalcon& f) { return f.commands.size(); }) - commands,
            static_cast<std::size_t>(kReports))
      << "one packet of motor values a report";
  const double khz = 1e-3 * (kReports - 1) / to_seconds(last_ns - begin_ns);
  std::printf("%d reports by libusb at %.3f kHz; apart by %.3f ms in the middle, p99 %.3f, longest %.3f\n",
              reports, khz, 1e3 * apart.percentile(0.5), 1e3 * apart.percentile(0.99), 1e3 * apart.max());
  RecordProperty("khz", std::to_string(khz));
  EXPECT_LE(khz, 1.001) << "no quicker than the bus";
}

/// By the program, as a person meets it.
TEST_F(FalconUsb, AFirmwareThatComesBackOtherwiseStopsItAndSaysWhatWhereAndHowToMendIt) {
  falcon_.corrupt_at = 700;
  const MockedFalcon plugged(machine_, falcon_, 4);
  const test::Outcome outcome =
      test::Process({SLOSH_PROGRAM, "devices", "--live", "--device", "falcon"}, folder_.path()).wait();
  EXPECT_EQ(outcome.code, 1);
  // 700·31 + 700/251, and its bit 4 the other way.
  for (const char* words : {"usb 1-4, /dev/bus/usb/001/004", "byte 700 of 7357: c6 was sent, d6 came",
                            "Unplug it and its power", "another cable"})
    EXPECT_NE(outcome.err.find(words), std::string::npos) << words << "\n" << outcome.err;
  EXPECT_EQ(falcon_.received.size(), 744u) << "nothing more than the piece that came back otherwise";
  EXPECT_TRUE(falcon_.commands.empty() ||
              std::all_of(falcon_.commands.begin(), falcon_.commands.end(),
                          [](const FalconPacket& c) { return motors_of(c) == kNoForce; }));
}

/// Through everything that runs in a session: port, servo, limits. The world pulls by 5 N all the time.
TEST_F(FalconUsb, UnpluggedInTheMiddleItsForceEndsAndComesBackWithIt) {
  falcon_.homed = true;
  auto plugged = std::make_unique<MockedFalcon>(machine_, falcon_, 4);
  auto made = std::make_unique<FalconDevice>([] { return open_falcon(""); }, HandPlace{});
  ASSERT_TRUE(open_device(*made));
  test::ServoKit kit;
  ASSERT_TRUE(kit.servo->set_device(0, std::move(made)));
  double felt = 0.0;  // N, of the newest row
  int states = 0;
  GripState grip;
  grip.pose.position = {0.005, 0.0, 0.0};
  const auto tick = [&] {
    test::publish_ahead(kit.channel, ++states, {grip});
    kit.servo->tick(steady_now_ns());
    ServoSample sample;
    while (kit.servo->samples().pop(sample)) felt = glm::length(sample.on_hand.force);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  /// N that the motors put on the hand by the last packet.
  const auto given = [&](MockedFalcon& of) {
    return of.with([](FakeFalcon& f) {
      const std::array<int, 3> motors = f.commands.empty() ? kNoForce : motors_of(f.commands.back());
      bool reachable = false;
      const FalconAngles angles = falcon_angles(f.grip, reachable);
      const glm::dvec3 torques(motors[0] / -1e4, motors[1] / -1e4, motors[2] / -1e4);
      return (glm::transpose(falcon_jacobian(f.grip, angles)) * torques).x;
    });
  };
  const auto until = [&](const char* what, auto&& there) {
    for (int i = 0; i < 60000; ++i) {
      if (there()) return true;
      tick();
    }
    ADD_FAILURE() << "never: " << what << "; " << kit.servo->failure(0) << ", felt " << felt << " N";
    return false;
  };
  // 5 mm of a spring of 950 N/m, which is what its damping holds.
  ASSERT_TRUE(until("its force", [&] { return std::abs(given(*plugged) - 4.75) < 0.1; }));
  EXPECT_EQ(kit.servo->failure(0), "");

  plugged->unplug();
  ASSERT_TRUE(until("said", [&] { return kit.servo->failure(0).find("cable") != std::string::npos; }));
  ASSERT_TRUE(until("no force", [&] { return felt == 0.0; }));
  for (int i = 0; i < 100; ++i) {
    tick();
    EXPECT_EQ(felt, 0.0) << "and none as long as it is out";
  }

  // Its power was out, too: without firmware and without its place.
  FakeFalcon back = fresh();
  MockedFalcon again(machine_, back, 5);
  ASSERT_TRUE(until("found", [&] {
    return kit.servo->failure(0).find("pull its grip out") != std::string::npos &&
           again.with([](FakeFalcon& f) { return !f.commands.empty(); });
  }));
  EXPECT_EQ(again.with([](FakeFalcon& f) { return f.received; }), back.firmware);
  for (int i = 0; i < 100; ++i) tick();
  again.with([](FakeFalcon& f) {
    for (const FalconPacket& command : f.commands) EXPECT_EQ(motors_of(command), kNoForce);
    f.homed = true;
  });
  ASSERT_TRUE(until("its force again", [&] { return std::abs(given(again) - 4.75) < 0.1; }));
  EXPECT_EQ(kit.servo->failure(0), "");
  // It came bit by bit over two seconds of ticks, however many of them the device's thread was awake for.
  const auto [steepest, most] = again.with([](FakeFalcon& f) {
    std::pair<int, int> both{0, 0};
    for (std::size_t i = 1; i < f.commands.size(); ++i) {
      for (std::size_t m = 0; m < 3; ++m) {
        const int now = motors_of(f.commands[i])[m], before = motors_of(f.commands[i - 1])[m];
        both = {std::max(both.first, std::abs(now - before)), std::max(both.second, std::abs(now))};
      }
    }
    return both;
  });
  std::printf("the force came back in steps of at most %d of %d of the motors' units\n", steepest, most);
  EXPECT_LT(2 * steepest, most) << "never at once";
  kit.servo->close_devices();
  EXPECT_EQ(motors_of(back.commands.back()), kNoForce) << "zero last";
}

}  // namespace
}  // namespace slosh
