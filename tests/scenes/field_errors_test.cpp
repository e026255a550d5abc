// Wrong custom properties: each error names file, node and field.
#include <cmath>

#include "support.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::expect_edit_error;
using test::node_named;

void expect_field_error(const char* node, const char* field, const json& value,
                        std::initializer_list<const char*> words) {
  SCOPED_TRACE(std::string(node) + "." + field + " = " + value.dump());
  const auto result = test::load_edited([&](json& j) { node_named(j, node)["extras"][field] = value; });
  test::expect_error(result, {"cup.gltf", node, field});
  test::expect_error(result, words);
}

void expect_scene_error(const char* field, const json& value, std::initializer_list<const char*> words) {
  SCOPED_TRACE(std::string(field) + " = " + value.dump());
  const auto result = test::load_edited([&](json& j) { j["scenes"][0]["extras"][field] = value; });
  test::expect_error(result, {"cup.gltf", "scene", field});
  test::expect_error(result, words);
}

TEST(FieldErrors, UneditedCupLoads) {
  const auto scene = test::load_edited([](json&) {});
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_EQ(scene.value().bodies.size(), 1u);
  EXPECT_EQ(scene.value().fluid_volumes.size(), 1u);
  EXPECT_EQ(scene.value().grips.size(), 1u);
  EXPECT_EQ(scene.value().title, "a cup");
}

TEST(FieldErrors, NumbersOutOfRange) {
  expect_field_error("cup", "mass_kg", -1.0, {"-1", "above 0"});
  expect_field_error("cup", "mass_kg", 0, {"0", "above 0"});
  expect_field_error("cup", "mass_kg", 1e300, {"1e+300", "above 0, at most 1e+09"});
  expect_field_error("cup", "viscosity_pa_s", -0.5, {"-0.5", "from 0 to 1e+07"});
  expect_field_error("cup", "friction", -1, {"-1"});
  expect_field_error("cup", "restitution", 1.5, {"1.5", "0 to 1"});
  expect_field_error("cup", "particle_density_kg_m3", -3, {"-3"});
  expect_field_error("water", "density_kg_m3", 0.0, {"0"});
  expect_field_error("water", "density_kg_m3", -1000, {"-1000"});
  expect_field_error("water", "viscosity_pa_s", -1, {"-1"});
  expect_field_error("water", "gloss", 1.5, {"1.5", "0 to 1"});
  expect_field_error("water", "refraction", 0.9, {"0.9", "1 to 3"});
  expect_field_error("water", "scattering", -0.1, {"-0.1", "0 to 1"});
  expect_field_error("water", "roughness", 2, {"2", "0 to 1"});
  expect_field_error("handle", "stiffness_n_m", 2e6, {"2e+06"});
  expect_field_error("handle", "damping_n_s_m", -1, {"-1"});
  expect_field_error("handle", "rotational_stiffness_nm_rad", 1e5, {"100000"});
  expect_field_error("handle", "device", 0.5, {"0.5", "whole"});
}

TEST(FieldErrors, WrongTypes) {
  expect_field_error("cup", "mass_kg", "heavy", {"heavy", "not a number"});
  expect_field_error("cup", "measured", "yes", {"yes", "true or false"});
  expect_field_error("cup", "motion", "floating", {"floating", "fixed, free"});
  expect_field_error("cup", "motion", 3, {"3", "text"});
  expect_field_error("cup", "slosh", "boddy", {"boddy", "body", "fluid", "probe"});
  expect_field_error("cup", "center_of_mass_m", {0, 1}, {"3 numbers"});
  expect_field_error("cup", "inertia_kg_m2", {1, 1, 1, 0, 0, "x"}, {"6 numbers"});
  expect_field_error("cup", "inertia_kg_m2", {1, 1, 5, 0, 0, 0}, {"inertia of a solid"});
  expect_field_error("water", "color", {1, 2, 0}, {"0 to 1"});
  expect_field_error("water", "gloss", "shiny", {"shiny", "not a number"});
  expect_field_error("water", "velocity_m_s", "fast", {"fast"});
}

