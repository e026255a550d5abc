// Meshes that bound no volume, and accessors that lie.
#include "scenes/make/solid.h"
#include "support.h"

namespace slosh {
namespace {

using make::Solid;
using nlohmann::json;
using test::expect_edit_error;

void expect_cup_error(const Solid& cup, std::initializer_list<const char*> words) {
  const test::TempFolder folder;
  ASSERT_TRUE(test::make_cup({{"title", "x"}}, &cup).write(folder / "cup.gltf"));
  test::expect_error(load_scene(folder / "cup.gltf"), words);
}

Solid turned_inside_out(Solid solid) {
  for (glm::uvec3& t : solid.triangles) std::swap(t.y, t.z);
  return solid;
}

TEST(MeshErrors, Open) {
  Solid cup = make::tank({0.1, 0.1, 0.1}, 0.02);
  cup.triangles.pop_back();
  expect_cup_error(
      cup, {"cup.gltf", "'cup'", "cup_mesh", "not closed", "3 boundary edges", " m", "Fill Holes", "Merge"});
}

TEST(MeshErrors, FluidToo) {
  Solid water = make::box({-0.05, 0.02, -0.05}, {0.05, 0.09, 0.05});
  water.triangles.resize(10);
  const test::TempFolder folder;
  ASSERT_TRUE(test::make_cup({{"title", "x"}}, nullptr, &water).write(folder / "cup.gltf"));
  test::expect_error(load_scene(folder / "cup.gltf"), {"'water'", "water_mesh", "4 boundary edges"});
}

TEST(MeshErrors, NonManifold) {
  Solid cup = make::tank({0.1, 0.1, 0.1}, 0.02);
  cup.points.emplace_back(1.0, 1.0, 1.0);
  cup.triangles.emplace_back(0u, 1u, static_cast<unsigned>(cup.points.size()) - 1);
  expect_cup_error(cup, {"'cup'", "1 edges with more than two faces"});
}

TEST(MeshErrors, Inward) {
  expect_cup_error(turned_inside_out(make::tank({0.1, 0.1, 0.1}, 0.02)),
                   {"'cup'", "inward", "Recalculate Outside"});
}

TEST(MeshErrors, OnePartInward) {
  const Solid cup = make::merged(make::tank({0.1, 0.1, 0.1}, 0.02),
                                 turned_inside_out(make::box({0.3, 0, 0}, {0.32, 0.02, 0.02})));
  expect_cup_error(cup, {"'cup'", "part at (0.3", "inward", "Recalculate Outside"});
}

TEST(MeshErrors, CavityIsNone) {
  const Solid cup = make::merged(make::box({-0.1, -0.3, -0.1}, {0.1, -0.1, 0.1}),
                                 turned_inside_out(make::box({-0.05, -0.25, -0.05}, {0.05, -0.15, 0.05})));
  const test::TempFolder folder;
  ASSERT_TRUE(test::make_cup({{"title", "x"}}, &cup).write(folder / "cup.gltf"));
  const auto scene = load_scene(folder / "cup.gltf");
  EXPECT_TRUE(scene) << scene.error().text();
}

TEST(MeshErrors, Flat) {
  Solid cup = make::box({0, 0, 0}, {0.1, 0.1, 0.1});
  for (std::size_t i = 0; i < cup.points.size(); ++i) cup.points[i].y = i & 2 ? 1e-12 : 0.0;
  expect_cup_error(cup, {"'cup'"});
}

/// The accessor that a mesh's attribute names.
json& accessor_of(json& j, const char* attribute) {
  json& primitive = j["meshes"][0]["primitives"][0];
  const json& index =
      std::string(attribute) == "indices" ? primitive["indices"] : primitive["attributes"][attribute];
  return j["accessors"][index.get<std::size_t>()];
}

TEST(AccessorErrors, MissingBufferViewWithHugeCount) {
  expect_edit_error(
      [](json& j) {
        accessor_of(j, "POSITION")["bufferView"] = 999;
        accessor_of(j, "POSITION")["count"] = 3000000000u;
      },
      {"cup.gltf", "bufferView", "999"});
  expect_edit_error([](json& j) { accessor_of(j, "POSITION").erase("bufferView"); },
                    {"cup_mesh", "POSITION", "no bufferView"});
}

TEST(AccessorErrors, ABufferThatIsShorterThanItSaysIsNotPrinted) {
  const auto loaded = test::load_edited([](json& j) { j["buffers"][0]["byteLength"] = 1000000; });
  ASSERT_FALSE(loaded);
  const std::string text = loaded.error().text();
  EXPECT_NE(text.find("decode"), std::string::npos) << text;
  EXPECT_LT(text.size(), 250u) << text;
  EXPECT_EQ(text.find(".."), std::string::npos) << text;
}

TEST(AccessorErrors, PastItsBuffer) {
  for (const char* attribute : {"POSITION", "NORMAL", "indices"}) {
    SCOPED_TRACE(attribute);
    for (const std::uint64_t count :
         {std::uint64_t{3000000000}, std::uint64_t{1} << 40, std::uint64_t{1} << 62}) {
      expect_edit_error([&](json& j) { accessor_of(j, attribute)["count"] = count; },
                        {"cup.gltf", attribute});
    }
    expect_edit_error([&](json& j) { accessor_of(j, attribute)["byteOffset"] = 1u << 30; },
                      {"cup.gltf", attribute});
    expect_edit_error([&](json& j) { accessor_of(j, attribute)["count"] = 0; }, {"cup.gltf"});
  }
  expect_edit_error([](json& j) { j["bufferViews"][0]["byteOffset"] = 1u << 30; }, {"cup.gltf", "buffer"});
  expect_edit_error([](json& j) { j["bufferViews"][0]["byteLength"] = 1u << 30; }, {"cup.gltf", "buffer"});
  expect_edit_error([](json& j) { j["bufferViews"][0]["byteLength"] = 12; },
                    {"'cup'", "POSITION", "12 bytes"});
}

TEST(AccessorErrors, WrongKinds) {
  expect_edit_error([](json& j) { accessor_of(j, "POSITION")["componentType"] = 5123; },
                    {"POSITION", "floats"});
  expect_edit_error([](json& j) { accessor_of(j, "POSITION")["type"] = "SCALAR"; },
                    {"POSITION", "3 are needed"});
  expect_edit_error([](json& j) { accessor_of(j, "indices")["componentType"] = 5126; },
                    {"indices", "unsigned integers"});
  expect_edit_error([](json& j) { accessor_of(j, "indices")["type"] = "VEC3"; }, {"indices", "1 are needed"});
  expect_edit_error([](json& j) { accessor_of(j, "POSITION")["sparse"] = {{"count", 1}}; }, {"sparse"});
  const auto sparse = [](std::int64_t count, std::int64_t view, int type) {
    return [=](json& j) {
      accessor_of(j, "POSITION")["sparse"] = {{"count", count},
                                              {"indices", {{"bufferView", view}, {"componentType", type}}},
                                              {"values", {{"bufferView", view}, {"byteOffset", 4}}}};
    };
  };
  for (const auto& edit :
       {sparse(1, 99, 5123), sparse(-1, 0, 5123), sparse(0, 0, 5123), sparse(1'000'000'000, 0, 5123),
        sparse(1, -1, 5123), sparse(1, 0, 7), sparse(3, 0, 5126), sparse(4, 0, 5125)})
    expect_edit_error(edit, {"POSITION", "sparse"});
  expect_edit_error(
      [](json& j) {
        accessor_of(j, "indices")["sparse"] = {{"count", 1},
                                               {"indices", {{"bufferView", 0}, {"componentType", 5123}}},
                                               {"values", {{"bufferView", 0}}}};
      },
      {"indices", "sparse"});
}

TEST(AccessorErrors, IndexPastTheVertices) {
  // Fewer positions than the indices name.
  expect_edit_error(
      [](json& j) {
        accessor_of(j, "POSITION")["count"] = 3;
        j["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
      },
      {"'cup'", "indices", "of 3"});
}

TEST(AccessorErrors, NotFinite) {
  // Bits of a NaN in the first number of the buffer, through base64: 4 characters are 3 bytes.
  expect_edit_error(
      [](json& j) {
        std::string uri = j["buffers"][0]["uri"];
        const std::size_t at = uri.find(',') + 1;
        uri.replace(at, 6, "AADAfw");  // 00 00 C0 7F
        j["buffers"][0]["uri"] = uri;
      },
      {"'cup'", "POSITION", "finite"});
}

TEST(ReferenceErrors, PointAtNothing) {
  expect_edit_error([](json& j) { test::node_named(j, "cup")["mesh"] = 77; },
                    {"cup.gltf", "'cup'", "mesh", "77"});
  expect_edit_error([](json& j) { test::node_named(j, "cup")["mesh"] = -1; }, {"'cup'", "mesh", "-1"});
  expect_edit_error([](json& j) { test::node_named(j, "cup")["children"] = {500}; },
                    {"'cup'", "children", "500"});
  expect_edit_error([](json& j) { j["scenes"][0]["nodes"].push_back(500); }, {"scene", "500"});
  expect_edit_error([](json& j) { j["scene"] = 4; }, {"scene", "4"});
  expect_edit_error([](json& j) { j["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 500; },
                    {"cup_mesh", "POSITION", "500"});
  expect_edit_error([](json& j) { j["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 500; },
                    {"cup_mesh", "NORMAL"});
  expect_edit_error([](json& j) { j["meshes"][0]["primitives"][0]["indices"] = 500; },
                    {"cup_mesh", "indices", "500"});
  expect_edit_error([](json& j) { j["meshes"][0]["primitives"][0]["material"] = 500; },
                    {"cup_mesh", "material"});
  expect_edit_error([](json& j) { j["meshes"][0]["primitives"][0]["mode"] = 1; },
                    {"cup_mesh", "not made of triangles"});
  expect_edit_error([](json& j) { j["meshes"][0]["primitives"] = json::array(); },
                    {"cup_mesh", "no primitives"});
  expect_edit_error([](json& j) { j["bufferViews"][0]["buffer"] = 9; }, {"bufferView", "9"});
  expect_edit_error([](json& j) { j["animations"][0]["channels"][0]["sampler"] = 9; }, {"'hand'", "sampler"});
  expect_edit_error([](json& j) { j["animations"][0]["samplers"][0]["input"] = 99; },
                    {"'hand'", "input", "99"});
  expect_edit_error([](json& j) { j["animations"][0]["channels"][0]["target"]["node"] = 99; },
                    {"'hand'", "node", "99"});
  expect_edit_error([](json& j) { j["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
                    {"KHR_draco", "without compression"});
}

}  // namespace
}  // namespace slosh
