// Bodies that may be cut, and blades, as a scene file has them.
#include "support.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::node_named;

/// A block of butter that may become three, and a knife.
Result<Scene> load_butter(const test::Edit& edit, const make::Solid* butter = nullptr) {
  make::SceneWriter writer(json{{"title", "butter"}});
  const int paint = writer.add_material("paint", {});
  const make::Solid block = butter ? *butter : make::box({-0.05, -0.03, -0.1}, {0.05, 0.03, 0.1});
  writer.add_node(
      "butter", writer.add_mesh("block", block, paint), {{0.0, 0.1, 0.0}, {1, 0, 0, 0}},
      {{"slosh", "body"}, {"motion", "free"}, {"density_kg_m3", 900}, {"pieces", 3}, {"cut_n_m", 80}});
  writer.add_node("knife", writer.add_mesh("blade", make::box({-0.1, 0, -0.01}, {0.1, 0.05, 0.01}), paint),
                  {{0.0, 0.3, 0.0}, {1, 0, 0, 0}},
                  {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.2}, {"blade", true}});
  const test::TempFolder folder;
  EXPECT_TRUE(writer.write(folder / "butter.gltf"));
  json root = test::read_json(folder / "butter.gltf");
  edit(root);
  test::write_text(folder / "butter.gltf", root.dump());
  return load_scene(folder / "butter.gltf");
}

void expect_butter_error(const char* node, const json& fields, std::initializer_list<const char*> words) {
  test::expect_error(load_butter([&](json& j) { node_named(j, node)["extras"].update(fields); }), words);
}

TEST(Pieces, AreBodiesThatStartAway) {
  const auto scene = load_butter([](json&) {});
  ASSERT_TRUE(scene) << scene.error().text();
  const std::vector<Body>& bodies = scene.value().bodies;
  ASSERT_EQ(bodies.size(), 4u);
  EXPECT_EQ(bodies[0].pieces, 3);
  EXPECT_EQ(bodies[0].cut_n_m, 80.0);
  EXPECT_EQ(bodies[0].piece_of, -1);
  EXPECT_FALSE(bodies[0].starts_away);
  for (const std::size_t piece : {1u, 2u}) {
    EXPECT_EQ(bodies[piece].name, "butter~" + std::to_string(piece + 1));
    EXPECT_EQ(bodies[piece].piece_of, 0);
    EXPECT_EQ(bodies[piece].mesh, bodies[0].mesh);
    EXPECT_TRUE(bodies[piece].starts_away);
    EXPECT_TRUE(is_cut(bodies[piece]));
  }
  EXPECT_TRUE(bodies[3].blade);
  EXPECT_FALSE(is_cut(bodies[3]));
}

TEST(Pieces, SayWhatIsWrong) {
  expect_butter_error("butter", {{"pieces", 1}}, {"'butter'", "pieces", "2 to 16"});
  expect_butter_error("butter", {{"pieces", 2.5}}, {"'butter'", "pieces", "whole number"});
  expect_butter_error("butter", {{"motion", "fixed"}}, {"'butter'", "pieces", "not free"});
  expect_butter_error("butter", {{"center_of_mass_m", {0, 0, 0}}},
                      {"'butter'", "center_of_mass_m", "density"});
  expect_butter_error("butter", {{"cut_n_m", -1}}, {"'butter'", "cut_n_m", "-1"});
  expect_butter_error("knife", {{"cut_n_m", 10}}, {"'knife'", "cut_n_m", "cannot be cut"});
  expect_butter_error("knife", {{"motion", "fixed"}}, {"'knife'", "blade", "fixed"});
  const make::Solid hollow = make::tank({0.1, 0.1, 0.1}, 0.02);
  test::expect_error(load_butter([](json&) {}, &hollow), {"'butter'", "not convex", "Convex Hull"});
}

}  // namespace
}  // namespace slosh