TEST(FieldErrors, UnknownKeysListTheKnown) {
  expect_field_error("cup", "mass", 1.0, {"mass_kg", "friction", "not a property"});
  expect_field_error("water", "density", 1.0, {"density_kg_m3"});
  expect_field_error("handle", "stiffness", 1.0, {"stiffness_n_m"});
  expect_field_error("hand", "grips", "x", {"grip"});
  expect_scene_error("spacing", 0.01, {"spacing_m", "gravity_m_s2"});
}

TEST(FieldErrors, AFluidsLookIsReadAndOpaqueFluidIsCloudyUnlessSaidOtherwise) {
  const auto fluid_of = [](const json& fields) {
    const auto scene = test::load_edited([&](json& j) { node_named(j, "water")["extras"].update(fields); });
    EXPECT_TRUE(scene) << scene.error().text();
    return scene ? scene.value().fluids[0] : Fluid{};
  };
  const Fluid honey =
      fluid_of({{"gloss", 0.5}, {"refraction", 1.49}, {"scattering", 0.25}, {"roughness", 0.125}});
  EXPECT_EQ(honey.gloss, 0.5f);
  EXPECT_EQ(honey.refraction, 1.49f);
  EXPECT_EQ(honey.scattering, 0.25f);
  EXPECT_EQ(honey.roughness, 0.125f);
  EXPECT_EQ(fluid_of({{"extinction_per_m", {90, 90, 90}}}).scattering, 0.2f);
  EXPECT_EQ(fluid_of({{"extinction_per_m", {90, 100, 120}}}).scattering, 1.0f);
  EXPECT_EQ(fluid_of({{"extinction_per_m", {400, 400, 400}}, {"scattering", 0.0}}).scattering, 0.0f);
}

TEST(FieldErrors, KeysOfOthersAreLeftAlone) {
  const auto scene = test::load_edited([](json& j) {
    node_named(j, "cup")["extras"]["_note"] = "mine";
    node_named(j, "cup")["extras"]["Rigify"] = 3;
    node_named(j, "cup")["extras"]["targetNames"] = json::array();
    j["scenes"][0]["extras"]["glTF2ExportSettings"] = json::object();
  });
  EXPECT_TRUE(scene) << scene.error().text();
}

TEST(FieldErrors, Body) {
  expect_field_error("cup", "density_kg_m3", 500.0, {"mass_kg", "together"});
  expect_edit_error([](json& j) { node_named(j, "cup")["extras"].erase("mass_kg"); },
                    {"'cup'", "mass_kg", "free", "density_kg_m3"});
  expect_edit_error([](json& j) { node_named(j, "cup").erase("mesh"); },
                    {"cup.gltf", "'cup'", "slosh", "no mesh"});
}

TEST(FieldErrors, GripsAndHands) {
  expect_edit_error([](json& j) { node_named(j, "hand")["extras"]["grip"] = "hanlde"; },
                    {"'hand'", "grip", "hanlde", "handle"});
  expect_edit_error([](json& j) { node_named(j, "hand")["extras"].erase("grip"); },
                    {"'hand'", "grip", "missing"});
  expect_edit_error([](json& j) { node_named(j, "cup")["extras"]["motion"] = "fixed"; },
                    {"'handle'", "'cup'", "fixed"});
  expect_edit_error(
      [](json& j) {
        node_named(j, "water")["extras"] = {{"slosh", "grip"}};
      },
      {"'water'", "child of a body"});
  expect_edit_error(
      [](json& j) {
        json again = node_named(j, "hand");
        again["name"] = "hand2";
        j["nodes"].push_back(again);
        j["scenes"][0]["nodes"].push_back(j["nodes"].size() - 1);
      },
      {"'hand2'", "'handle'", "another hand"});
}

TEST(FieldErrors, DevicesAreNumberedOnce) {
  const auto with_two = [](int first, int second) {
    return [=](json& j) {
      json again = node_named(j, "handle");
      again["name"] = "handle2";
      again["extras"]["device"] = second;
      node_named(j, "handle")["extras"]["device"] = first;
      j["nodes"].push_back(again);
      node_named(j, "cup")["children"].push_back(j["nodes"].size() - 1);
    };
  };
  expect_edit_error(with_two(1, 1), {"device", "handle"});
  const auto scene = test::load_edited(with_two(1, 0));
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_EQ(scene.value().grips[0].name, "handle2");
}

