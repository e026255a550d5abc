// What a file says and slosh does not do is one list, for check and for a run.
#include "foreign_kit.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::expect_note;
using test::mesh_of;
using test::node_named;

std::size_t place_of_node(json& j, const char* node) {
  return static_cast<std::size_t>(&node_named(j, node) - &j["nodes"][0]);
}

/// A target that lays the mesh's own positions on top of them: its double at weight 1.
void add_shape_key(json& j, const char* node, double weight, bool on_node) {
  json& mesh = mesh_of(j, node);
  for (json& primitive : mesh["primitives"])
    primitive["targets"] = {{{"POSITION", primitive["attributes"]["POSITION"]}}};
  mesh["extras"]["targetNames"] = {"double"};
  (on_node ? node_named(j, node) : mesh)["weights"] = {weight};
}

TEST(Ledger, ShapeKeysWithAWeight) {
  for (const bool on_node : {false, true}) {
    expect_note("shape-key", [&](json& j) { add_shape_key(j, "cup", 1.0, on_node); },
                {"'cup'", "'double'", "weight 1"});
    const Inspection none = test::inspect_foreign([&](json& j) { add_shape_key(j, "cup", 0.0, on_node); });
    EXPECT_TRUE(test::kinds_of(none).empty()) << test::all_text(none.warnings);
  }
}

TEST(Ledger, SkinsHiddenNodesAndInstances) {
  expect_note("skin",
              [](json& j) {
                j["skins"] = {{{"joints", {place_of_node(j, "hand")}}}};
                node_named(j, "water")["skin"] = 0;
              },
              {"'water'", "rest shape"});
  expect_note("hidden",
              [](json& j) { node_named(j, "table")["extensions"]["KHR_node_visibility"]["visible"] = false; },
              {"'table'", "hidden"});
  expect_note(
      "instances",
      [](json& j) { node_named(j, "table")["extensions"]["EXT_mesh_gpu_instancing"] = json::object(); },
      {"'table'", "read once"});
}

TEST(Ledger, ChannelsThatMoveNothing) {
  expect_note("unused-animation",
              [](json& j) {
                json more = j["animations"][0];
                more["name"] = "turntable";
                for (json& channel : more["channels"]) channel["target"]["node"] = place_of_node(j, "table");
                j["animations"].push_back(more);
              },
              {"'turntable'", "'table'", "only hands"});
}

TEST(Ledger, KeysThatTheRunDoesNotComeTo) {
  const test::TempFolder folder;
  make::SceneWriter writer({{"title", "late"}, {"duration_s", 2.0}});
  const int paint = writer.add_material("paint", {});
  const int cup =
      writer.add_node("cup", writer.add_mesh("m", make::box({-0.05, 0, -0.05}, {0.05, 0.1, 0.05}), paint), {},
                      {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.5}});
  writer.add_node("handle", -1, {{0.0, 0.1, 0.0}, {1.0, 0.0, 0.0, 0.0}}, {{"slosh", "grip"}}, cup);
  writer.add_hand(
      "hand", "handle",
      [](double t) {
        return Pose{{0.1 * std::max(0.0, t - 4.0), 0.1, 0.0}, {1.0, 0.0, 0.0, 0.0}};
      },
      6.0);
  ASSERT_TRUE(writer.write(folder / "late.gltf"));
  const Inspection found = inspect_scene(folder / "late.gltf");
  ASSERT_TRUE(found.scene) << test::all_text(found.errors);
  const std::string all = test::all_text(found.warnings);
  EXPECT_NE(all.find("[late-keys]"), std::string::npos) << all;
  EXPECT_NE(all.find("the run lasts 2 s: it stands still"), std::string::npos) << all;
  EXPECT_NE(all.find("duration_s = 6"), std::string::npos) << all;
}

TEST(Ledger, LooksThatAreNotShown) {
  expect_note("lights",
              [](json& j) {
                j["extensionsUsed"] = {"KHR_lights_punctual"};
                j["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
                node_named(j, "table")["extensions"]["KHR_lights_punctual"]["light"] = 0;
              },
              {"1 light is not used", "light_direction"});
  expect_note("material-extensions",
              [](json& j) {
                j["materials"][0]["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 1.0;
              },
              {"KHR_materials_transmission"});
  expect_note("materials",
              [](json& j) {
                json second = mesh_of(j, "table")["primitives"][0];
                second["material"] = 0;
                mesh_of(j, "table")["primitives"].push_back(second);
              },
              {"several materials"});
  expect_note("other-scenes",
              [](json& j) {
                j["scenes"].push_back({{"name", "Draft"}, {"nodes", json::array()}});
              },
              {"2 scenes", "alone is read"});
}

TEST(Ledger, WhatComesOftenIsCounted) {
  const Inspection found = test::inspect_foreign([](json& j) {
    for (int i = 0; i < 100; ++i) {
      json copy = node_named(j, "table");
      copy["name"] = "plank " + std::to_string(i);
      copy["extensions"]["KHR_node_visibility"]["visible"] = false;
      j["nodes"].push_back(copy);
      j["scenes"][0]["nodes"].push_back(j["nodes"].size() - 1);
    }
  });
  ASSERT_TRUE(found.scene);
  EXPECT_LT(found.warnings.size(), 20u);
  EXPECT_NE(test::all_text(found.warnings).find("(as 92 more)"), std::string::npos)
      << test::all_text(found.warnings);
}

}  // namespace
}  // namespace slosh
