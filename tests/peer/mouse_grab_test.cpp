// The mouse takes a bucket-like thing by one handle or by both: the path below GLFW, from input states to
// wishes.
#include "peer/view/mouse_grab.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "peer/view/frame_builder.h"
#include "peer/view/window_guide.h"

namespace slosh {
namespace {

constexpr int kWidth = 800;
constexpr int kHeight = 600;
const glm::ivec2 kPicture(kWidth, kHeight);

/// A ball of 0.1 m radius with a handle 0.15 m to either side, seen from the front and a little above.
struct Rig {
  Scene scene;
  BodySnapshot world;
  std::vector<std::unique_ptr<SharedHandle>> hands;
  std::vector<SharedHandle*> lent;
  std::unique_ptr<OrbitCamera> camera;
  std::unique_ptr<MouseGrab> grab;
  InputState input;

  Rig() {
    TriangleMesh ball = unit_ball();
    for (glm::vec3& p : ball.positions) p *= 0.1f;
    scene.meshes.push_back(ball);
    scene.bodies.resize(2);
    scene.bodies[0].mesh = 0;  // nobody's: it stands beside
    scene.bodies[1].mesh = 0;
    scene.bodies[1].name = "bucket";
    scene.domain_min = glm::dvec3(-2.0);
    scene.domain_max = glm::dvec3(2.0);
    scene.camera.eye = {0.0, 0.8, 1.2};
    scene.camera.target = {0.0, 0.2, 0.0};
    world.bodies.resize(2);
    world.bodies[0].pose.position = {0.5, 0.2, 0.0};
    world.bodies[1].pose.position = {0.0, 0.2, 0.0};
    for (const double side : {-1.0, 1.0}) {
      Grip grip;
      grip.body = 1;
      grip.name = side < 0 ? "left" : "right";
      scene.grips.push_back(grip);
      GripState state;
      state.handle.position = state.pose.position = {0.15 * side, 0.2, 0.0};
      world.grips.push_back(state);
      hands.push_back(std::make_unique<SharedHandle>(state.handle));
      lent.push_back(hands.back().get());
    }
    camera = std::make_unique<OrbitCamera>(scene.camera);
    grab = std::make_unique<MouseGrab>(scene);
  }

