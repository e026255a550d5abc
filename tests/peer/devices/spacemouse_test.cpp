// The parts of the SpaceMouse that need no device: models, reports, motion.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "peer/devices/node_access.h"
#include "peer/devices/spacemouse_models.h"
#include "peer/devices/spacemouse_motion.h"
#include "tests/peer/devices/own_folder.h"

namespace slosh {
namespace {

SpaceMouseState deflected(const SpaceMouseAxes& axes, std::uint32_t buttons = 0) {
  SpaceMouseState state;
  state.axes = axes;
  state.buttons = buttons;
  return state;
}

void run_mouse(SpaceMouseMotion& motion, const SpaceMouseState& state, double seconds) {
  for (int i = 0; i < static_cast<int>(1000.0 * seconds); ++i) motion.advance(state, 0.001);
}

TEST(SpaceMouseModels, AreAllThatHaveSixAxes) {
  for (const std::uint16_t old :
       {0xc603, 0xc605, 0xc606, 0xc621, 0xc623, 0xc625, 0xc626, 0xc627, 0xc628, 0xc629, 0xc62b, 0xc640})
    EXPECT_NE(spacemouse_model(0x046d, old), nullptr) << old;
  for (const std::uint16_t now :
       {0xc62e, 0xc62f, 0xc631, 0xc632, 0xc633, 0xc635, 0xc636, 0xc638, 0xc63a, 0xc652})
    EXPECT_NE(spacemouse_model(0x256f, now), nullptr) << now;
  for (const std::uint16_t other :
       {0xc650, 0xc651, 0xc654, 0xc655, 0xc656, 0xc657, 0xc658, 0xc664, 0xc665, 0xc668, 0xc62c})
    EXPECT_EQ(spacemouse_model(0x256f, other), nullptr) << other;
  EXPECT_EQ(spacemouse_model(0x046d, 0xc52b), nullptr) << "a keyboard's receiver";
  EXPECT_EQ(spacemouse_model(0x1234, 0xc626), nullptr);
}

TEST(NodeAccess, NamesTheRuleWhereAUserMayNotOpenADevice) {
  const test::OwnFolder folder;
  chmod(folder.path().c_str(), 0755);
  const std::filesystem::path node = folder.path() / "node";
  std::ofstream(node) << "";
  chmod(node.c_str(), 0);
  EXPECT_EXIT(
      {
        if (geteuid() == 0 && setuid(65534) != 0) _exit(3);
        const Result<bool> may = check_node_access(node.string(), R_OK | W_OK);
        std::fprintf(stderr, "%s\n", may ? "it may" : may.error().text().c_str());
        _exit(may ? 1 : 0);
      },
      ::testing::ExitedWithCode(0), "this user may not open it.*--install-udev-rule");
}

TEST(SpaceMouseReports, AreToldApartByTheirLength) {
  SpaceMouseState state;
  const std::uint8_t three[] = {1, 0x5e, 0x01, 0xa2, 0xfe, 5, 0};
  EXPECT_EQ(take_spacemouse_report(three, 7, state), SpaceMouseReport::kAxes);
  EXPECT_EQ(state.axes, (SpaceMouseAxes{350, -350, 5, 0, 0, 0}));
  const std::uint8_t six[] = {1, 1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 0xfa, 0xff};
  EXPECT_EQ(take_spacemouse_report(six, 13, state), SpaceMouseReport::kAxes);
  EXPECT_EQ(state.axes, (SpaceMouseAxes{1, 2, 3, 4, 5, -6}));
  const std::uint8_t buttons[] = {3, 0x01, 0x80, 0, 0x40};
  EXPECT_EQ(take_spacemouse_report(buttons, 5, state), SpaceMouseReport::kButtons);
  EXPECT_EQ(state.buttons, 0x40008001u);
  const std::uint8_t wild[] = {2, 0xff, 0x7f, 0, 0x80, 0, 0};
  take_spacemouse_report(wild, 7, state);
  EXPECT_EQ(state.axes, (SpaceMouseAxes{1, 2, 3, 350, -350, 0})) << "beyond the stop is the stop";
  EXPECT_EQ(take_spacemouse_report(wild, 0, state), SpaceMouseReport::kMalformed);
}

TEST(SpaceMouseMotion, RateModeMovesAtTheStatedSpeedInTheUsersDirections) {
  SpaceMouseSettings settings;
  struct Case {
    SpaceMouseAxes axes;
    glm::dvec3 linear, angular;
  };
  // The device: x right, y towards the user, z down. The world: x right, y up, z towards the user.
  for (const Case& c :
       {Case{{350, 0, 0, 0, 0, 0}, {0.25, 0, 0}, {}}, Case{{0, 350, 0, 0, 0, 0}, {0, 0, 0.25}, {}},
        Case{{0, 0, 350, 0, 0, 0}, {0, -0.25, 0}, {}}, Case{{0, 0, 0, 350, 0, 0}, {}, {-1.5, 0, 0}},
        Case{{0, 0, 0, 0, 350, 0}, {}, {0, 0, -1.5}}, Case{{0, 0, 0, 0, 0, 350}, {}, {0, 1.5, 0}}}) {
    SpaceMouseMotion motion(settings, Pose{}, {1, 0, 0, 0});
    run_mouse(motion, deflected(c.axes), 1.0);
    EXPECT_NEAR(glm::distance(motion.twist().linear, c.linear), 0.0, 1e-9);
    EXPECT_NEAR(glm::distance(motion.twist().angular, c.angular), 0.0, 1e-9);
    const glm::dvec3 before = motion.pose().position;
    run_mouse(motion, deflected(c.axes), 1.0);
    EXPECT_NEAR(glm::distance(motion.pose().position - before, c.linear), 0.0, 1e-6);
  }
}

TEST(SpaceMouseMotion, TheDeadZoneIsStillAndItsEdgeIsNoStep) {
  SpaceMouseSettings settings;
  settings.deadzone = 10;
  SpaceMouseMotion still(settings, Pose{}, {1, 0, 0, 0});
  run_mouse(still, deflected({10, -10, 10, -10, 10, -10}), 1.0);
  EXPECT_EQ(still.pose().position, glm::dvec3(0.0));
  EXPECT_EQ(still.twist().angular, glm::dvec3(0.0));
  SpaceMouseMotion slow(settings, Pose{}, {1, 0, 0, 0});
  run_mouse(slow, deflected({11, 0, 0, 0, 0, 0}), 1.0);
  EXPECT_NEAR(slow.twist().linear.x, 0.25 / 340.0, 1e-9);
}

TEST(SpaceMouseMotion, MovesByTheCameraUnlessToldOtherwise) {
  const glm::dquat quarter = glm::angleAxis(glm::radians(90.0), glm::dvec3(0, 1, 0));
  SpaceMouseSettings settings;
  SpaceMouseMotion by_camera(settings, Pose{}, quarter);
  run_mouse(by_camera, deflected({350, 0, 0, 0, 0, 0}), 1.0);
  EXPECT_NEAR(by_camera.twist().linear.z, -0.25, 1e-9);
  by_camera.look_from({1, 0, 0, 0});
  run_mouse(by_camera, deflected({350, 0, 0, 0, 0, 0}), 1.0);
  EXPECT_NEAR(by_camera.twist().linear.x, 0.25, 1e-9) << "the camera turned";
  settings.by_camera = false;
  SpaceMouseMotion by_world(settings, Pose{}, quarter);
  run_mouse(by_world, deflected({350, 0, 0, 0, 0, 0}), 1.0);
  EXPECT_NEAR(by_world.twist().linear.x, 0.25, 1e-9);
}

TEST(SpaceMouseMotion, PositionModeGoesWhereTheCapPointsAndBack) {
  SpaceMouseSettings settings;
  settings.rate = false;
  Pose start;
  start.position = {1, 1, 1};
  SpaceMouseMotion motion(settings, start, {1, 0, 0, 0});
  run_mouse(motion, deflected({350, 0, 0, 0, 0, 350}), 1.0);
  EXPECT_NEAR(motion.pose().position.x, 1.1, 1e-6);
  EXPECT_NEAR(rotation_between(start.orientation, motion.pose().orientation).y, 0.8, 1e-6);
  run_mouse(motion, deflected({}), 1.0);
  EXPECT_NEAR(glm::distance(motion.pose().position, start.position), 0.0, 1e-6);
  EXPECT_NEAR(glm::length(rotation_between(start.orientation, motion.pose().orientation)), 0.0, 1e-6);
}

TEST(SpaceMouseMotion, TheClutchKeepsTheHandWhereItIs) {
  SpaceMouseSettings settings;
  settings.rate = false;
  SpaceMouseMotion motion(settings, Pose{}, {1, 0, 0, 0});
  run_mouse(motion, deflected({350, 0, 0, 0, 0, 0}), 1.0);
  run_mouse(motion, deflected({350, 0, 0, 0, 0, 0}, 1), 0.5);
  const double kept = motion.pose().position.x;
  run_mouse(motion, deflected({0, 0, 0, 0, 0, 0}, 1), 1.0);
  EXPECT_NEAR(motion.pose().position.x, kept, 1e-9);
  run_mouse(motion, deflected({0, 0, 0, 0, 0, 0}), 1.0);
  EXPECT_NEAR(motion.pose().position.x, kept, 1e-6) << "what the cap stands for moved with it";
  run_mouse(motion, deflected({350, 0, 0, 0, 0, 0}), 1.0);
  EXPECT_NEAR(motion.pose().position.x, kept + 0.1, 1e-6);
}

TEST(SpaceMouseMotion, ADeadmanButtonHoldsOnOnlyWhileItIsHeld) {
  SpaceMouseSettings settings;
  settings.deadman_button = 2;
  SpaceMouseMotion motion(settings, Pose{}, {1, 0, 0, 0});
  EXPECT_FALSE(motion.engaged());
  motion.advance(deflected({}, 2), 0.001);
  EXPECT_TRUE(motion.engaged());
  motion.advance(deflected({}), 0.001);
  EXPECT_FALSE(motion.engaged());
}

TEST(SpaceMouseMotion, AMachineThatStoodStillDoesNotThrowTheHand) {
  SpaceMouseMotion motion(SpaceMouseSettings{}, Pose{}, {1, 0, 0, 0});
  motion.advance(deflected({350, 0, 0, 0, 0, 0}), 10.0);
  EXPECT_LE(motion.pose().position.x, 0.25 * 0.05);
}

}  // namespace
}  // namespace slosh
