// Where a scene may be, and how much work a file may make.
#include "net/wire/limits.h"

#include "foreign_kit.h"
#include "sim/math/limits.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::inspect_foreign;
using test::mesh_of;
using test::node_named;

/// Everything somewhere else.
test::Edit moved(double x) {
  return [x](json& j) {
    json root{{"name", "moved"}, {"translation", {x, 0, 0}}, {"children", j["scenes"][0]["nodes"]}};
    j["nodes"].push_back(root);
    j["scenes"][0]["nodes"] = {j["nodes"].size() - 1};
  };
}

TEST(Limits, ASceneFarFromItsOriginIsRefusedWithItsPlace) {
  const Inspection far = inspect_foreign(moved(1000.1));
  ASSERT_FALSE(far.scene);
  const std::string all = test::all_text(far.errors);
  for (const char* word : {"'cup'", "'water'", "1000 m from the scene's origin", "Move everything near"})
    EXPECT_NE(all.find(word), std::string::npos) << word << " in " << all;
}

TEST(Limits, AtTheLimitHandsActAndMessagesHoldThem) {
  const Inspection near = inspect_foreign(moved(kFarthestPlace - 1.0));
  ASSERT_TRUE(near.scene) << test::all_text(near.errors);
  const Scene& scene = *near.scene;
  const glm::dvec3 farthest =
      glm::max(glm::abs(lowest_handle(scene.domain_min)), glm::abs(highest_handle(scene.domain_max)));
  EXPECT_LT(glm::length(farthest), kFarthestHandle) << "wherever the host lets a hand be, the world takes it";
  EXPECT_LT(std::max({farthest.x, farthest.y, farthest.z}), wire::kMaxPosition);
  EXPECT_TRUE(test::kinds_of(near).contains("far-away")) << "and it is told that particles are coarse there";
  EXPECT_FALSE(test::kinds_of(inspect_foreign(moved(10.0))).contains("far-away"));
}

TEST(Limits, ADomainMayBeLargerThanWhatHandsReach) {
  const Inspection found = inspect_foreign([](json& j) {
    j["scenes"][0]["extras"]["domain_min_m"] = {-1e6, -1e6, -1e6};
    j["scenes"][0]["extras"]["domain_max_m"] = {1e6, 1e6, 1e6};
  });
  ASSERT_TRUE(found.scene) << test::all_text(found.errors);
  EXPECT_LT(glm::length(highest_handle(found.scene->domain_max)), kFarthestHandle);
  EXPECT_LT(glm::length(lowest_handle(found.scene->domain_min)), kFarthestHandle);
}

TEST(Limits, AHandThatGoesOutOfReachOrTooFastIsTold) {
  const auto with_hand = [](double speed) {
    const test::TempFolder folder;
    const json title{{"title", "reach"}, {"duration_s", 2.0}};
    make::SceneWriter writer(title);
    const int paint = writer.add_material("paint", {});
    const int cup =
        writer.add_node("cup", writer.add_mesh("m", make::box({-0.05, 0, -0.05}, {0.05, 0.1, 0.05}), paint),
                        {}, {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.5}});
    writer.add_node("handle", -1, {{0.0, 0.1, 0.0}, {1.0, 0.0, 0.0, 0.0}}, {{"slosh", "grip"}}, cup);
    writer.add_hand(
        "hand", "handle",
        [=](double t) {
          return Pose{{speed * t, 0.1, 0.0}, {1.0, 0.0, 0.0, 0.0}};
        },
        2.0);
    EXPECT_TRUE(writer.write(folder / "reach.gltf"));
    return test::kinds_of(inspect_scene(folder / "reach.gltf"));
  };
  EXPECT_FALSE(with_hand(1.0).contains("hand-out-of-reach"));
  EXPECT_TRUE(with_hand(3.0).contains("hand-out-of-reach"));
  EXPECT_FALSE(with_hand(3.0).contains("hand-too-fast"));
  EXPECT_TRUE(with_hand(30.0).contains("hand-too-fast"));
}

