// Where the room lies in the world, and how eyes look into it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "peer/view/headset_view.h"
#include "peer/view/held_rects.h"
#include "render/room_in_world.h"

namespace slosh {
namespace {

Pose turned(const glm::dvec3& at, double about_y, double down) {
  return {at, glm::angleAxis(about_y, glm::dvec3(0, 1, 0)) * glm::angleAxis(-down, glm::dvec3(1, 0, 0))};
}

TEST(RoomInWorld, GoesThereAndBack) {
  const RoomInWorld room{{1.0, -0.5, 2.0}, 0.7, 0.25};
  const Pose in_room = turned({0.3, 1.4, -0.6}, 0.4, 0.2);
  const Pose back = room.to_room(room.to_world(in_room));
  EXPECT_LT(glm::distance(back.position, in_room.position), 1e-12);
  EXPECT_LT(glm::length(rotation_between(back.orientation, in_room.orientation)), 1e-12);
  // Level stays level, and a metre is a quarter of one.
  const glm::dvec3 up = room.to_world({{0, 1, 0}, {1, 0, 0, 0}}).position - room.to_world(Pose{}).position;
  EXPECT_LT(glm::distance(up, glm::dvec3(0.0, 0.25, 0.0)), 1e-12);
  // A twist is the pose's own change.
  const Twist twist{{0.1, 0.2, -0.3}, {0.4, -0.5, 0.6}};
  const Twist world = room.to_world(twist);
  const double dt = 1e-6;
  const Pose later{in_room.position + dt * twist.linear, rotate_by(in_room.orientation, dt * twist.angular)};
  EXPECT_LT(
      glm::distance((room.to_world(later).position - room.to_world(in_room).position) / dt, world.linear),
      1e-6);
  EXPECT_LT(glm::distance(
                rotation_between(room.to_world(in_room).orientation, room.to_world(later).orientation) / dt,
                world.angular),
            1e-5);
}

TEST(RoomInWorld, PutsTheFocusBeforeTheHead) {
  AnchorWish wish;
  wish.focus = {0.2, 0.4, -0.1};
  wish.facing = {-1.0, -0.6, -1.0};
  for (const double about : {0.0, 1.0, -2.5}) {
    const Pose head = turned({0.3, 1.7, 0.8}, about, 0.5);
    const RoomInWorld room = anchor_room(head, wish);
    const Pose focus = room.to_room({wish.focus, {1, 0, 0, 0}});
    EXPECT_NEAR(focus.position.y, 1.7 - 0.35, 1e-12);
    const glm::dvec3 way = focus.position - head.position;
    EXPECT_NEAR(std::hypot(way.x, way.z), 0.5, 1e-12);
    const glm::dvec3 ahead = glm::angleAxis(about, glm::dvec3(0, 1, 0)) * glm::dvec3(0, 0, -1);
    EXPECT_NEAR(glm::dot(glm::normalize(glm::dvec3(way.x, 0.0, way.z)), ahead), 1.0, 1e-12);
    // Who looks straight ahead looks the way that was wished.
    const glm::dvec3 looks = room.to_world(turned({}, about, 0.0)).orientation * glm::dvec3(0, 0, -1);
    EXPECT_LT(glm::distance(looks, glm::normalize(glm::dvec3(-1, 0, -1))), 1e-12);
  }
  wish.height = 0.9;
  wish.scale = 0.5;
  const RoomInWorld room = anchor_room(turned({0, 1.7, 0}, 0.3, 0.0), wish);
  EXPECT_NEAR(room.to_room({wish.focus, {1, 0, 0, 0}}).position.y, 0.9, 1e-12) << "above the floor";
}

TEST(RoomInWorld, HeadStraightDownOrUpIsNoReasonToFail) {
  AnchorWish wish;
  wish.facing = {0.0, -1.0, 0.0};
  const RoomInWorld room =
      anchor_room({{0, 1.6, 0}, glm::angleAxis(-0.5 * std::numbers::pi, glm::dvec3(1, 0, 0))}, wish);
  EXPECT_TRUE(std::isfinite(room.turned));
  EXPECT_TRUE(std::isfinite(glm::length(room.origin)));
}

TEST(EyeView, SeesSidesAtItsTangents) {
  const EyeInRoom eye{turned({0.1, 1.5, 0.2}, 0.6, 0.3), -1.2, 0.9, -1.1, 1.0};
  const RoomInWorld room{{0.5, 0.1, -0.4}, -0.8, 0.5};
  const View view = eye_view(eye, room, 0.02, 20.0);
  struct Corner {
    double x, y;
    glm::vec2 clip;
  };
  for (const Corner& corner :
       {Corner{-1.2, -1.1, {-1, -1}}, Corner{0.9, 1.0, {1, 1}}, Corner{-1.2, 1.0, {-1, 1}}}) {
    const Pose at = room.to_world(compose(eye.pose, {{2.0 * corner.x, 2.0 * corner.y, -2.0}, {1, 0, 0, 0}}));
    const glm::vec4 clip = view.projection * view.view * glm::vec4(glm::vec3(at.position), 1.0f);
    EXPECT_NEAR(clip.x / clip.w, corner.clip.x, 1e-5);
    EXPECT_NEAR(clip.y / clip.w, corner.clip.y, 1e-5);
    EXPECT_NEAR(clip.w, 1.0, 1e-5) << "m of the world: two of the room";
  }
  for (const double plane : {0.02, 20.0}) {
    const Pose at = room.to_world(compose(eye.pose, {{0, 0, -2.0 * plane}, {1, 0, 0, 0}}));
    const glm::vec4 clip = view.projection * view.view * glm::vec4(glm::vec3(at.position), 1.0f);
    EXPECT_NEAR(clip.z / clip.w, plane < 1.0 ? -1.0 : 1.0, 2e-4);
  }
}

TEST(AnchorWish, PutsTwoHandlesSideBySideAndOthersAsTheCameraSeesThem) {
  Scene scene;
  scene.camera.eye = {0.6, 0.5, 0.9};
  scene.bodies.resize(1);
  scene.bodies[0].pose.position = {0.0, 0.3, 0.0};
  scene.grips.resize(2);
  scene.grips[0].body = scene.grips[1].body = 0;
  scene.grips[0].pose.position = {-0.14, 0.1, 0.0};
  scene.grips[1].pose.position = {0.14, 0.1, 0.0};
  AnchorWish wish = anchor_wish(scene, {});
  EXPECT_LT(glm::distance(wish.focus, glm::dvec3(0.0, 0.4, 0.0)), 1e-12);
  EXPECT_LT(glm::distance(glm::normalize(wish.facing), glm::dvec3(0, 0, -1)), 1e-12);
  scene.grips.resize(1);
  wish = anchor_wish(scene, {2.0, 0.9, 1.0});
  EXPECT_LT(glm::distance(wish.facing, glm::dvec3(-0.6, -0.5, -0.9)), 1e-12);
  EXPECT_EQ(wish.height, 0.9);
  EXPECT_EQ(wish.scale, 0.5);
  scene.grips.clear();
  EXPECT_EQ(anchor_wish(scene, {}).focus, scene.camera.target);
}

TEST(PanelPlace, StandsBehindTheSceneAndFacesTheHead) {
  AnchorWish wish;
  for (const double about : {0.0, 1.2, -2.0}) {
    const Pose head = turned({0.3, 1.7, 0.8}, about, 0.4);
    const HeadsetPanel panel = panel_place(head, wish);
    const glm::dvec3 way = head.position - panel.pose.position;
    const glm::dvec3 faces = panel.pose.orientation * glm::dvec3(0, 0, 1);
    EXPECT_NEAR(faces.y, 0.0, 1e-12);
    EXPECT_NEAR(glm::dot(glm::normalize(glm::dvec3(way.x, 0, way.z)), faces), 1.0, 1e-9);
    EXPECT_GT(std::hypot(way.x, way.z), wish.distance + 0.2);
  }
}

TEST(PanelView, HasThePanelAndWhatIsBeforeIt) {
  const RoomInWorld room{{1.0, -0.5, 2.0}, 0.7, 0.5};
  HeadsetPanel panel;
  panel.pose = turned({0.2, 1.4, -1.1}, 0.3, 0.0);
  panel.size = {0.9, 0.6};
  const glm::dvec3 eye(0.05, 1.6, 0.4);
  const View view = panel_view(panel.pose, panel.size, eye, room, 0.015);
  const auto place = [&](const glm::dvec3& in_room) {
    const glm::dvec3 world = room.to_world(Pose{in_room, {1, 0, 0, 0}}).position;
    return view.projection * view.view * glm::vec4(glm::vec3(world), 1.0f);
  };
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      const glm::dvec3 corner =
          panel.pose.position + panel.pose.orientation * glm::dvec3(0.45 * x, 0.3 * y, 0.0);
      const glm::vec4 clip = place(corner);
      EXPECT_NEAR(clip.x / clip.w, x, 1e-4);
      EXPECT_NEAR(clip.y / clip.w, y, 1e-4);
      EXPECT_NEAR(clip.w, view.far_plane, 1e-4);
      // Half-way to the eye it hides the same corner, and lies before the panel; beyond it, behind.
      const glm::vec4 before = place(0.5 * (corner + eye));
      EXPECT_NEAR(before.x / before.w, x, 1e-4);
      EXPECT_NEAR(before.w, 0.5 * view.far_plane, 1e-4);
      EXPECT_GT(place(corner + 0.1 * (corner - eye)).w, view.far_plane);
    }
  }
}

