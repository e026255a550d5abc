// The Falcon's mechanism, protocol and driver, against closed forms and a device at the level of transfers.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "peer/devices/falcon_device.h"
#include "tests/peer/devices/fake_falcon.h"
#include "tests/peer/devices/own_folder.h"

namespace slosh {
namespace {

using test::FakeFalcon;
using test::FakeFalconLink;

template <class Each>
void everywhere(Each&& each) {
  for (double x = -0.05; x <= 0.051; x += 0.02)
    for (double y = -0.05; y <= 0.051; y += 0.02)
      for (double z = 0.105; z <= 0.176; z += 0.01) each(glm::dvec3(x, y, z));
}

TEST(FalconKinematics, AnglesOfKnownPlaces) {
  // By Stamper's quadratic in tan(θ/2), worked out apart from this code.
  struct Case {
    glm::dvec3 grip;
    FalconAngles angles;
  };
  const Case cases[] = {Case{{0.0, 0.0, 0.15}, {0.824550668341, 0.824550668341, 0.824550668341}},
                        Case{{0.03, -0.02, 0.16}, {1.331553646650, 0.752156982602, 1.157610072963}},
                        Case{{0.0, 0.0, 0.125}, {0.483618370935, 0.483618370935, 0.483618370935}},
                        Case{{-0.02, 0.04, 0.11}, {-0.129328406646, 0.764044485359, 0.640816557642}}};
  for (const Case& c : cases) {
    bool reachable = false;
    const FalconAngles angles = falcon_angles(c.grip, reachable);
    EXPECT_TRUE(reachable);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(angles[i], c.angles[i], 1e-11) << i;
  }
  bool reachable = true;
  falcon_angles({0.0, 0.0, 0.4}, reachable);
  EXPECT_FALSE(reachable);
}

TEST(FalconKinematics, ThereAndBackAgainEverywhere) {
  int places = 0;
  everywhere([&](const glm::dvec3& grip) {
    bool reachable = false;
    const FalconAngles angles = falcon_angles(grip, reachable);
    if (!reachable) return;
    const std::optional<glm::dvec3> back = falcon_grip(angles, {0.0, 0.0, kFalconMiddle});
    ASSERT_TRUE(back) << grip.x << ' ' << grip.y << ' ' << grip.z;
    EXPECT_LT(glm::distance(*back, grip), 1e-9);
    ++places;
  });
  EXPECT_GT(places, 200);
  EXPECT_FALSE(falcon_grip({3.0, -3.0, 1.0}, {0.0, 0.0, kFalconMiddle})) << "no grip has such angles";
}

TEST(FalconKinematics, TheJacobianIsTheSlopeOfTheAngles) {
  everywhere([](const glm::dvec3& grip) {
    bool reachable = false;
    const FalconAngles angles = falcon_angles(grip, reachable);
    if (!reachable || std::abs(grip.x) > 0.04 || std::abs(grip.y) > 0.04) return;
    const glm::dmat3 j = falcon_jacobian(grip, angles);
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 step(0.0);
      step[axis] = 1e-7;
      bool fine = true;
      const FalconAngles more = falcon_angles(grip + step, fine);
      const FalconAngles less = falcon_angles(grip - step, fine);
      for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(j[axis][static_cast<int>(i)], (more[i] - less[i]) / 2e-7, 1e-4);
    }
    const glm::dvec3 force(1.0, -2.0, 0.5);
    const std::optional<glm::dvec3> torques = falcon_torques(grip, angles, force);
    ASSERT_TRUE(torques);
    EXPECT_LT(glm::distance(glm::transpose(j) * *torques, force), 1e-9) << "virtual work";
  });
}

TEST(FalconProtocol, PacketsGoThereAndBack) {
  const FalconPacket command = falcon_command({4096, -1, 9999}, kFalconGreen | kFalconHoming);
  EXPECT_EQ(std::string(command.begin(), command.end()), "<AAABPPPPAAABDA>") << "low nibble first, from 'A'";
  FalconPacket report = command;
  report[13] = 0x41 + 0x74;
  const std::optional<FalconState> state = parse_falcon(report);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->counts, (std::array<int, 3>{4096, -1, 4096}));
  EXPECT_EQ(state->buttons, 4);
  EXPECT_TRUE(state->homed);
  report[13] = 0x41 + 0x30;
  EXPECT_FALSE(parse_falcon(report)->homed) << "two arms of three";
  report[4] = 'Z';
  EXPECT_FALSE(parse_falcon(report));
}