TEST(FieldErrors, ProbeCannotTurn) {
  const auto probe = [](double stiffness) {
    return [=](json& j) {
      node_named(j, "cup")["extras"] = {{"slosh", "probe"}, {"mass_kg", 0.05}};
      node_named(j, "handle")["extras"]["rotational_stiffness_nm_rad"] = stiffness;
    };
  };
  expect_edit_error(probe(5.0), {"'handle'", "rotational_stiffness_nm_rad", "point"});
  EXPECT_TRUE(test::load_edited(probe(0.0)));
}

TEST(FieldErrors, NamesTwice) {
  expect_edit_error([](json& j) { node_named(j, "water")["name"] = "cup"; }, {"'cup'", "another node"});
}

TEST(FieldErrors, Fluids) {
  expect_scene_error("fluids", 3, {"group"});
  expect_scene_error("fluids", {{"water", {{"density", 3}}}}, {"water", "density_kg_m3"});
  expect_scene_error("fluids", {{"water", {{"viscosity_pa_s", -3}}}}, {"water", "viscosity_pa_s", "-3"});
  expect_edit_error(
      [](json& j) {
        j["scenes"][0]["extras"]["fluids"] = {{"milk", {{"density_kg_m3", 1030}}}};
        node_named(j, "water")["extras"]["fluid"] = "milk";
        node_named(j, "water")["extras"]["density_kg_m3"] = 1000;
      },
      {"'water'", "density_kg_m3", "milk"});
}

TEST(FieldErrors, Scene) {
  expect_scene_error("spacing_m", -0.01, {"-0.01"});
  expect_scene_error("spacing_min_m", 2.0, {"2", "0.0001 to 1"});
  expect_edit_error(
      [](json& j) {
        j["scenes"][0]["extras"]["spacing_min_m"] = 0.02;
        j["scenes"][0]["extras"]["spacing_max_m"] = 0.01;
      },
      {"cup.gltf", "spacing_min_m", "0.02", "spacing_max_m"});
  expect_scene_error("support_ratio", 1.0, {"1.5 to 2.6"});
  expect_scene_error("support_ratio", 3.0, {"1.5 to 2.6"});
  expect_scene_error("tension", 2, {"0 to 1"});
  expect_scene_error("stiffness_m2_s2", -1, {"-1"});
  expect_scene_error("gravity_m_s2", -9.81, {"3 numbers"});
  expect_scene_error("duration_s", 0, {"0"});
  expect_scene_error("light_direction", {0, 0, 0}, {"no length"});
  expect_scene_error("title", 3, {"text"});
  expect_scene_error("domain_min_m", {9, 9, 9}, {"domain_max_m"});
  expect_edit_error(
      [](json& j) {
        j["scenes"][0]["extras"]["domain_max_m"] = {0.0, 1.0, 1.0};
      },
      {"'water'", "outside the domain"});
}

TEST(FieldErrors, EmptyScene) {
  expect_edit_error(
      [](json& j) {
        for (json& node : j["nodes"]) node.erase("extras");
      },
      {"cup.gltf", "neither a body nor a fluid", "slosh"});
  expect_edit_error([](json& j) { j["scenes"][0]["nodes"] = json::array(); }, {"neither a body nor a fluid"});
}

TEST(FieldErrors, Transforms) {
  expect_edit_error([](json& j) { node_named(j, "cup")["scale"] = {1, 0, 1}; }, {"'cup'", "scale"});
  expect_edit_error([](json& j) { node_named(j, "cup")["rotation"] = {0, 0, 0, 0}; }, {"'cup'", "transform"});
  expect_edit_error(
      [](json& j) {
        node_named(j, "cup")["translation"] = {0, -1e30, 0};
      },
      {"'cup'", "translation", "10 km"});
  expect_edit_error(
      [](json& j) {
        const auto hand = j["nodes"].size() - 1;
        j["nodes"][hand]["children"] = {hand};
      },
      {"'hand'", "more than one node"});
}

TEST(FieldValues, ScaleIsBakedAndPosesStayRigid) {
  const auto scene = test::load_edited([](json& j) {
    j.erase("animations");
    node_named(j, "cup")["scale"] = {2, 1, 3};
    node_named(j, "hand")["translation"] = {0, 0.1, 0};
  });
  ASSERT_TRUE(scene) << scene.error().text();
  const Scene& s = scene.value();
  glm::vec3 high(0.0f);
  for (const glm::vec3& p : s.meshes[s.bodies[0].mesh].positions) high = glm::max(high, p);
  EXPECT_LT(glm::distance(high, glm::vec3(0.14f, 0.12f, 0.21f)), 1e-5f);
  EXPECT_NEAR(glm::length(s.bodies[0].pose.orientation), 1.0, 1e-12);
  EXPECT_NEAR(rotation_between({1, 0, 0, 0}, s.bodies[0].pose.orientation).x, 0.0, 1e-9);
}