TEST(PanelView, HeldBodiesBeforeItAreToldAndThoseBehindAreNot) {
  Scene scene;
  scene.meshes.resize(1);
  scene.meshes[0].positions = {{-0.05f, -0.05f, -0.05f}, {0.05f, 0.05f, 0.05f}};
  scene.bodies.resize(1);
  scene.bodies[0].mesh = 0;
  scene.grips.resize(1);
  scene.grips[0].body = 0;
  const HeldRects held(scene);
  const Pose panel{{0.0, 1.5, -1.0}, {1, 0, 0, 0}};
  const View view = panel_view(panel, {0.8, 0.6}, {0.0, 1.5, 0.0}, {}, 0.03);
  Snapshot snapshot;
  snapshot.rigid.bodies.resize(1);
  snapshot.rigid.grips.resize(1);
  const auto rects = [&](double z) {
    snapshot.rigid.bodies[0].pose.position = {0.0, 1.5, z};
    snapshot.rigid.grips[0].handle.position = {0.0, 1.5, z};
    return held.of(snapshot, view);
  };
  ASSERT_EQ(rects(-0.5).size(), 1u);
  // A tenth of a metre at half the way, its near side at 0.45: 0.05 · 1/0.45 of 0.8 and 0.6 each way.
  EXPECT_NEAR(rects(-0.5)[0].low.x, 0.5 - 0.1111 / 0.8, 1e-3);
  EXPECT_NEAR(rects(-0.5)[0].high.y, 0.5 + 0.1111 / 0.6, 1e-3);
  EXPECT_TRUE(rects(-1.5).empty());
  EXPECT_TRUE(rects(0.5).empty());
}

}  // namespace
}  // namespace slosh
