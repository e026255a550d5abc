// Joints and driven bodies as a scene file has them.
#include <numbers>

#include "support.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::node_named;

/// A fixed base, a free arm with a hinge to it, and a plate that goes by the keys of `pose_at`.
Result<Scene> load_linkage(const test::Edit& edit, const std::function<Pose(double)>& pose_at = {}) {
  make::SceneWriter writer(json{{"title", "a linkage"}});
  const int paint = writer.add_material("paint", {});
  const int mesh = writer.add_mesh("block", make::box(glm::dvec3(-0.02), glm::dvec3(0.02)), paint);
  writer.add_node("base", mesh, {}, {{"slosh", "body"}});
  const Pose at{{0.1, 0.2, 0.3}, glm::angleAxis(0.5, glm::dvec3(0, 1, 0))};
  const int arm = writer.add_node("arm", mesh, at, {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.5}});
  const Pose pivot{{0.1, 0.25, 0.3}, glm::angleAxis(0.5 * std::numbers::pi, glm::dvec3(1, 0, 0))};
  writer.add_node("pivot", -1, compose(inverse(at), pivot),
                  {{"slosh", "joint"}, {"kind", "hinge"}, {"to", "base"}}, arm);
  const int plate = writer.add_node("plate", mesh, {{0.5, 0.0, 0.0}, {1, 0, 0, 0}},
                                    {{"slosh", "body"}, {"motion", "driven"}});
  writer.animate(
      plate, [&](double t) { return pose_at ? pose_at(t) : Pose{{0.5 + 0.1 * t, 0, 0}, {1, 0, 0, 0}}; }, 1.0);
  const test::TempFolder folder;
  EXPECT_TRUE(writer.write(folder / "linkage.gltf"));
  json root = test::read_json(folder / "linkage.gltf");
  edit(root);
  test::write_text(folder / "linkage.gltf", root.dump());
  return load_scene(folder / "linkage.gltf");
}

void expect_linkage_error(const char* node, const json& fields, std::initializer_list<const char*> words) {
  test::expect_error(load_linkage([&](json& j) { node_named(j, node)["extras"].update(fields); }), words);
}

TEST(JointNodes, HaveTheirBodiesAndTheirAxis) {
  const auto scene = load_linkage([](json& j) {
    node_named(j, "pivot")["extras"].update(
        {{"min_deg", -90}, {"max_deg", 45}, {"damping_nm_s_rad", 0.1}, {"motor_rad_s", -3}, {"motor_nm", 2}});
  });
  ASSERT_TRUE(scene) << scene.error().text();
  ASSERT_EQ(scene.value().joints.size(), 1u);
  const Joint& joint = scene.value().joints[0];
  EXPECT_EQ(joint.name, "pivot");
  EXPECT_EQ(joint.kind, JointKind::kHinge);
  EXPECT_EQ(scene.value().bodies[static_cast<std::size_t>(joint.body)].name, "arm");
  EXPECT_EQ(scene.value().bodies[static_cast<std::size_t>(joint.other)].name, "base");
  const Pose world = compose(scene.value().bodies[static_cast<std::size_t>(joint.body)].pose, joint.pose);
  EXPECT_NEAR(glm::distance(world.position, glm::dvec3(0.1, 0.25, 0.3)), 0.0, 1e-6);
  EXPECT_NEAR(glm::distance(world.orientation * glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)), 0.0, 1e-6);
  EXPECT_NEAR(joint.lower, -0.5 * std::numbers::pi, 1e-12);
  EXPECT_NEAR(joint.upper, 0.25 * std::numbers::pi, 1e-12);
  EXPECT_EQ(joint.damping, 0.1);
  EXPECT_EQ(joint.motor_speed, -3.0);
  EXPECT_EQ(joint.motor_limit, 2.0);
}

TEST(JointNodes, WithoutToAreOfTheWorld) {
  const auto scene = load_linkage([](json& j) {
    node_named(j, "pivot")["extras"] = {{"slosh", "joint"}, {"kind", "slider"}, {"max_m", 0.2}};
  });
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_EQ(scene.value().joints[0].other, -1);
  EXPECT_EQ(scene.value().joints[0].kind, JointKind::kSlider);
  EXPECT_EQ(scene.value().joints[0].upper, 0.2);
  EXPECT_EQ(scene.value().joints[0].lower, -kNoStop);
}

