// Heat and guided tasks on their way in a scene's package.
#include <gtest/gtest.h>

#include "net/wire/acting_fields.h"
#include "net/wire/scene_package.h"
#include "tests/net/wire/package_kit.h"
#include "tests/net/wire/same_scene.h"
#include "tests/support/small_scene.h"

namespace slosh {
namespace {

using test::package_error;
using test::packed;
using test::stored;
using wire::Bytes;

TEST(ActingScene, HeatAndTaskTravelWithAWholeScene) {
  Scene scene = test::small_scene();
  Heat& heat = scene.fluids[0].heat;
  heat.temperature = 35.5;
  heat.viscosity = {{20.0, 1.0}, {60.0, 0.125}};
  heat.sets_above = 70.0;
  heat.sets_in = 8.0;
  heat.set_times = 50.0;
  scene.bodies[0].temperature = 180.0;
  scene.bodies[1].motion = BodyMotion::kDriven;
  scene.bodies[1].keys = {{0.0, scene.bodies[1].pose}, {1.5, {{0.1, 0.2, 0.3}, {1.0, 0.0, 0.0, 0.0}}}};
  scene.bodies[1].repeats = true;
  scene.joints.push_back({"lid", JointKind::kHinge, 0, 1, {{0.1, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}, -0.5});
  scene.gauges.push_back({"level", 0, {0.1, 0.2, 0.3}});
  Goal level{GoalKind::kLevel, "level", 0}, leans{GoalKind::kTilt, scene.bodies[1].name, 1};
  level.at_least = 0.2;
  leans.at_most = 10.0;
  Goal straight{GoalKind::kNot};
  straight.parts = {leans};
  Goal both{GoalKind::kAll};
  both.parts = {straight, level};
  scene.task = {{"Fill it.", "Slowly.", both, 1.5, 20.0, 5.0}, {"Set it down.", "", leans}};
  const Bytes all = packed(scene);
  EXPECT_EQ(all[0], 6);
  const Result<UnpackedScene> back = unpack_scene(all);
  ASSERT_TRUE(static_cast<bool>(back)) << back.error().text();
  test::expect_same_scene(back.value().scene, scene);
  const Result<UnpackedScene> seen = unpack_scene(packed(scene, SceneParts::kSeen));
  EXPECT_EQ(packed(scene, SceneParts::kSeen)[0], 1) << "a peer is told what to do, and steps nothing";
  EXPECT_TRUE(seen.value().scene.task.empty());
  scene.task[0].until.parts[1].thing = 3;
  EXPECT_NE(pack_scene(scene, 0.01, SceneParts::kAll).error().text().find("is not in the scene"),
            std::string::npos);
}

// Joints that let go or close need the version that has this; any other travels as before.
TEST(ActingScene, JointsThatChangeTravel) {
  Scene scene = test::small_scene();
  scene.joints.push_back({"lid", JointKind::kHinge, 0, 1, {{0.1, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}});
  EXPECT_EQ(packed(scene)[0], 6);
  scene.joints[0].breaks_torque = 2.5;
  Joint catches{"catch", JointKind::kFixed, 0, 1};
  catches.starts_apart = true;
  catches.joins_within = 0.002;
  catches.joins_turn = 0.25;
  catches.meets = Pose{{0.1, 0.2, 0.3}, {0.6, 0.8, 0.0, 0.0}};
  scene.joints.push_back(catches);
  const Bytes all = packed(scene);
  EXPECT_EQ(all[0], 7);
  const Result<UnpackedScene> back = unpack_scene(all);
  ASSERT_TRUE(static_cast<bool>(back)) << back.error().text();
  test::expect_same_scene(back.value().scene, scene);
  EXPECT_EQ(packed(scene, SceneParts::kSeen)[0], 1);
  scene.joints[1].joins_within = 0.0;
  EXPECT_NE(pack_scene(scene, 0.01, SceneParts::kAll).error().text().find("never closes"), std::string::npos);
  scene.joints.assign(1, {"glue", JointKind::kFixed, 0, 1});
  EXPECT_EQ(packed(scene)[0], 7);
}

TEST(ActingScene, WhatComesAndGoesTravelsToo) {
  Scene scene = test::small_scene();
  const int bodies = static_cast<int>(scene.bodies.size());
  scene.bodies[1].motion = BodyMotion::kDriven;
  scene.bodies[1].keys = {{0.0, scene.bodies[1].pose}};
  scene.bodies[1].starts_away = true;
  scene.fluid_volumes[0].fillings = 3;
  scene.fluid_volumes[0].body = 1;
  scene.regions.push_back({"in it", 0, -1, {}});
  scene.task = {{"Fill it.", "", {GoalKind::kTilt, scene.bodies[1].name, 1}}};
  scene.task[0].until.at_most = 10.0;
  scene.task[0].then = {
      {TaskActKind::kAppears, 1, -1}, {TaskActKind::kTakesAway, bodies, 0}, {TaskActKind::kHandTakes, 0, 0}};
  const Bytes all = packed(scene);
  EXPECT_EQ(all[0], 7);
  const Result<UnpackedScene> back = unpack_scene(all);
  ASSERT_TRUE(static_cast<bool>(back)) << back.error().text();
  test::expect_same_scene(back.value().scene, scene);
  const auto refused = [&](const char* why) {
    const std::string said = pack_scene(scene, 0.01, SceneParts::kAll).error().text();
    EXPECT_NE(said.find(why), std::string::npos) << said;
  };
  scene.task[0].then[1].other = 5;
  refused("is not in the scene");
  Body shelf = scene.bodies[1];
  shelf.motion = BodyMotion::kFixed;
  shelf.keys.clear();
  shelf.starts_away = false;
  scene.bodies.push_back(shelf);
  scene.task[0].then = {{TaskActKind::kAppears, bodies, -1}};
  refused("stays there for good");
  scene.task[0].then.clear();
  scene.bodies.back().starts_away = true;
  refused("is of a fixed body");
}

TEST(ActingScene, WhatMayBeCutAndWhatCutsTravelToo) {
  Scene scene = test::small_scene();
  const std::size_t butter = scene.bodies.size();
  Body body = scene.bodies[1];
  body.motion = BodyMotion::kFree;
  body.mass = {1.0, glm::dvec3(0.0), glm::dmat3(1.0)};
  body.keys.clear();
  body.pieces = 2;
  body.cut_n_m = 40.0;
  scene.bodies.push_back(body);
  body.pieces = 0;
  body.piece_of = static_cast<int>(butter);
  body.starts_away = true;
  scene.bodies.push_back(body);
  body = scene.bodies[butter];
  body.pieces = 0;
  body.cut_n_m = 0.0;
  body.blade = true;
  scene.bodies.push_back(body);
  const Bytes all = packed(scene);
  EXPECT_EQ(all[0], 8);
  const Result<UnpackedScene> back = unpack_scene(all);
  ASSERT_TRUE(static_cast<bool>(back)) << back.error().text();
  test::expect_same_scene(back.value().scene, scene);
  EXPECT_EQ(packed(scene, SceneParts::kSeen)[0], 1) << "a peer is told of cuts as they are made";
  const auto refused = [&](const char* why) {
    const std::string said = pack_scene(scene, 0.01, SceneParts::kAll).error().text();
    EXPECT_NE(said.find(why), std::string::npos) << said;
  };
  scene.bodies[butter + 1].piece_of = static_cast<int>(butter) + 2;
  refused("cannot be cut");
  scene.bodies[butter + 1].piece_of = static_cast<int>(butter);
  scene.bodies[butter].pieces = 0;
  refused("is of a body that cannot be cut");
  scene.bodies[butter].pieces = 2;
  scene.bodies[butter + 2].motion = BodyMotion::kFixed;
  refused("is a fixed body's");
}

// A goal that says it has more parts than come, and one with a part too many.
TEST(ActingScene, GoalsThatDoNotFitTheirStepsAreRefused) {
  wire::SceneAt<wire::kActingScene> acting{{test::small_scene(), 0.01}};
  std::vector<wire::SentGoal>& goals = acting.packed.goals;
  acting.packed.scene.task.resize(1);
  goals.push_back({{GoalKind::kTilt, "", 0, -1, 0.0, 1.0, {}}, 0});
  const auto error = [&] {
    Bytes content;
    EXPECT_FALSE(wire::encode(acting, content));
    Bytes package = stored(content);
    package[0] = 6;
    return package_error(package);
  };
  EXPECT_EQ(error(), "");
  goals[0].parts = 1;
  EXPECT_NE(error().find("goals"), std::string::npos) << "a tilt is made of nothing";
  goals[0] = {{GoalKind::kNot, "", -1, -1, 0.0, 1.0, {}}, 1};
  EXPECT_NE(error().find("goals"), std::string::npos) << "its part is missing";
  goals.push_back({{GoalKind::kTilt, "", 0, -1, 0.0, 1.0, {}}, 0});
  EXPECT_EQ(error(), "");
  goals.push_back(goals.back());
  EXPECT_NE(error().find("goals"), std::string::npos) << "one is left over";
}

}  // namespace
}  // namespace slosh
