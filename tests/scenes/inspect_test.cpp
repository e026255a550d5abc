// What exports from Blender are known to lose, as it shows in glTF. (tests/blender has the same by Blender
// itself.)
#include "scenes/inspect.h"

#include <algorithm>
#include <set>

#include "scenes/sample.h"
#include "support.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::node_named;

/// The cup with a camera, after an edit of its JSON.
Inspection inspect_edited(const test::Edit& edit) {
  const test::TempFolder folder;
  make::SceneWriter writer = test::make_cup();
  writer.add_camera({0.3, 0.4, 0.5}, {0.0, 0.05, 0.0}, 40.0);
  EXPECT_TRUE(writer.write(folder / "cup.gltf"));
  json file = test::read_json(folder / "cup.gltf");
  edit(file);
  test::write_text(folder / "cup.gltf", file.dump());
  return inspect_scene(folder / "cup.gltf");
}

std::set<std::string> kinds(const Inspection& found) {
  std::set<std::string> all;
  for (const Finding& f : found.errors) all.insert(f.kind);
  for (const Finding& f : found.warnings) all.insert(f.kind);
  return all;
}

/// Expects that kind of warning and no other, with words in it.
void expect_warning(const char* kind, const test::Edit& edit, std::initializer_list<const char*> words) {
  SCOPED_TRACE(kind);
  const Inspection found = inspect_edited(edit);
  ASSERT_EQ(kinds(found), std::set<std::string>{kind});
  EXPECT_TRUE(found.scene) << "it plays";
  const Error& text = found.warnings[0].text;
  for (const char* word : words)
    EXPECT_NE(text.text().find(word), std::string::npos) << "no '" << word << "' in: " << text.text();
  EXPECT_FALSE(text.mend.empty());
}

/// The quarter turn that the exporter makes with +Y Up, undone: what lies in a file that was exported
/// without.
void undo_y_up(json& file) {
  json root{{"name", "unturned"}, {"rotation", {0.7071067811865476, 0.0, 0.0, 0.7071067811865476}}};
  root["children"] = file["scenes"][0]["nodes"];
  file["nodes"].push_back(root);
  file["scenes"][0]["nodes"] = {file["nodes"].size() - 1};
}

TEST(Inspect, FindsNothingInASoundSceneNorInTheShippedOnes) {
  const Inspection cup = inspect_edited([](json&) {});
  EXPECT_TRUE(kinds(cup).empty()) << cup.warnings.front().text.text();
  for (const SceneEntry& entry : shipped_scenes()) {
    const Inspection found = inspect_scene(entry.file);
    EXPECT_TRUE(kinds(found).empty()) << entry.name << ": " << *kinds(found).begin();
    EXPECT_TRUE(found.scene);
  }
}

TEST(Inspect, ACameraThatWasNotExported) {
  expect_warning("no-camera",
                 [](json& j) {
                   j.erase("cameras");
                   for (json& n : j["nodes"]) n.erase("camera");
                 },
                 {"Include > Cameras"});
}

TEST(Inspect, ASceneOnItsSide) {
  expect_warning("on-its-side", undo_y_up, {"+Y Up"});
}

TEST(Inspect, AVesselOnItsSideWithoutACamera) {
  const Inspection found = inspect_edited([](json& j) {
    j.erase("cameras");
    for (json& n : j["nodes"]) n.erase("camera");
    undo_y_up(j);
  });
  EXPECT_EQ(kinds(found), (std::set<std::string>{"no-camera", "on-its-side"}));
}

TEST(Inspect, GravityThatIsGivenZUp) {
  expect_warning("gravity-not-down",
                 [](json& j) {
                   j["scenes"][0]["extras"]["gravity_m_s2"] = {0.0, 0.0, -9.81};
                 },
                 {"y is up", "(0, -9.81, 0)"});
  for (const json& fine : {json{0.0, 0.0, 0.0}, json{1.0, -9.0, 1.0}}) {
    EXPECT_TRUE(
        kinds(inspect_edited([&](json& j) { j["scenes"][0]["extras"]["gravity_m_s2"] = fine; })).empty());
  }
}