TEST(JointNodes, SayWhatIsWrong) {
  expect_linkage_error("pivot", {{"kind", "ball"}}, {"'pivot'", "kind", "ball", "hinge, slider, fixed"});
  expect_linkage_error("pivot", {{"to", "bas"}}, {"'pivot'", "to", "'bas'", "Did you mean base"});
  expect_linkage_error("pivot", {{"to", "arm"}}, {"'pivot'", "to", "hangs on"});
  expect_linkage_error("pivot", {{"min_deg", 10}}, {"'pivot'", "min_deg", "10"});
  expect_linkage_error("pivot", {{"max_m", 0.1}}, {"'pivot'", "max_m", "slider's"});
  expect_linkage_error("pivot", {{"motor_rad_s", 1}}, {"'pivot'", "motor_rad_s", "motor_nm"});
  expect_linkage_error("pivot", {{"motor_nm", -1}}, {"'pivot'", "motor_nm", "-1"});
  expect_linkage_error("arm", {{"motion", "fixed"}}, {"'pivot'", "neither", "free"});
  expect_linkage_error("arm", {{"slosh", "probe"}, {"motion", nullptr}}, {"'pivot'", "point"});
  test::expect_error(load_linkage([](json& j) {
                       json& arm = node_named(j, "arm");
                       for (const json& child : arm["children"]) j["scenes"][0]["nodes"].push_back(child);
                       arm.erase("children");
                     }),
                     {"'pivot'", "not the child of a body"});
}

TEST(JointNodes, SayWhenTheyLetGo) {
  const auto scene = load_linkage(
      [](json& j) { node_named(j, "pivot")["extras"].update({{"breaks_n", 12.5}, {"breaks_nm", 0.5}}); });
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_EQ(scene.value().joints[0].breaks_force, 12.5);
  EXPECT_EQ(scene.value().joints[0].breaks_torque, 0.5);
  EXPECT_FALSE(scene.value().joints[0].starts_apart);
}

/// An empty on the base, which a joint that starts apart may name.
void add_mark(json& j, const char* holder = "base") {
  j["nodes"].push_back({{"name", "mark"}, {"translation", {0.01, 0.02, 0.03}}});
  node_named(j, holder)["children"].push_back(j["nodes"].size() - 1);
}
const json kCatch{{"slosh", "joint"},     {"kind", "fixed"},  {"to", "base"},
                  {"starts_apart", true}, {"joins_m", 0.002}, {"meets", "mark"}};

TEST(JointNodes, MeetAnEmptyOfTheOtherBody) {
  const auto scene = load_linkage([](json& j) {
    add_mark(j);
    node_named(j, "pivot")["extras"] = kCatch;
  });
  ASSERT_TRUE(scene) << scene.error().text();
  const Joint& joint = scene.value().joints[0];
  EXPECT_EQ(joint.kind, JointKind::kFixed);
  EXPECT_TRUE(joint.starts_apart);
  EXPECT_EQ(joint.joins_within, 0.002);
  EXPECT_NEAR(joint.joins_turn, std::numbers::pi / 18.0, 1e-12);
  ASSERT_TRUE(joint.meets);
  EXPECT_NEAR(glm::distance(joint.meets->position, glm::dvec3(0.01, 0.02, 0.03)), 0.0, 1e-6);
}

