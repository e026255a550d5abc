// What only decorates never stops the physics, and what is somebody else's is left alone.
#include "foreign_kit.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::expect_note;
using test::inspect_foreign;
using test::mesh_of;
using test::node_named;

/// The cup and its water are there whatever became of the table.
void expect_the_cup(const Scene& scene, std::size_t pictures) {
  EXPECT_EQ(scene.bodies.size(), 1u);
  EXPECT_EQ(scene.fluid_volumes.size(), 1u);
  EXPECT_EQ(scene.pictures.size(), pictures);
}

TEST(Roles, TheTableIsShown) {
  const Inspection found = inspect_foreign([](json&) {});
  ASSERT_TRUE(found.scene);
  EXPECT_TRUE(test::kinds_of(found).empty()) << test::all_text(found.warnings);
  expect_the_cup(*found.scene, 1);
}

TEST(Roles, LooseEdgesOfAPictureAreNotShown) {
  for (const int mode : {0, 1, 2, 3}) {
    // Beside its faces, and alone.
    const auto beside = [mode](json& j) {
      json loose = mesh_of(j, "table")["primitives"][0];
      loose["mode"] = mode;
      mesh_of(j, "table")["primitives"].push_back(loose);
    };
    expect_the_cup(expect_note("picture-part", beside, {"table_mesh", "1 of its 2 parts", "Loose"}), 1);
    const auto alone = [mode](json& j) { mesh_of(j, "table")["primitives"][0]["mode"] = mode; };
    expect_the_cup(expect_note("picture-part", alone, {"table_mesh", "1 of its 1 parts"}), 0);
  }
  const Inspection body = inspect_foreign([](json& j) { mesh_of(j, "cup")["primitives"][0]["mode"] = 1; });
  EXPECT_FALSE(body.scene) << "of a body they are an error";
}

TEST(Roles, APictureWithoutItsDataIsNotShown) {
  expect_the_cup(
      expect_note("picture-part",
                  [](json& j) { mesh_of(j, "table")["primitives"][0]["attributes"]["POSITION"] = 999; },
                  {"table_mesh"}),
      0);
  expect_the_cup(
      expect_note("picture",
                  [](json& j) { test::accessor_of(j, "table", "POSITION")["count"] = 3'000'000'000u; },
                  {"'table'", "not shown"}),
      0);
  expect_the_cup(expect_note("picture",
                             [](json& j) {
                               node_named(j, "table")["scale"] = {0, 1, 1};
                             },
                             {"'table'", "scale", "not shown"}),
                 0);
  expect_the_cup(expect_note("picture",
                             [](json& j) {
                               node_named(j, "table")["translation"] = {0, 0, 2e4};
                             },
                             {"'table'", "10 km"}),
                 0);
}

TEST(Roles, ACompressedPictureIsNotShown) {
  expect_the_cup(
      expect_note("picture-part",
                  [](json& j) {
                    j["extensionsUsed"] = j["extensionsRequired"] = {"KHR_draco_mesh_compression"};
                    mesh_of(j, "table")["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
                        {"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
                  },
                  {"table_mesh", "compress"}),
      0);
  const Inspection body = inspect_foreign([](json& j) {
    j["extensionsUsed"] = j["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    mesh_of(j, "cup")["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
  });
  EXPECT_FALSE(body.scene);
}

TEST(Roles, AttributesThatNobodyReadsAreNobodysErrors) {
  for (const char* node : {"table", "cup", "water"}) {
    for (const char* attribute : {"COLOR_0", "TANGENT", "JOINTS_0", "WEIGHTS_0", "_MINE"}) {
      const Inspection found = inspect_foreign([&](json& j) {
        // Empty, as exporters write a layer that nothing was painted on.
        j["accessors"].push_back({{"componentType", 5126}, {"count", 8}, {"type", "VEC4"}});
        mesh_of(j, node)["primitives"][0]["attributes"][attribute] = j["accessors"].size() - 1;
      });
      EXPECT_TRUE(found.scene) << node << " " << attribute << "\n" << test::all_text(found.errors);
    }
  }
}

TEST(Roles, ACameraThatCannotBeUsedIsReplaced) {
  const auto orthographic = [](json& j) {
    j["cameras"][0] = {{"type", "orthographic"},
                       {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 10}, {"znear", 0.1}}}};
  };
  expect_the_cup(expect_note("camera", orthographic, {"orthographic", "view is chosen"}), 1);
  expect_the_cup(expect_note("camera", [](json& j) { j["cameras"][0]["perspective"]["yfov"] = 3.1; },
                             {"yfov", "degrees"}),
                 1);
}

TEST(Roles, AnAnimationOfSomethingElseThatLeadsNowhereIsLeftOut) {
  const auto broken = [](json& j) {
    const auto table = static_cast<std::size_t>(&node_named(j, "table") - &j["nodes"][0]);
    j["animations"].push_back(
        {{"name", "door"},
         {"samplers", {{{"input", 999}, {"output", 999}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", table}, {"path", "rotation"}}}}}}});
  };
  const Scene scene = expect_note("animation", broken, {"'door'", "leads nowhere"});
  expect_the_cup(scene, 1);
  EXPECT_GT(scene.grips[0].hand_motion.size(), 1u) << "the hand's own is still there";
  const Inspection of_the_hand =
      inspect_foreign([](json& j) { j["animations"][0]["samplers"][0]["input"] = 999; });
  EXPECT_FALSE(of_the_hand.scene) << "of a hand it is an error";
}

TEST(Roles, StrangersPropertiesAreToldAndLeftAlone) {
  for (const char* node : {"cup", "water", "handle", "hand"}) {
    for (const char* key :
         {"material_id", "ifcGlobalId", "export_tag", "lod", "uuid", "cycles_visibility", "blenderkit"}) {
      expect_note("foreign-property", [&](json& j) { node_named(j, node)["extras"][key] = 7; },
                  {node, key, "not read"});
    }
  }
  expect_note("foreign-property", [](json& j) { j["scenes"][0]["extras"]["author"] = "me"; },
              {"scene", "author"});
}

TEST(Roles, WhatLooksLikeAMisspeltFieldStaysAnError) {
  for (const auto& [node, key] : {std::pair{"cup", "mass"},
                                  {"cup", "mass_g"},
                                  {"cup", "masss_kg"},
                                  {"cup", "massKg"},
                                  {"cup", "Density"},
                                  {"cup", "density_g_cm3"},
                                  {"water", "viscosity"},
                                  {"water", "viscosity_mpas"},
                                  {"water", "viscosity_cp"},
                                  {"handle", "stiffness"},
                                  {"cup", "restituton"},
                                  {"hand", "girp"}}) {
    const Inspection found = inspect_foreign([&](json& j) { node_named(j, node)["extras"][key] = 7; });
    if (std::string(key) == "Density") {
      EXPECT_TRUE(found.scene) << "capitals are nobody's";
      continue;
    }
    ASSERT_FALSE(found.scene) << key;
    EXPECT_NE(found.errors[0].text.text().find("Did you mean"), std::string::npos)
        << found.errors[0].text.text();
  }
}

}  // namespace
}  // namespace slosh
