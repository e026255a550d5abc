// Gauges and regions as a scene file has them, and walls that stick or slip.
#include "scenes/sample.h"
#include "support.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::expect_edit_error;
using test::node_named;

/// The cup with a gauge that hangs on it and one that stands, and a region that hangs on it.
json instruments(json& j) {
  const int mesh = node_named(j, "water")["mesh"].get<int>();
  const auto add = [&](const char* name, json extras, json more) {
    json node = {{"name", name}, {"extras", std::move(extras)}};
    node.update(more);
    j["nodes"].push_back(node);
    return static_cast<int>(j["nodes"].size()) - 1;
  };
  const int in_cup = add("in cup", {{"slosh", "gauge"}}, {{"translation", {0.01, 0.02, 0.03}}});
  const int beside = add("beside", {{"slosh", "gauge"}}, {{"translation", {0.3, 0.0, 0.1}}});
  const int held = add("held", {{"slosh", "region"}}, {{"mesh", mesh}});
  json& cup = node_named(j, "cup");
  cup["translation"] = {0.0, 0.5, 0.0};
  cup["children"].push_back(in_cup);
  cup["children"].push_back(held);
  node_named(j, "hand");
  j["scenes"][0]["nodes"].push_back(beside);
  return j;
}

/// Only the cup moves up: its hand is no longer at its grip.
void without_hand(json& j) {
  node_named(j, "hand")["extras"] = json::object();
  j.erase("animations");
}

TEST(InstrumentNodes, HangOnTheirBodyOrStand) {
  const auto scene = test::load_edited([](json& j) {
    instruments(j);
    without_hand(j);
  });
  ASSERT_TRUE(scene) << scene.error().text();
  const Scene& s = scene.value();
  ASSERT_EQ(s.gauges.size(), 2u);
  const Gauge& in_cup = s.gauges[s.gauges[0].name == "in cup" ? 0 : 1];
  const Gauge& beside = s.gauges[s.gauges[0].name == "in cup" ? 1 : 0];
  EXPECT_EQ(in_cup.body, 0);
  EXPECT_NEAR(glm::length(in_cup.position - glm::dvec3(0.01, 0.02, 0.03)), 0.0, 1e-6) << "in the cup's frame";
  EXPECT_EQ(beside.body, -1);
  EXPECT_NEAR(glm::length(beside.position - glm::dvec3(0.3, 0.0, 0.1)), 0.0, 1e-6);
  ASSERT_EQ(s.regions.size(), 1u);
  EXPECT_EQ(s.regions[0].name, "held");
  EXPECT_EQ(s.regions[0].body, 0);
  EXPECT_GE(s.regions[0].mesh, 0);
  EXPECT_EQ(s.bodies.size(), 1u) << "a region is no body";
  const auto sampled = sample_scene(s, 0.012);
  ASSERT_TRUE(sampled) << sampled.error().text();
  EXPECT_EQ(sampled.value().region_fields.size(), 1u);
}

TEST(InstrumentNodes, MistakesNameFileNodeAndField) {
  expect_edit_error(
      [](json& j) {
        node_named(j, "handle")["extras"] = {{"slosh", "region"}};
      },
      {"cup.gltf", "handle", "slosh", "no mesh"});
  expect_edit_error(
      [](json& j) {
        node_named(j, "handle")["extras"] = {{"slosh", "gauge"}, {"sloosh", 1.0}};
        without_hand(j);
      },
      {"cup.gltf", "handle", "sloosh", "not a property"});
  expect_edit_error(
      [](json& j) {
        node_named(j, "handle")["extras"] = {{"slosh", "gauge"}};
        node_named(j, "water")["extras"] = {{"slosh", "picture"}};
        without_hand(j);
      },
      {"cup.gltf", "handle", "fluid"});
  expect_edit_error(
      [](json& j) {
        node_named(j, "hand")["extras"] = {{"slosh", "gauge"}};
      },
      {"cup.gltf", "hand", "animation", "only a hand can be animated"});
  expect_edit_error([](json& j) { node_named(j, "cup")["extras"]["slosh"] = "gage"; },
                    {"cup.gltf", "cup", "gauge", "region"});
}

TEST(WallViscosity, AWallSticksUnlessItSaysThatItSlips) {
  const auto viscosity = [](const char* field, const json& value) {
    const auto scene = test::load_edited([&](json& j) {
      if (field != nullptr) node_named(j, "cup")["extras"][field] = value;
    });
    EXPECT_TRUE(scene) << scene.error().text();
    return scene.value().bodies.at(0).dynamic_viscosity;
  };
  EXPECT_EQ(viscosity(nullptr, {}), kFluidsViscosity);
  EXPECT_EQ(viscosity("slip", false), kFluidsViscosity);
  EXPECT_EQ(viscosity("slip", true), kFreeSlip);
  EXPECT_EQ(viscosity("viscosity_pa_s", 0.0), 0.0);
  EXPECT_EQ(viscosity("viscosity_pa_s", 2.5), 2.5);
  expect_edit_error(
      [](json& j) {
        node_named(j, "cup")["extras"]["slip"] = true;
        node_named(j, "cup")["extras"]["viscosity_pa_s"] = 2.0;
      },
      {"cup.gltf", "cup", "slip", "viscosity_pa_s"});
  expect_edit_error([](json& j) { node_named(j, "cup")["extras"]["slip"] = "no"; },
                    {"cup.gltf", "cup", "slip", "true or false"});
}

}  // namespace
}  // namespace slosh