TEST(Inspect, AnAnimationThatWasNotExported) {
  expect_warning("no-animation", [](json& j) { j.erase("animations"); }, {"hand", "1 key", "Animation on"});
}

TEST(Inspect, KeysAt24Hz) {
  const test::TempFolder folder;
  make::SceneWriter writer(json{{"title", "a cup"}});
  const int paint = writer.add_material("paint", {});
  const int cup = writer.add_node("cup", writer.add_mesh("m", make::tank({0.1, 0.1, 0.1}, 0.02), paint), {},
                                  {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.5}});
  writer.add_node("handle", -1, {}, {{"slosh", "grip"}}, cup);
  writer.add_hand(
      "hand", "handle",
      [](double t) {
        return Pose{{0.01 * t, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}};
      },
      2.0, 24.0);
  writer.add_camera({0.3, 0.4, 0.5}, {0.0, 0.05, 0.0}, 40.0);
  ASSERT_TRUE(writer.write(folder / "cup.gltf"));
  const Inspection found = inspect_scene(folder / "cup.gltf");
  ASSERT_EQ(kinds(found), std::set<std::string>{"coarse-keys"});
  EXPECT_NE(found.warnings[0].text.what.find("24 keys a second"), std::string::npos)
      << found.warnings[0].text.what;
}

TEST(Inspect, ASceneTenTimesTooLargeOrTooSmall) {
  const auto scaled = [](double by) {
    return [by](json& j) {
      for (const char* name : {"cup", "water"}) node_named(j, name)["scale"] = {by, by, by};
      j.erase("animations");
      for (json& n : j["nodes"])
        if (n.value("name", "") == "hand") n["translation"] = {0.0, 0.1 * by, 0.0};
    };
  };
  const Inspection large = inspect_edited(scaled(20.0));
  EXPECT_TRUE(kinds(large).contains("large"));
  const Inspection small = inspect_edited(scaled(0.1));
  EXPECT_TRUE(kinds(small).contains("small"));
}

TEST(Inspect, AFieldWithACapital) {
  expect_warning("capital",
                 [](json& j) {
                   json& extras = node_named(j, "water")["extras"];
                   extras["Slosh"] = extras["slosh"];
                   extras.erase("slosh");
                 },
                 {"water", "'Slosh'", "'slosh'"});
}

TEST(Inspect, PropertiesOnTheMeshData) {
  expect_warning("on-mesh-data",
                 [](json& j) {
                   json& water = node_named(j, "water");
                   j["meshes"][water["mesh"].get<std::size_t>()]["extras"] = water["extras"];
                   water.erase("extras");
                 },
                 {"water", "Object Properties"});
}

TEST(Inspect, ACoarseMeshThatIsShadedRound) {
  // Every corner's normal away from the middle: smooth shading of a block.
  const auto round = [](json& j) {
    const json& mesh = j["meshes"][node_named(j, "water")["mesh"].get<std::size_t>()];
    json& primitive = const_cast<json&>(mesh)["primitives"][0];
    primitive["attributes"]["NORMAL"] = primitive["attributes"]["POSITION"];
  };
  expect_warning("coarse-and-smooth", round, {"water", "Apply Modifiers"});
}

TEST(Inspect, SaysEverythingThatIsWrongOnceAndNotWhatFollows) {
  const Inspection found = inspect_edited([](json& j) {
    node_named(j, "cup")["extras"]["mass_kg"] = -1.0;  // so its handle and the hand cannot be read either
    node_named(j, "water")["extras"]["viscosity_pa_s"] = "thick";
    j["scenes"][0]["extras"]["gravity_m_s2"] = "down";
    j["scenes"][0]["extras"]["Spacing"] = 1;
  });
  EXPECT_FALSE(found.scene);
  ASSERT_EQ(found.errors.size(), 3u);
  std::string all;
  for (const Finding& f : found.errors) all += f.text.text() + "\n";
  for (const char* word : {"mass_kg", "viscosity_pa_s", "gravity_m_s2"})
    EXPECT_NE(all.find(word), std::string::npos) << all;
  EXPECT_EQ(all.find("handle"), std::string::npos) << "the grip is not to blame: " << all;
}