TEST(FalconProtocol, AStreamFindsItsPacketsWhereverTheyBegin) {
  FalconPacket packet = falcon_command({7, 8, 9}, 0);
  std::vector<std::uint8_t> bytes{'<', 'x', '>', '<'};
  for (int i = 0; i < 3; ++i) {
    packet[1] = static_cast<std::uint8_t>(0x41 + i);
    for (const std::uint8_t byte : packet) bytes.push_back(byte);
  }
  for (const std::size_t piece : {1u, 5u, 16u, 62u}) {
    FalconStream stream;
    int found = 0;
    std::optional<FalconState> last;
    for (std::size_t at = 0; at < bytes.size(); at += piece) {
      if (const auto state = stream.add(bytes.data() + at, std::min(piece, bytes.size() - at))) {
        last = state;
        ++found;
      }
    }
    ASSERT_TRUE(last) << piece;
    EXPECT_EQ(last->counts[0], 2);
    EXPECT_GE(found, 1);
  }
  FalconStream stream;
  const std::vector<std::uint8_t> noise(10000, '<');
  EXPECT_FALSE(stream.add(noise.data(), noise.size()));
}

class Falcon : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_ / "slosh" / "devices");
    setenv("XDG_CONFIG_HOME", folder_.c_str(), 1);
    for (std::size_t i = 0; i < 7357; ++i)
      falcon_.firmware.push_back(static_cast<std::uint8_t>((i * 31 + i / 251) & 0xff));
    std::ofstream(folder_ / "firmware.bin", std::ios::binary)
        .write(reinterpret_cast<const char*>(falcon_.firmware.data()), 7357);
    settings("firmware = " + (folder_ / "firmware.bin").string() + "\nrelative_to = world\nscale = 1\n");
  }
  void settings(const std::string& text) {
    std::ofstream(folder_ / "slosh" / "devices" / "falcon.conf") << text;
  }
  std::unique_ptr<FalconDevice> make() {
    return std::make_unique<FalconDevice>(
        [this]() -> Result<std::unique_ptr<FalconLink>> {
          opened_ += 1;
          if (falcon_.gone) return Error{"Falcon", "none is there", "Plug it in"};
          return std::unique_ptr<FalconLink>(std::make_unique<FakeFalconLink>(falcon_));
        },
        HandPlace{}, [this] { return falcon_.now_ns; });
  }

  FakeFalcon falcon_;
  std::size_t opened_ = 0;
  test::OwnFolder own_;
  const std::filesystem::path folder_ = own_.path();
};

TEST_F(Falcon, IsGreetedAndGetsItsFirmwareCheckedByItsEcho) {
  const auto device = make();
  const Result<bool> opened = open_device(*device);
  ASSERT_TRUE(opened) << opened.error().text();
  EXPECT_EQ(falcon_.received, falcon_.firmware);
  // The chip's requests of the facts sheet, after the first try for packets.
  const std::vector<std::pair<int, int>> wanted{{0, 1},    {0, 2},      {9, 16},     {3, 0x4138}, {4, 8},
                                                {2, 0},    {1, 0x0200}, {1, 0x0100}, {1, 0x0101}, {1, 0x0100},
                                                {3, 0x15}, {9, 1},      {3, 2},      {0, 1},      {0, 2}};
  ASSERT_GE(falcon_.requests.size(), wanted.size());
  EXPECT_TRUE(std::equal(wanted.begin(), wanted.end(),
                         falcon_.requests.end() - static_cast<std::ptrdiff_t>(wanted.size())));
  // It keeps its firmware until its power goes.
  device->close();
  settings("");
  EXPECT_TRUE(open_device(*make())) << "no firmware is asked for any more";
}

TEST_F(Falcon, ACorruptedEchoIsNamedByItsByte) {
  falcon_.corrupt_at = 700;
  const Result<bool> opened = open_device(*make());
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().what.find("byte 700 of 7357"), std::string::npos) << opened.error().text();
  EXPECT_EQ(falcon_.received.size(), 744u) << "nothing more is sent than the piece that came back otherwise";
}