TEST(FieldValues, ModelIsOneOfThree) {
  const auto with_model = [](const char* model) {
    return test::load_edited([=](json& j) { j["scenes"][0]["extras"]["model"] = model; });
  };
  const auto paper = with_model("paper");
  ASSERT_TRUE(paper) << paper.error().text();
  EXPECT_EQ(paper.value().model, ParticleModel::kPaper);
  const auto unknown = with_model("pbf");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().text().find("'pbf'"), std::string::npos);
  EXPECT_NE(unknown.error().text().find("model"), std::string::npos);
  const auto gone = with_model("consistent");
  ASSERT_FALSE(gone);
  for (const char* word : {"'consistent', a model that is no more", "\"corrected\", which took its place",
                           "\"incompressible\"", "\"paper\""})
    EXPECT_NE(gone.error().text().find(word), std::string::npos) << word << ": " << gone.error().text();
}

TEST(FieldValues, SettlesWhereNothingIsSaidAndNothingMoves) {
  const auto plain = test::load_edited([](json&) {});
  ASSERT_TRUE(plain) << plain.error().text();
  EXPECT_EQ(plain.value().settle, 1.0);
  EXPECT_EQ(plain.value().settle_longest, 4.0);
  const auto not_at_all = test::load_edited([](json& j) { j["scenes"][0]["extras"]["settle_s"] = 0; });
  ASSERT_TRUE(not_at_all) << not_at_all.error().text();
  EXPECT_EQ(not_at_all.value().settle, 0.0);
  for (const char* node : {"cup", "water"}) {
    const auto moving = test::load_edited([node](json& j) {
      node_named(j, node)["extras"]["velocity_m_s"] = {0.5, 0.0, 0.0};
    });
    ASSERT_TRUE(moving) << moving.error().text();
    EXPECT_EQ(moving.value().settle, 0.0) << "what moves is not brought to rest";
  }
  const auto asked = test::load_edited([](json& j) { j["scenes"][0]["extras"]["settle_s"] = 0.75; });
  ASSERT_TRUE(asked) << asked.error().text();
  EXPECT_EQ(asked.value().settle, 0.75);
  EXPECT_EQ(asked.value().settle_longest, 0.0) << "what is written is done as it is written";
  expect_scene_error("settle_s", -1.0, {"-1", "0 to 60"});
  expect_scene_error("settle_s", 61.0, {"61", "0 to 60"});
  test::expect_edit_error(
      [](json& j) {
        j["scenes"][0]["extras"]["settle_s"] = 0.75;
        node_named(j, "water")["extras"]["velocity_m_s"] = {0.5, 0.0, 0.0};
      },
      {"cup.gltf", "water", "velocity_m_s", "settle_s"});
}

TEST(FieldValues, MirroredBodyStaysClosedAndOutward) {
  const auto scene = test::load_edited([](json& j) { node_named(j, "cup")["scale"] = {-1, 1, 1}; });
  EXPECT_TRUE(scene) << scene.error().text();
}

TEST(FieldValues, DensityGivesMassAndCentreCanBeMoved) {
  const auto scene = test::load_edited([](json& j) {
    json& extras = node_named(j, "cup")["extras"];
    extras.erase("mass_kg");
    extras["density_kg_m3"] = 500.0;
    extras["center_of_mass_m"] = {0.0, 0.05, 0.0};
    extras["measured"] = 1;
  });
  ASSERT_TRUE(scene) << scene.error().text();
  const Body& body = scene.value().bodies[0];
  EXPECT_NEAR(body.mass.mass, 500.0 * (0.14 * 0.12 * 0.14 - 0.001), 1e-6);
  EXPECT_EQ(body.mass.center_of_mass, glm::dvec3(0.0, 0.05, 0.0));
  EXPECT_TRUE(body.measured);
}

}  // namespace
}  // namespace slosh