  glm::vec2 pixel(const glm::dvec3& place) const { return glm::vec2(camera->pixel_of(place, kPicture)); }
  bool follow() { return grab->follow(input, *camera, kPicture, world, lent); }
  /// The pointer moves on by `by` pixels, in one picture.
  bool drag(glm::vec2 by) {
    input.mouse_delta = by;
    input.mouse += by;
    const bool busy = follow();
    input.mouse_delta = {};
    return busy;
  }
  bool press(const glm::dvec3& place) {
    input.mouse = pixel(place);
    follow();
    input.buttons[static_cast<std::size_t>(MouseButton::kLeft)] = true;
    return follow();
  }
  void hold_key(Key key, bool down) { input.keys[static_cast<std::size_t>(key)] = down; }
  bool wheel(float notches) {
    input.scroll.y = notches;
    const bool busy = follow();
    input.scroll.y = 0.0f;
    return busy;
  }
  SharedHandle::Wish wish(std::size_t i) {
    (void)hands[i]->wish.update();
    return hands[i]->wish.front();
  }
};

const glm::dvec3 kLeft(-0.15, 0.2, 0.0);
const glm::dvec3 kRight(0.15, 0.2, 0.0);

TEST(OrbitCamera, ARayGoesThroughWhatItsPixelShows) {
  const Rig rig;
  const glm::dvec3 place(0.1, 0.3, -0.2);
  const glm::dvec3 ray = rig.camera->ray(rig.pixel(place), kPicture);
  EXPECT_NEAR(glm::distance(rig.camera->eye() + glm::distance(rig.camera->eye(), place) * ray, place), 0.0,
              1e-4);
  const glm::mat4 m =
      rig.camera->view(double(kWidth) / kHeight).projection * rig.camera->view(double(kWidth) / kHeight).view;
  const glm::vec4 clip = m * glm::vec4(glm::vec3(place), 1.0f);
  EXPECT_NEAR((0.5f + 0.5f * clip.x / clip.w) * kWidth, rig.pixel(place).x, 0.05f)
      << "as the renderer has it";
  EXPECT_NEAR((0.5f - 0.5f * clip.y / clip.w) * kHeight, rig.pixel(place).y, 0.05f);
}

TEST(MouseGrab, APressTakesTheNearestHandleElseTheWholeThingElseNothing) {
  Rig rig;
  EXPECT_TRUE(rig.press(kLeft));
  ASSERT_TRUE(rig.grab->held());
  EXPECT_EQ(rig.grab->held()->grip, 0);
  Rig whole;
  EXPECT_TRUE(whole.press({0.0, 0.22, 0.05}));
  ASSERT_TRUE(whole.grab->held());
  EXPECT_EQ(whole.grab->held()->grip, -1);
  EXPECT_EQ(whole.grab->held()->body, 1);
  Rig beside;
  EXPECT_FALSE(beside.press({0.5, 0.2, 0.0})) << "a body without a hand of ours";
  EXPECT_FALSE(beside.grab->held());
  EXPECT_FALSE(beside.drag({300.0f, 0.0f})) << "a drag that began elsewhere takes nothing on its way";
  EXPECT_FALSE(beside.wish(0).taken);
  Rig others;
  others.lent = {nullptr, nullptr};
  EXPECT_FALSE(others.press({0.0, 0.22, 0.05})) << "hands that are not lent";
  Rig covered;
  covered.input.hud_wants_mouse = true;
  EXPECT_FALSE(covered.press(kLeft)) << "the pointer is over a panel";
}

TEST(MouseGrab, TheWholeThingStaysUnderThePointer) {
  Rig rig;
  const glm::dvec3 place = rig.world.bodies[1].pose.position;
  rig.press({0.0, 0.22, 0.05});
  const glm::dvec3 held = rig.grab->held()->place;
  rig.drag({40.0f, -30.0f});
  const glm::dvec3 moved = rig.wish(0).pose.position - kLeft;
  EXPECT_NEAR(glm::distance(rig.wish(1).pose.position - kRight, moved), 0.0, 1e-12) << "both hands alike";
  EXPECT_NEAR(moved.z, 0.0, 1e-12) << "up, not away";
  EXPECT_GT(moved.y, 0.02);
  const glm::vec2 shown = rig.pixel(held + moved) - rig.pixel(held);
  EXPECT_NEAR(shown.x, 40.0f, 4.0f) << "to first order";
  EXPECT_NEAR(shown.y, -30.0f, 4.0f);
  (void)place;
}

TEST(MouseGrab, ShiftMovesOverTheTable) {
  Rig rig;
  rig.press({0.0, 0.22, 0.05});
  rig.hold_key(Key::kShift, true);
  rig.drag({0.0f, -30.0f});
  const glm::dvec3 moved = rig.wish(0).pose.position - kLeft;
  EXPECT_NEAR(moved.y, 0.0, 1e-12);
  EXPECT_LT(moved.z, -0.02) << "away from who looks";
  rig.wheel(-1.0f);
  EXPECT_GT(rig.wish(0).pose.position.z, kLeft.z + moved.z) << "and nearer";
}

TEST(MouseGrab, TheWheelTiltsTheThingAsOneAboutTheMiddleOfItsHands) {
  Rig rig;
  rig.press({0.0, 0.22, 0.05});
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(rig.wheel(1.0f));
  const Pose left = rig.wish(0).pose;
  const Pose right = rig.wish(1).pose;
  EXPECT_NEAR(glm::distance(left.position, right.position), 0.3, 1e-12);
  EXPECT_LT(left.position.y, 0.12) << "the left goes down: 40° of 0.15 m";
  EXPECT_NEAR(glm::distance(0.5 * (left.position + right.position), glm::dvec3(0.0, 0.2, 0.0)), 0.0, 1e-12);
  const glm::dvec3 turn = rotation_between(glm::dquat(1.0, 0.0, 0.0, 0.0), left.orientation);
  EXPECT_NEAR(turn.z, 0.7, 1e-9) << "rad, about the level way to the eye";
  EXPECT_NEAR(turn.y, 0.0, 1e-9);
  EXPECT_NEAR(glm::length(rotation_between(left.orientation, right.orientation)), 0.0, 1e-9);
  EXPECT_TRUE(rig.grab->ever_tilted());
}

TEST(MouseGrab, ControlTiltsAnyWay) {
  Rig rig;
  rig.press({0.0, 0.22, 0.05});
  rig.hold_key(Key::kControl, true);
  rig.drag({0.0f, 50.0f});
  const glm::dvec3 turn = rotation_between(glm::dquat(1.0, 0.0, 0.0, 0.0), rig.wish(0).pose.orientation);
  EXPECT_NEAR(turn.x, 0.4, 1e-9) << "downward: the rim comes to who looks";
  EXPECT_NEAR(rig.wish(0).pose.position.x, kLeft.x, 1e-9);
}

TEST(MouseGrab, OneHandleTurnsTheThingAboutTheOthersAndDrawsThemAlong) {
  Rig rig;
  rig.press(kRight);
  for (int i = 0; i < 40; ++i) rig.drag({0.0f, -2.0f});
  const Pose left = rig.wish(0).pose;
  const Pose right = rig.wish(1).pose;
  EXPECT_TRUE(rig.wish(0).taken) << "the other hand gives way, or it would tear";
  EXPECT_NEAR(glm::distance(left.position, right.position), 0.3, 1e-9) << "rigid";
  EXPECT_GT(right.position.y, 0.3);
  EXPECT_GT(rotation_between(glm::dquat(1.0, 0.0, 0.0, 0.0), right.orientation).z, 0.3);
  for (int i = 0; i < 40; ++i) rig.drag({5.0f, 0.0f});
  EXPECT_GT(rig.wish(0).pose.position.x, left.position.x + 0.05) << "pulled away from it, it follows";
}

TEST(MouseGrab, LetGoTheHandsStayAndGivenBackTheyGoHome) {
  Rig rig;
  rig.press({0.0, 0.22, 0.05});
  rig.drag({40.0f, 0.0f});
  const Pose there = rig.wish(0).pose;
  rig.input.buttons[static_cast<std::size_t>(MouseButton::kLeft)] = false;
  EXPECT_FALSE(rig.drag({100.0f, 0.0f}));
  EXPECT_TRUE(rig.wish(0).taken);
  EXPECT_EQ(rig.wish(0).pose.position, there.position);
  EXPECT_TRUE(rig.grab->any_taken());
  rig.grab->give_back(rig.lent);
  EXPECT_FALSE(rig.wish(0).taken);
  EXPECT_FALSE(rig.grab->any_taken());
}

TEST(MouseGrab, WhatIsWantedStaysInTheDomainAndHandsThatGoAreForgotten) {
  Rig rig;
  rig.press({0.0, 0.22, 0.05});
  for (int i = 0; i < 50; ++i) rig.drag({0.0f, 400.0f});
  EXPECT_GT(rig.wish(0).pose.position.y, rig.scene.domain_min.y - 0.1);
  rig.lent = {nullptr, nullptr};
  EXPECT_FALSE(rig.follow());
  EXPECT_FALSE(rig.grab->any_taken());
}

TEST(WindowGuide, HintsAtWhatMattersUntilItWasDone) {
  WindowGuide guide;
  GuideFacts facts;
  facts.can_grab = facts.may_change = facts.may_pace = true;
  EXPECT_NE(guide.hint(facts).find("Drag"), std::string::npos);
  EXPECT_NE(guide.hint(facts).find("H:"), std::string::npos);
  facts.holding = facts.taken = true;
  EXPECT_NE(guide.hint(facts).find("wheel"), std::string::npos);
  guide.note(WindowGuide::Used::kGrab);
  guide.note(WindowGuide::Used::kTilt);
  EXPECT_EQ(guide.hint(facts), "");
  facts.holding = false;
  EXPECT_NE(guide.hint(facts).find("B:"), std::string::npos);
  guide.note(WindowGuide::Used::kGiveBack);
  guide.note(WindowGuide::Used::kKeys);
  EXPECT_EQ(guide.hint(facts), "") << "who knows all of it is told nothing";
  EXPECT_NE(WindowGuide::all_keys(facts).find("slower"), std::string::npos);
  facts.may_pace = facts.may_change = false;
  EXPECT_EQ(WindowGuide::all_keys(facts).find("slower"), std::string::npos) << "who looks on cannot";
}

}  // namespace
}  // namespace slosh