TEST_F(Falcon, WhatKeepsItFromStartingIsNamed) {
  falcon_.deaf = true;
  Result<bool> opened = open_device(*make());
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().what.find("greeting: it answers nothing"), std::string::npos)
      << opened.error().text();
  settings("");
  opened = open_device(*make());
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().mend.find("firmware = FILE"), std::string::npos) << opened.error().text();
  settings("firmware = /nowhere/novint.bin\n");
  opened = open_device(*make());
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().text().find("/nowhere/novint.bin"), std::string::npos);
}

TEST_F(Falcon, GetsNoForceBeforeItKnowsWhereItIs) {
  falcon_.homed = false;
  const auto device = make();
  ASSERT_TRUE(open_device(*device));
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(device->read({}).heard);
    device->write({{5.0, 0.0, 0.0}, {}});
  }
  EXPECT_NE(device->trouble().find("pull its grip"), std::string::npos);
  for (const FalconPacket& command : falcon_.commands) {
    EXPECT_EQ(parse_falcon(command)->counts, (std::array<int, 3>{0, 0, 0}));
    EXPECT_EQ((command[13] - 0x41) & kFalconHoming, kFalconHoming);
  }
  falcon_.homed = true;
  device->write({});
  while (!device->read({}).heard) device->write({});
  EXPECT_TRUE(device->trouble().empty());
  falcon_.homed = false;
  device->write({});
  device->read({});
  device->write({});
  EXPECT_FALSE(device->read({}).heard) << "and none when it lost its place";
}

TEST_F(Falcon, ThreeThousandReportsAtAKilohertzWithoutAGap) {
  const auto device = make();
  ASSERT_TRUE(open_device(*device));
  falcon_.velocity = {0.01, -0.005, 0.004};
  falcon_.chop = 11;  // pieces of packets
  std::size_t reports = 0;
  std::int64_t last_ns = 0;
  glm::dvec3 begin{0.0};
  device->write({});
  for (std::size_t reads = 0; reports < 3000; ++reads) {
    ASSERT_LT(reads, 10000u);
    const DeviceReport report = device->read({});
    ASSERT_TRUE(report.heard) << reads;
    if (reports == 0) begin = falcon_.grip - report.pose.position;
    if (last_ns != 0) {
      EXPECT_EQ(falcon_.now_ns - last_ns, 1'000'000);
    }
    last_ns = falcon_.now_ns;
    // An encoder's count is some 36 µm of the grip.
    EXPECT_LT(glm::distance(report.pose.position, falcon_.grip - begin), 100e-6) << reports;
    if (reports > 20) {
      EXPECT_LT(glm::distance(report.twist.linear, falcon_.velocity), 0.02);
    }
    ++reports;
    const std::size_t sent = falcon_.commands.size();
    device->write({});
    EXPECT_EQ(falcon_.commands.size(), sent + 1) << "one packet a reading";
  }
  EXPECT_TRUE(falcon_.out.size() <= kFalconPacket) << "nothing waits";
  EXPECT_NEAR(glm::length(falcon_.grip - glm::dvec3(0, 0, kFalconMiddle)),
              3.0 * glm::length(falcon_.velocity), 1e-4);
}

TEST_F(Falcon, TheMotorsPutTheForceOnTheHandWithinTheirLimit) {
  falcon_.grip = {0.02, -0.01, 0.14};
  falcon_.buttons = 0x09;
  const auto device = make();
  ASSERT_TRUE(open_device(*device));
  device->write({});
  DeviceReport report = device->read({});
  ASSERT_TRUE(report.heard);
  EXPECT_EQ(report.buttons, 9u);
  const auto felt = [&](const glm::dvec3& force) {
    device->write({force, {}});
    const std::array<int, 3> motors = parse_falcon(falcon_.commands.back())->counts;
    for (const int motor : motors) EXPECT_LE(std::abs(motor), 4096);
    bool reachable = false;
    const FalconAngles angles = falcon_angles(falcon_.grip, reachable);
    const glm::dvec3 torques(motors[0] / -1e4, motors[1] / -1e4, motors[2] / -1e4);
    return glm::transpose(falcon_jacobian(falcon_.grip, angles)) * torques;
  };
  EXPECT_LT(glm::distance(felt({1.0, 2.0, -1.5}), glm::dvec3(1.0, 2.0, -1.5)), 0.01);
  const glm::dvec3 most = felt({30.0, 60.0, -45.0});
  EXPECT_LT(glm::length(glm::cross(glm::normalize(most), glm::normalize(glm::dvec3(1.0, 2.0, -1.5)))), 0.01)
      << "cut together, so that the direction stays";
  device->close();
  EXPECT_EQ(parse_falcon(falcon_.commands.back())->counts, (std::array<int, 3>{0, 0, 0})) << "zero last";
}