TEST(Inspect, AHoleIsPlacedInBlendersWorld) {
  const Inspection found = inspect_edited([](json& j) {
    node_named(j, "cup")["translation"] = {1.0, 2.0, 3.0};
    json& mesh = j["meshes"][node_named(j, "cup")["mesh"].get<std::size_t>()];
    json& indices = j["accessors"][mesh["primitives"][0]["indices"].get<std::size_t>()];
    indices["count"] = indices["count"].get<int>() - 3;  // the last triangle is gone
  });
  ASSERT_FALSE(found.errors.empty());
  const std::string what = found.errors[0].text.what;
  double x = 0.0, y = 0.0, z = 0.0;
  ASSERT_EQ(std::sscanf(what.c_str() + what.find("first at (") + 10, "%lf, %lf, %lf", &x, &y, &z), 3) << what;
  EXPECT_NEAR(x, 1.0, 0.1) << what;
  EXPECT_NEAR(y, -3.0, 0.1) << "Blender's y is minus our z";
  EXPECT_NEAR(z, 2.05, 0.1) << "and its z our y";
  EXPECT_NE(found.errors[0].text.mend.find("Solidify"), std::string::npos);
}

TEST(Inspect, ACoarsestSpacingThatIsNotGivenFitsTheWalls) {
  const test::TempFolder folder;
  const make::Solid thin = make::tank({0.1, 0.1, 0.1}, 0.01);
  const make::Solid water = make::box({-0.05, 0.01, -0.05}, {0.05, 0.09, 0.05});
  ASSERT_TRUE(test::make_cup({{"title", "thin"}}, &thin, &water).write(folder / "thin.gltf"));
  const Inspection found = inspect_scene(folder / "thin.gltf");
  ASSERT_TRUE(found.scene);
  EXPECT_NEAR(found.scene->spacing_max, 0.0098, 1e-4);
  EXPECT_TRUE(sample_scene(*found.scene, found.scene->spacing_max)) << "and is one that sampling takes";
  ASSERT_TRUE(test::make_cup({{"title", "thin"}, {"spacing_max_m", 0.02}}, &thin, &water)
                  .write(folder / "given.gltf"));
  EXPECT_EQ(inspect_scene(folder / "given.gltf").scene->spacing_max, 0.02) << "what is given is kept";
}

TEST(Inspect, EverythingThatIsWrongWithOneObjectIsSaid) {
  const Inspection found = inspect_edited([](json& j) {
    // The cup: three fields, a word that is misspelt, and a mesh that is open.
    json& cup = node_named(j, "cup");
    cup["extras"] = {
        {"slosh", "body"}, {"motion", "loose"}, {"friction", -1}, {"mass_kg", 0.2}, {"restituton", 0.5}};
    json& accessor =
        j["accessors"][j["meshes"][cup["mesh"].get<int>()]["primitives"][0]["indices"].get<int>()];
    accessor["count"] = accessor["count"].get<int>() - 3;
    // The fluid and the scene: two each.
    node_named(j, "water")["extras"]["density_kg_m3"] = 0;
    node_named(j, "water")["extras"]["viscosity_pa_s"] = -1;
    j["scenes"][0]["extras"]["duration_s"] = -1;
    j["scenes"][0]["extras"]["support_ratio"] = 9;
  });
  std::string all;
  for (const Finding& f : found.errors) all += f.text.text() + "\n";
  for (const char* words :
       {"'cup'", "extras.motion: is \"loose\"", "extras.friction: is -1",
        "extras.restituton: is not a property", "Did you mean restitution?", "extras.density_kg_m3: is 0",
        "extras.viscosity_pa_s: is -1", "extras.duration_s: is -1", "extras.support_ratio: is 9"})
    EXPECT_NE(all.find(words), std::string::npos) << "no " << words << " in\n" << all;
  EXPECT_EQ(found.errors.size(), 8u) << "and the open mesh, but not what hangs on the cup:\n" << all;
  EXPECT_FALSE(found.scene);
}

TEST(Inspect, AFileThatIsNoneIsOneError) {
  EXPECT_EQ(inspect_scene("/nowhere/cup.gltf").errors.size(), 1u);
}

}  // namespace
}  // namespace slosh
