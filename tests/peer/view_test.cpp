// Camera, mouse hand and rates: no renderer needed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "peer/view/frame_builder.h"
#include "peer/view/held_rects.h"
#include "peer/view/hud/hud.h"
#include "peer/view/hud/rates.h"
#include "peer/view/mouse_hand.h"
#include "peer/view/orbit_camera.h"
#include "peer/view/picture_scale.h"
#include "peer/view/stereo_views.h"

namespace slosh {
namespace {

Camera camera() {
  Camera c;
  c.eye = {0.0, 0.5, 1.0};
  c.target = {0.0, 0.1, 0.0};
  return c;
}

glm::vec3 clip(const View& view, const glm::dvec3& point) {
  const glm::vec4 p = view.projection * view.view * glm::vec4(glm::vec3(point), 1.0f);
  return glm::vec3(p) / p.w;
}

TEST(OrbitCamera, StartsAsTheSceneSays) {
  const OrbitCamera orbit(camera());
  EXPECT_NEAR(glm::distance(orbit.eye(), camera().eye), 0.0, 1e-12);
  const glm::vec3 middle = clip(orbit.view(1.5), camera().target);
  EXPECT_NEAR(middle.x, 0.0f, 1e-5f);
  EXPECT_NEAR(middle.y, 0.0f, 1e-5f);
}

/// Panels get their corners once: so what they keep clear of is the whole way of a script, not where it
/// begins.
TEST(HeldRects, AScriptsWholeWayIsKnownBeforeItBegins) {
  Scene scene;
  scene.camera = camera();
  scene.meshes.resize(1);
  scene.meshes[0].positions = {{-0.05f, -0.05f, -0.05f}, {0.05f, 0.05f, 0.05f}};
  scene.bodies.resize(1);
  scene.bodies[0].mesh = 0;
  scene.grips.resize(1);
  scene.grips[0].body = 0;
  scene.grips[0].pose.position = {0.05, 0.0, 0.0};
  scene.grips[0].hand_motion = {{0.0, {{-0.25, 0.1, 0.0}, {1, 0, 0, 0}}},
                                {2.0, {{0.35, 0.1, 0.0}, {1, 0, 0, 0}}}};
  const View view = OrbitCamera(scene.camera).view(1.5);
  Snapshot snapshot;
  snapshot.rigid.bodies.resize(1);
  snapshot.rigid.bodies[0].pose.position = {-0.3, 0.1, 0.0};
  snapshot.rigid.grips.resize(1);
  snapshot.rigid.grips[0].handle.position = {-0.25, 0.1, 0.0};
  const HeldRects held(scene);
  float right_now = 0.0f, right = 0.0f;
  for (const Rect& rect : held.of(snapshot, view)) right_now = std::max(right_now, rect.high.x);
  for (const Rect& rect : held.through_run(snapshot, view)) right = std::max(right, rect.high.x);
  EXPECT_LT(right_now, 0.5f);
  // Where the script ends the body is at 0.3, as far right of the middle as it begins to the left.
  EXPECT_NEAR(right, 0.5 + 0.5 * clip(view, {0.35, 0.15, 0.05}).x, 1e-3);
}

/// Keeps nothing of what it is given.
struct NoMeshes final : MeshSink {
  MeshHandle add_mesh(std::span<const glm::vec3>, std::span<const glm::vec3>, std::span<const glm::uvec3>,
                      std::span<const glm::vec2>) override {
    return next++;
  }
  void remove_mesh(MeshHandle) override {}
  TextureHandle add_texture(const TextureImage&) override { return {}; }
  MeshHandle next = 0;
};

TEST(Ghost, StandsWhereTheRecordedHandHadTheToolAndFadesWhereBothAreOne) {
  Scene scene;
  scene.meshes.resize(1);
  scene.meshes[0].positions = {{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}};
  scene.meshes[0].normals.assign(3, glm::vec3(0, 0, 1));
  scene.meshes[0].triangles = {{0, 1, 2}};
  scene.bodies.resize(1);
  scene.bodies[0].mesh = 0;
  scene.grips.resize(1);
  scene.grips[0].body = 0;
  scene.grips[0].pose.position = {0.05, 0.0, 0.0};
  NoMeshes meshes;
  FrameBuilder builder(scene, 0.01, meshes);
  const auto clock = std::make_shared<GhostClock>(std::vector<double>());
  builder.show_ghost(
      {{0, {{0.0, {{0.05, 0.0, 0.0}, {1, 0, 0, 0}}}, {2.0, {{0.05, 0.2, 0.0}, {1, 0, 0, 0}}}}, 0.0, clock}});
  Snapshot snapshot;
  snapshot.rigid.bodies.resize(1);
  snapshot.rigid.grips.resize(1);
  snapshot.rigid.grips[0].pose.position = {0.05, 0.0, 0.0};
  const auto ghosts = [&](double time) {
    snapshot.rigid.time = time;
    decltype(Frame::meshes) found;
    for (const auto& each : builder.build(snapshot, 1.0).meshes)
      if (each.look.opacity < 1.0f) found.push_back(each);
    return found;
  };
  EXPECT_TRUE(ghosts(0.0).empty()) << "the hand is where it was";
  const auto later = ghosts(2.0);
  ASSERT_EQ(later.size(), 1u);
  EXPECT_NEAR(later[0].model[3].x, 0.0f, 1e-6f) << "less the grip's place on the body";
  EXPECT_NEAR(later[0].model[3].y, 0.2f, 1e-6f);
  EXPECT_LT(ghosts(0.2).empty() ? 0.0f : ghosts(0.2)[0].look.opacity, later[0].look.opacity);
  snapshot.rigid.bodies[0].pose.position = glm::dvec3(kAway);
  EXPECT_TRUE(ghosts(2.0).empty()) << "the tool is away";
}

TEST(OrbitCamera, TurningKeepsTheDistanceAndTheTarget) {
  OrbitCamera orbit(camera());
  const double distance = orbit.distance();
  orbit.turn(1.0, 9.0);  // as far up as it goes
  EXPECT_NEAR(glm::distance(orbit.eye(), orbit.target()), distance, 1e-12);
  EXPECT_TRUE(std::isfinite(orbit.view(1.0).view[0][0]));
  EXPECT_GT(orbit.up().y, 0.0);
  orbit.reset();
  EXPECT_NEAR(glm::distance(orbit.eye(), camera().eye), 0.0, 1e-12);
}

TEST(OrbitCamera, DraggingMovesTheWorldWithTheMouse) {
  OrbitCamera orbit(camera());
  InputState input;
  input.mouse_delta = {50.0f, 0.0f};
  input.buttons[static_cast<std::size_t>(MouseButton::kRight)] = true;
  orbit.follow(input, 500);
  EXPECT_GT(clip(orbit.view(1.0), camera().target).x, 0.0f) << "what was in the middle went right";
  input.hud_wants_mouse = true;
  const glm::dvec3 eye = orbit.eye();
  orbit.follow(input, 500);
  EXPECT_EQ(orbit.eye(), eye) << "the HUD has the mouse";
}

TEST(StereoViews, EyesDifferAsFarAsTheyAreApart) {
  const OrbitCamera orbit(camera());
  const View middle = orbit.view(1.5);
  const auto screen = static_cast<float>(orbit.distance());
  const auto eyes = stereo_views(middle, 0.063f, screen);
  const glm::dvec3 forward = glm::normalize(camera().target - camera().eye);
  for (const double depth : {0.5, static_cast<double>(screen), 3.0}) {
    for (const double aside : {-0.1, 0.0, 0.2}) {
      const glm::dvec3 point = camera().eye + depth * forward + glm::dvec3(aside, 0.0, 0.0);
      const glm::vec3 left = clip(eyes[0], point);
      const glm::vec3 right = clip(eyes[1], point);
      // Similar triangles: what is nearer than the screen is seen crossed, with an eye's distance as its
      // base.
      const double apart = middle.projection[0][0] * 0.063 * (1.0 / depth - 1.0 / screen);
      EXPECT_NEAR(left.x - right.x, apart, 1e-5) << depth << " m";
      EXPECT_NEAR(0.5f * (left.x + right.x), clip(middle, point).x, 1e-5f);
      EXPECT_NEAR(left.y, right.y, 1e-6f);
    }
  }
}

TEST(Hud, SaysInHowManyStepsEachStatusWasSet) {
  std::array<std::uint64_t, 32> steps{};
  steps[2] = 12345;
  EXPECT_EQ(status_lines(0, steps), "") << "what is over is not shown";
  const std::string lines = status_lines(kStatusSpeedLimited | kStatusForceLimited, steps);
  EXPECT_EQ(lines,
            status_text(kStatusSpeedLimited) + " (in 12 345 steps)\n" + status_text(kStatusForceLimited))
      << "a device's own are not counted";
  steps[2] = 1;
  EXPECT_EQ(status_lines(kStatusSpeedLimited, steps), status_text(kStatusSpeedLimited) + " (in 1 step)");
}

TEST(MouseHand, StaysUnderThePointer) {
  const OrbitCamera orbit(camera());
  Pose start;
  start.position = {0.1, 0.2, 0.3};
  MouseHand hand(start);
  InputState input;
  input.mouse_delta = {30.0f, -20.0f};  // right and up
  const int height = 600;
  EXPECT_TRUE(hand.follow(input, orbit, height));
  const glm::vec3 before = clip(orbit.view(1.0), start.position);
  const glm::vec3 after = clip(orbit.view(1.0), hand.wanted().position);
  EXPECT_NEAR((after.x - before.x) * 0.5f * height, 30.0f, 0.2f);
  EXPECT_NEAR((after.y - before.y) * 0.5f * height, 20.0f, 0.2f);
  EXPECT_FALSE(hand.follow(InputState{}, orbit, height));
}

TEST(MouseHand, TheWheelMovesAwayAndTheRightButtonTurns) {
  const OrbitCamera orbit(camera());
  MouseHand hand(Pose{});
  InputState input;
  input.scroll.y = 2.0f;
  hand.follow(input, orbit, 600);
  EXPECT_GT(glm::dot(hand.wanted().position, orbit.forward()), 0.0);
  input = {};
  input.mouse_delta = {10.0f, 0.0f};
  input.buttons[static_cast<std::size_t>(MouseButton::kRight)] = true;
  const glm::dvec3 place = hand.wanted().position;
  hand.follow(input, orbit, 600);
  EXPECT_EQ(hand.wanted().position, place);
  EXPECT_GT(glm::angle(hand.wanted().orientation), 0.01);
}

TEST(RateLog, AnswersForTheTimeOfAPicture) {
  RateLog log;
  EXPECT_EQ(log.at(1.0).real_time, 0.0);
  for (int i = 0; i < 5; ++i) {
    Rates rates;
    rates.time = 0.1 * i;
    rates.real_time = 1.0 + i;
    log.add(rates);
  }
  EXPECT_EQ(log.at(0.0).real_time, 1.0);
  EXPECT_EQ(log.at(0.25).real_time, 3.0);
  EXPECT_EQ(log.at(9.0).real_time, 5.0);
}

TEST(UnitBall, IsClosedRoundAndFacesOutward) {
  const TriangleMesh ball = unit_ball();
  double volume = 0.0;
  for (const glm::uvec3& t : ball.triangles) {
    const glm::dvec3 a = ball.positions[t.x];
    const glm::dvec3 b = ball.positions[t.y];
    const glm::dvec3 c = ball.positions[t.z];
    volume += glm::dot(a, glm::cross(b, c)) / 6.0;
  }
  EXPECT_GT(volume, 0.9 * 4.18879) << "positive: counter-clockwise from outside";
  EXPECT_LT(volume, 4.18879);
}

TEST(PictureScale, GoesDownWhereItTakesTooLongAndUpOnlyWhereThatFits) {
  PictureScale scale(33.0);
  EXPECT_EQ(scale.scale(), 1.0);
  // One slow picture says nothing.
  scale.took(500.0);
  for (int i = 0; i < 100; ++i) scale.took(30.0);
  EXPECT_EQ(scale.scale(), 1.0);
  // A machine that takes 80 ms for all pixels.
  for (int i = 0; i < 200; ++i) scale.took(80.0 * scale.scale() * scale.scale());
  EXPECT_EQ(scale.scale(), 0.6) << "28.8 ms";
  int changes = 0;
  for (int i = 0; i < 500; ++i) changes += scale.took(80.0 * scale.scale() * scale.scale()) ? 1 : 0;
  EXPECT_EQ(changes, 0) << "it does not go to and fro";
  // It has time again.
  for (int i = 0; i < 500; ++i) scale.took(20.0 * scale.scale() * scale.scale());
  EXPECT_EQ(scale.scale(), 1.0);
  // There is an end to it.
  for (int i = 0; i < 500; ++i) scale.took(1e4);
  EXPECT_EQ(scale.scale(), 0.5);
}

}  // namespace
}  // namespace slosh