TEST_F(Falcon, UnpluggedItIsSilentAndGoesOnWhenItIsBackAndWasHomed) {
  auto device = make();
  ASSERT_TRUE(open_device(*device));
  falcon_.grip.x += 0.01;
  device->write({});
  DeviceReport report;
  for (int i = 0; i < 5; ++i) {
    report = device->read({});
    device->write({{1.0, 0.0, 0.0}, {}});
  }
  ASSERT_TRUE(report.heard);
  const double place = report.pose.position.x;

  falcon_.gone = true;
  const std::size_t opened = opened_;
  for (int i = 0; i < 1500; ++i) {  // a second and a half
    EXPECT_FALSE(device->read({}).heard);
    device->write({{1.0, 0.0, 0.0}, {}});
    falcon_.now_ns += 1'000'000;
  }
  EXPECT_NE(device->trouble().find("cable"), std::string::npos) << device->trouble();
  EXPECT_EQ(opened_ - opened, 1u) << "it is looked for once a second";

  // Plugged in again, power and all: without its firmware and its place.
  falcon_.gone = false;
  falcon_.step = FakeFalcon::Step::kOff;
  falcon_.received.clear();
  falcon_.out.clear();
  falcon_.homed = false;
  for (int i = 0; i < 1500; ++i) {
    EXPECT_FALSE(device->read({}).heard);
    device->write({{1.0, 0.0, 0.0}, {}});
    falcon_.now_ns += 1'000'000;
  }
  EXPECT_EQ(falcon_.received, falcon_.firmware);
  EXPECT_NE(device->trouble().find("pull its grip out"), std::string::npos) << device->trouble();
  EXPECT_EQ(parse_falcon(falcon_.commands.back())->counts, (std::array<int, 3>{0, 0, 0})) << "no force yet";
  falcon_.homed = true;
  for (int i = 0; i < 5; ++i) {
    report = device->read({});
    device->write({{1.0, 0.0, 0.0}, {}});
  }
  EXPECT_TRUE(report.heard);
  EXPECT_EQ(device->trouble(), "");
  EXPECT_NEAR(report.pose.position.x, place, 1e-4) << "where it is, not where it begins";
  EXPECT_NE(parse_falcon(falcon_.commands.back())->counts, (std::array<int, 3>{0, 0, 0}));
}

TEST_F(Falcon, WithoutPowerItIsSilentAndSaysSo) {
  auto device = make();
  ASSERT_TRUE(open_device(*device));
  falcon_.silent = true;
  falcon_.out.clear();
  for (int i = 0; i < 1000 && device->trouble().find("power") == std::string::npos; ++i) {
    EXPECT_FALSE(device->read({}).heard);
    device->write({});
  }
  EXPECT_NE(device->trouble().find("has it power"), std::string::npos) << device->trouble();
}

TEST_F(Falcon, ItsGainsAreWhatItsDampingHolds) {
  auto device = make();
  ASSERT_TRUE(open_device(*device));
  EXPECT_NEAR(device->limits().max_stiffness, 950.0, 1e-9);
  EXPECT_TRUE(device->warnings().empty());
  device->close();
  settings("scale = 1\nstiffness_n_m = 2000\n");
  device = make();
  ASSERT_TRUE(open_device(*device));
  EXPECT_NEAR(device->limits().max_stiffness, 2000.0, 1e-9);
  ASSERT_EQ(device->warnings().size(), 1u);
  EXPECT_NE(device->warnings()[0].find("holds 950"), std::string::npos) << device->warnings()[0];
}

}  // namespace
}  // namespace slosh