TEST(JointNodes, SayWhatIsWrongWithWhatChanges) {
  expect_linkage_error("pivot", {{"breaks_n", 0}}, {"'pivot'", "breaks_n", "0"});
  expect_linkage_error("pivot", {{"joins_m", 0.1}}, {"'pivot'", "joins_m", "fixed's", "hinge"});
  expect_linkage_error("pivot", {{"kind", "fixed"}, {"max_deg", 5}},
                       {"'pivot'", "max_deg", "hinge's", "fixed"});
  expect_linkage_error("pivot", {{"kind", "fixed"}, {"motor_n", 5}}, {"'pivot'", "motor_n", "slider's"});
  expect_linkage_error("pivot", {{"kind", "fixed"}, {"starts_apart", true}},
                       {"'pivot'", "starts_apart", "never close", "Give joins_m"});
  expect_linkage_error("pivot", {{"kind", "fixed"}, {"joins_deg", 5}},
                       {"'pivot'", "joins_deg", "Give joins_m"});
  const auto expect_catch_error = [](const json& fields, const char* holder, auto words) {
    test::expect_error(load_linkage([&](json& j) {
                         add_mark(j, holder);
                         node_named(j, "pivot")["extras"] = kCatch;
                         node_named(j, "pivot")["extras"].update(fields);
                       }),
                       words);
  };
  using Words = std::initializer_list<const char*>;
  expect_catch_error({{"meets", "mork"}}, "base", Words{"'pivot'", "meets", "'mork'", "there is none"});
  expect_catch_error(json::object(), "plate",
                     Words{"'pivot'", "meets", "not on the other body", "Parent it"});
  expect_catch_error({{"to", nullptr}}, "base", Words{"'pivot'", "meets", "Take it off its body"});
  expect_catch_error({{"starts_apart", false}}, "base", Words{"'pivot'", "meets", "starts_apart = true"});
}

TEST(DrivenBodies, TakeTheKeysOfTheirNode) {
  const auto scene = load_linkage([](json&) {});
  ASSERT_TRUE(scene) << scene.error().text();
  const Body& plate = scene.value().bodies.back();
  ASSERT_EQ(plate.name, "plate");
  EXPECT_EQ(plate.motion, BodyMotion::kDriven);
  EXPECT_FALSE(plate.repeats);
  ASSERT_EQ(plate.keys.size(), 61u);
  EXPECT_NEAR(plate.keys.back().pose.position.x, 0.6, 1e-6);
  EXPECT_EQ(plate.pose.position, plate.keys.front().pose.position);
  EXPECT_GT(scene.value().domain_max.x, 0.7) << "the domain has room for its way";
}

TEST(DrivenBodies, SayWhatIsWrong) {
  expect_linkage_error("plate", {{"motion", "fixed"}}, {"'plate'", "only a hand can be animated", "driven"});
  expect_linkage_error("base", {{"motion", "driven"}}, {"'base'", "animation is missing"});
  expect_linkage_error("base", {{"repeat", true}}, {"'base'", "repeat", "driven"});
  expect_linkage_error("plate", {{"repeat", true}}, {"'plate'", "repeat", "jump"});
  expect_linkage_error("plate", {{"velocity_m_s", {1, 0, 0}}}, {"'plate'", "velocity_m_s", "keys"});
  test::expect_error(
      load_linkage([](json&) {}, [](double t) { return Pose{{0.5 + 30.0 * t, 0, 0}, {1, 0, 0, 0}}; }),
      {"'plate'", "30 m/s", "at most 20"});
  const auto spun = [](double t) {
    return Pose{{0.5, 0, 0}, glm::angleAxis(120.0 * t, glm::dvec3(0, 1, 0))};
  };
  test::expect_error(load_linkage([](json&) {}, spun), {"'plate'", "120 rad/s"});
  // A grip on it.
  test::expect_error(load_linkage([](json& j) {
                       j["nodes"].push_back({{"name", "handle"}, {"extras", {{"slosh", "grip"}}}});
                       node_named(j, "plate")["children"] = {j["nodes"].size() - 1};
                     }),
                     {"'handle'", "'plate'", "driven by its keys"});
}

TEST(DrivenBodies, MayRepeatWhereTheirKeysMeet) {
  const auto circle = [](double t) {
    const double angle = 2.0 * std::numbers::pi * t;
    return Pose{{0.5 + 0.1 * std::sin(angle), 0.0, 0.1 * std::cos(angle)},
                glm::angleAxis(angle, glm::dvec3(0, 1, 0))};
  };
  const auto scene = load_linkage([](json& j) { node_named(j, "plate")["extras"]["repeat"] = true; }, circle);
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_TRUE(scene.value().bodies.back().repeats);
}

}  // namespace
}  // namespace slosh