TEST(Limits, AChainOfNodesEndsSomewhere) {
  const auto chain = [](std::size_t length) {
    return [length](json& j) {
      const std::size_t first = j["nodes"].size();
      for (std::size_t i = 0; i < length; ++i) {
        json link{{"name", "link " + std::to_string(i)}, {"extras", {{"slosh", "gauge"}}}};
        if (i + 1 < length) link["children"] = {first + i + 1};
        j["nodes"].push_back(std::move(link));
      }
      j["scenes"][0]["nodes"].push_back(first);
    };
  };
  const Inspection deep = inspect_foreign(chain(100'000));
  ASSERT_FALSE(deep.scene);
  ASSERT_EQ(deep.errors.size(), 1u);
  EXPECT_NE(deep.errors[0].text.text().find("more than 1000 nodes"), std::string::npos)
      << deep.errors[0].text.text();
  EXPECT_TRUE(inspect_foreign(chain(900)).scene);
}

/// So many meshes that all read the cup's accessors: a small file, and as much work as one likes.
test::Edit shared(std::size_t meshes, const char* kind) {
  return [=](json& j) {
    const json source = mesh_of(j, "table");
    for (std::size_t i = 0; i < meshes; ++i) {
      j["meshes"].push_back(source);
      json node{{"name", "copy " + std::to_string(i)}, {"mesh", j["meshes"].size() - 1}};
      if (*kind) node["extras"] = {{"slosh", kind}};
      j["nodes"].push_back(node);
      j["scenes"][0]["nodes"].push_back(j["nodes"].size() - 1);
    }
  };
}

TEST(Limits, WorkIsCountedAsOftenAsItIsAskedFor) {
  const Inspection bodies = inspect_foreign(shared(80'000, "body"));
  ASSERT_FALSE(bodies.scene);
  EXPECT_NE(test::all_text(bodies.errors).find("more than 10000 bodies"), std::string::npos)
      << test::all_text(bodies.errors).substr(0, 500);
  const Inspection pictures = inspect_foreign(shared(80'000, ""));
  ASSERT_TRUE(pictures.scene) << "what decorates never stops the physics";
  EXPECT_LE(pictures.scene->pictures.size(), 4096u);
  EXPECT_TRUE(test::kinds_of(pictures).contains("picture"));
  EXPECT_LT(pictures.warnings.size(), 20u);
}

TEST(Limits, ManyMeshesOfOneLargeAccessorAreRefusedBeforeTheyAreRead) {
  const test::TempFolder folder;
  make::SceneWriter writer = test::make_cup();
  const int paint = writer.add_material("paint", {});
  writer.add_node(
      "ball",
      writer.add_mesh("ball", make::transformed(make::sphere(0.05, 100, 200), glm::dmat4(1.0)), paint),
      {{0.5, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}, {{"slosh", "body"}});
  ASSERT_TRUE(writer.write(folder / "many.gltf"));
  json j = test::read_json(folder / "many.gltf");
  // One triangle of each, so that triangles alone would be few.
  json source = mesh_of(j, "ball");
  j["accessors"].push_back(j["accessors"][source["primitives"][0]["indices"].get<std::size_t>()]);
  j["accessors"].back()["count"] = 3;
  source["primitives"][0]["indices"] = j["accessors"].size() - 1;
  for (int i = 0; i < 5000; ++i) {
    j["meshes"].push_back(source);
    j["nodes"].push_back({{"name", "chip " + std::to_string(i)}, {"mesh", j["meshes"].size() - 1}});
    j["scenes"][0]["nodes"].push_back(j["nodes"].size() - 1);
  }
  test::write_text(folder / "many.gltf", j.dump());
  const Inspection found = inspect_scene(folder / "many.gltf");
  ASSERT_TRUE(found.scene) << test::all_text(found.errors).substr(0, 2000);
  EXPECT_LT(found.scene->pictures.size(), 1000u);
  EXPECT_NE(test::all_text(found.warnings).find("12 million vertices and indices"), std::string::npos)
      << test::all_text(found.warnings).substr(0, 2000);
}

TEST(Limits, AThousandMistakesAreNotAThousandErrors) {
  const Inspection found = inspect_foreign([](json& j) {
    for (int i = 0; i < 1000; ++i) {
      json node = node_named(j, "water");
      node["name"] = "drop " + std::to_string(i);
      node["extras"]["viscosity_pa_s"] = -1;
      j["nodes"].push_back(node);
      j["scenes"][0]["nodes"].push_back(j["nodes"].size() - 1);
    }
  });
  EXPECT_LE(found.errors.size(), 101u);
  EXPECT_NE(found.errors.back().text.text().find("more"), std::string::npos)
      << found.errors.back().text.text();
}

}  // namespace
}  // namespace slosh
