// A corpus of one scene as real exporters would write it: whatever the file looks like, the same cup of water
// is read.
#include <cmath>

#include "corpus_kit.h"
#include "scenes/sample.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::accessor_of;
using test::add_accessor;
using test::indices_of;
using test::mesh_of;
using test::node_named;
using test::positions_of;

std::size_t index_of(const json& j, const std::string& name) {
  for (std::size_t i = 0; i < j["nodes"].size(); ++i)
    if (j["nodes"][i].value("name", "") == name) return i;
  throw std::runtime_error("no node " + name);
}

const char* const kOurs[] = {"cup", "water"};

struct Foreign {
  const char* name;
  void (*edit)(json&);
};

void blenders_usual(json& j) {
  j["asset"] = {{"version", "2.0"}, {"generator", "Khronos glTF Blender I/O v4.2.57"}};
  j["scenes"][0]["extras"]["glTF2ExportSettings"] = {{"export_apply", true}};
  j["extensionsUsed"] = {"KHR_materials_specular", "KHR_materials_ior", "KHR_lights_punctual"};
  for (json& material : j["materials"]) {
    material["doubleSided"] = true;
    material["extensions"] = {{"KHR_materials_specular", {{"specularFactor", 0.5}}},
                              {"KHR_materials_ior", {{"ior", 1.45}}}};
  }
  j["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"intensity", 54.0}, {"name", "Light"}}};
  j["nodes"].push_back({{"name", "Light"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  j["scenes"][0]["nodes"].push_back(j["nodes"].size() - 1);
  for (const char* node : kOurs) {
    json& primitive = mesh_of(j, node)["primitives"][0];
    // A second UV map, and colours that were never painted.
    j["accessors"].push_back(
        {{"componentType", 5126}, {"count", accessor_of(j, node, "POSITION")["count"]}, {"type", "VEC2"}});
    primitive["attributes"]["TEXCOORD_1"] = j["accessors"].size() - 1;
    primitive["attributes"]["COLOR_0"] = primitive["attributes"]["POSITION"];
    mesh_of(j, node)["extras"]["targetNames"] = json::array();
    node_named(j, node)["extras"]["cycles"] = {{"is_shadow_catcher", false}};
  }
}

void an_armature_beside_it(json& j) {
  j["nodes"].push_back({{"name", "Bone"}});
  const std::size_t bone = j["nodes"].size() - 1;
  j["nodes"].push_back({{"name", "Armature"}, {"children", {bone}}});
  j["scenes"][0]["nodes"].push_back(j["nodes"].size() - 1);
  j["skins"] = {{{"joints", {bone}}, {"name", "Armature"}}};
  node_named(j, "table")["skin"] = 0;
  json walk = j["animations"][0];
  walk["name"] = "Walk";
  for (json& channel : walk["channels"]) channel["target"]["node"] = bone;
  j["animations"].push_back(walk);
}

void matrices_for_transforms(json& j) {
  for (const char* node : kOurs) {
    node_named(j, node).erase("translation");
    node_named(j, node).erase("rotation");
    node_named(j, node)["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  }
}

/// Millimetres below a parent that scales them away, twice: as CAD and some game engines have it.
void a_hierarchy_of_scales(json& j) {
  j["nodes"].push_back(
      {{"name", "root"}, {"scale", {0.001, 0.001, 0.001}}, {"children", j["scenes"][0]["nodes"]}});
  j["nodes"].push_back(
      {{"name", "world"}, {"scale", {1000.0, 1000.0, 1000.0}}, {"children", {j["nodes"].size() - 1}}});
  j["scenes"][0]["nodes"] = {j["nodes"].size() - 1};
}

void a_quarter_turn_and_back(json& j) {
  const double s = std::sqrt(0.5);
  j["nodes"].push_back(
      {{"name", "turned"}, {"rotation", {s, 0, 0, s}}, {"children", j["scenes"][0]["nodes"]}});
  j["nodes"].push_back(
      {{"name", "back"}, {"rotation", {-s, 0, 0, s}}, {"children", {j["nodes"].size() - 1}}});
  j["scenes"][0]["nodes"] = {j["nodes"].size() - 1};
}

void a_mirror(json& j) {
  for (const char* node : kOurs) node_named(j, node)["scale"] = {-1, 1, 1};
}

void the_second_of_three_scenes(json& j) {
  const json ours = j["scenes"][0];
  j["scenes"] = {{{"name", "Empty"}}, ours, {{"name", "Draft"}, {"nodes", {index_of(j, "table")}}}};
  j["scene"] = 1;
}

void no_default_scene(json& j) {
  j.erase("scene");
}

/// Some positions wrong in the data, and set right by a sparse part.
void sparse_positions(json& j) {
  for (const char* node : kOurs) {
    std::vector<float> all = positions_of(j, node);
    const std::vector<float> right(all.begin() + 3, all.begin() + 9);
    for (int i = 3; i < 9; ++i) all[static_cast<std::size_t>(i)] = 9.0f;
    const std::size_t base = add_accessor(j, all, 5126, "VEC3", all.size() / 3);
    const std::size_t at = add_accessor(j, std::vector<std::uint16_t>{1, 2}, 5123, "SCALAR", 2);
    const std::size_t values = add_accessor(j, right, 5126, "VEC3", 2);
    j["accessors"][base]["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", j["accessors"][at]["bufferView"]}, {"componentType", 5123}}},
        {"values", {{"bufferView", j["accessors"][values]["bufferView"]}}}};
    mesh_of(j, node)["primitives"][0]["attributes"]["POSITION"] = base;
  }
}

/// Nothing in the data at all: every position by the sparse part.
void sparse_alone(json& j) {
  for (const char* node : kOurs) {
    const std::vector<float> all = positions_of(j, node);
    std::vector<std::uint32_t> every(all.size() / 3);
    for (std::size_t i = 0; i < every.size(); ++i) every[i] = static_cast<std::uint32_t>(i);
    const std::size_t at = add_accessor(j, every, 5125, "SCALAR", every.size());
    const std::size_t values = add_accessor(j, all, 5126, "VEC3", every.size());
    j["accessors"].push_back(
        {{"componentType", 5126},
         {"count", every.size()},
         {"type", "VEC3"},
         {"sparse",
          {{"count", every.size()},
           {"indices", {{"bufferView", j["accessors"][at]["bufferView"]}, {"componentType", 5125}}},
           {"values", {{"bufferView", j["accessors"][values]["bufferView"]}}}}}});
    mesh_of(j, node)["primitives"][0]["attributes"]["POSITION"] = j["accessors"].size() - 1;
  }
}

void no_indices_and_no_normals(json& j) {
  for (const char* node : kOurs) {
    const std::vector<float> points = positions_of(j, node);
    std::vector<float> soup;
    for (const std::uint32_t i : indices_of(j, node))
      soup.insert(soup.end(), points.begin() + 3 * i, points.begin() + 3 * i + 3);
    json& primitive = mesh_of(j, node)["primitives"][0];
    primitive["attributes"] = {{"POSITION", add_accessor(j, soup, 5126, "VEC3", soup.size() / 3)}};
    mesh_of(j, node)["primitives"][0].erase("indices");
  }
}

/// Each triangle a strip of its own, joined by corners that collapse.
void strips(json& j) {
  for (const char* node : kOurs) {
    const std::vector<std::uint32_t> list = indices_of(j, node);
    std::vector<std::uint32_t> strip;
    for (std::size_t i = 0; i < list.size(); i += 3) {
      if (!strip.empty()) {
        strip.push_back(strip.back());
        strip.push_back(list[i]);
        if (strip.size() % 2 != 0) strip.push_back(list[i]);
      }
      strip.insert(strip.end(), list.begin() + static_cast<std::ptrdiff_t>(i),
                   list.begin() + static_cast<std::ptrdiff_t>(i) + 3);
    }
    json& primitive = mesh_of(j, node)["primitives"][0];
    primitive["mode"] = 5;
    const std::size_t at = add_accessor(j, strip, 5125, "SCALAR", strip.size());
    mesh_of(j, node)["primitives"][0]["indices"] = at;
  }
}

/// A part a face, as CAD has it: primitives of different materials, one a triangle, the last ones as fans.
void a_primitive_a_face(json& j) {
  for (const char* node : kOurs) {
    const std::vector<std::uint32_t> list = indices_of(j, node);
    const json source = mesh_of(j, node)["primitives"][0];
    json primitives = json::array();
    for (std::size_t i = 0; i < list.size(); i += 3) {
      json one = source;
      one["indices"] =
          add_accessor(j,
                       std::vector<std::uint32_t>(list.begin() + static_cast<std::ptrdiff_t>(i),
                                                  list.begin() + static_cast<std::ptrdiff_t>(i) + 3),
                       5125, "SCALAR", 3);
      one["mode"] = i % 2 == 0 ? 4 : 6;
      primitives.push_back(one);
    }
    mesh_of(j, node)["primitives"] = primitives;
  }
}

/// Positions as 16-bit numbers below a scale, as mesh optimisers write them.
void quantised(json& j) {
  j["extensionsUsed"] = j["extensionsRequired"] = {"KHR_mesh_quantization"};
  for (const char* node : kOurs) {
    std::vector<std::int16_t> whole;
    const std::vector<float> points = positions_of(j, node);
    for (std::size_t i = 0; i < points.size(); ++i) {
      whole.push_back(static_cast<std::int16_t>(std::lround(1e5 * static_cast<double>(points[i]))));
      if (i % 3 == 2) whole.push_back(0);  // a stride of four bytes
    }
    const std::size_t at = add_accessor(j, whole, 5122, "VEC3", points.size() / 3);
    j["bufferViews"][j["accessors"][at]["bufferView"].get<std::size_t>()]["byteStride"] = 8;
    mesh_of(j, node)["primitives"][0]["attributes"] = {{"POSITION", at}};
    node_named(j, node)["scale"] = {1e-5, 1e-5, 1e-5};
  }
  // The handle hangs on the cup, whose scale it does not want.
  json& cup = node_named(j, "cup");
  cup.erase("children");
  j["nodes"].push_back(
      {{"name", "holder"}, {"scale", {1e5, 1e5, 1e5}}, {"children", {index_of(j, "handle")}}});
  node_named(j, "cup")["children"] = {j["nodes"].size() - 1};
}

/// A scan of a table: an open sheet of noise with loose points and doubled faces, no normals.
void a_scan_as_decoration(json& j) {
  std::vector<float> points;
  std::vector<std::uint32_t> faces;
  const std::uint32_t n = 40;
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x) {
      const auto ripple = static_cast<float>(0.01 * std::sin(7.3 * x) * std::cos(5.1 * y));
      points.insert(points.end(), {0.02f * static_cast<float>(x) - 0.4f, -0.05f + ripple,
                                   0.02f * static_cast<float>(y) - 0.4f});
    }
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      if ((x * 7 + y * 13) % 11 == 0) continue;  // holes
      const std::uint32_t a = y * (n + 1) + x;
      for (const std::uint32_t i : {a, a + n + 1, a + 1, a + 1, a + n + 1, a + n + 2}) faces.push_back(i);
      if (x % 5 == 0)
        for (const std::uint32_t i : {a, a + n + 1, a + 1}) faces.push_back(i);  // a face twice
    }
  const std::size_t at = add_accessor(j, points, 5126, "VEC3", points.size() / 3);
  const std::size_t by = add_accessor(j, faces, 5125, "SCALAR", faces.size());
  mesh_of(j, "table")["primitives"] = {{{"attributes", {{"POSITION", at}}}, {"indices", by}},
                                       {{"attributes", {{"POSITION", at}}}, {"mode", 0}}};
}

void instanced_decoration(json& j) {
  j["extensionsUsed"] = j["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
  const std::size_t at = add_accessor(j, std::vector<float>{0, 0, 0, 1, 0, 0}, 5126, "VEC3", 2);
  node_named(j, "table")["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = at;
}

/// A BIM's tags on everything, and units in words of another program's.
void strangers_tags(json& j) {
  for (json& node : j["nodes"]) {
    node["extras"]["ifc_guid"] = "2O2Fr$t4X7Zf8NOew3FNr2";
    node["extras"]["uuid"] = 7;
  }
  j["extras"] = {{"author", "nobody"}};
}

const Foreign kCorpus[] = {
    {"plain", [](json&) {}},
    {"blenders_usual", blenders_usual},
    {"an_armature_beside_it", an_armature_beside_it},
    {"matrices_for_transforms", matrices_for_transforms},
    {"a_hierarchy_of_scales", a_hierarchy_of_scales},
    {"a_quarter_turn_and_back", a_quarter_turn_and_back},
    {"a_mirror", a_mirror},
    {"the_second_of_three_scenes", the_second_of_three_scenes},
    {"no_default_scene", no_default_scene},
    {"sparse_positions", sparse_positions},
    {"sparse_alone", sparse_alone},
    {"no_indices_and_no_normals", no_indices_and_no_normals},
    {"strips", strips},
    {"a_primitive_a_face", a_primitive_a_face},
    {"quantised", quantised},
    {"a_scan_as_decoration", a_scan_as_decoration},
    {"instanced_decoration", instanced_decoration},
    {"strangers_tags", strangers_tags},
};

class Corpus : public ::testing::TestWithParam<Foreign> {};

TEST_P(Corpus, TheSameCupOfWaterIsRead) {
  const Inspection plain = test::inspect_foreign([](json&) {});
  const Inspection found = test::inspect_foreign(GetParam().edit);
  ASSERT_TRUE(found.scene) << test::all_text(found.errors);
  const Scene& is = *found.scene;
  const Scene& was = *plain.scene;
  ASSERT_EQ(is.bodies.size(), was.bodies.size());
  ASSERT_EQ(is.fluid_volumes.size(), was.fluid_volumes.size());
  ASSERT_EQ(is.grips.size(), was.grips.size());
  EXPECT_EQ(is.settle, was.settle);
  EXPECT_EQ(is.bodies[0].mass.mass, was.bodies[0].mass.mass);
  const auto center = [](const Body& body) { return transform_point(body.pose, body.mass.center_of_mass); };
  EXPECT_LT(glm::distance(center(is.bodies[0]), center(was.bodies[0])), 1e-5);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(is.bodies[0].mass.inertia[i][i], was.bodies[0].mass.inertia[i][i],
                1e-3 * was.bodies[0].mass.inertia[i][i]);
  const glm::dvec3 grip = compose(is.bodies[0].pose, is.grips[0].pose).position;
  EXPECT_LT(glm::distance(grip, compose(was.bodies[0].pose, was.grips[0].pose).position), 1e-6);
  EXPECT_EQ(is.grips[0].hand_motion.size(), was.grips[0].hand_motion.size());
  EXPECT_NEAR(estimate_particles(is, 0.01).fluid, estimate_particles(was, 0.01).fluid, 1e-2);
  EXPECT_NEAR(estimate_particles(is, 0.01).surface, estimate_particles(was, 0.01).surface, 1.0);
  for (const TriangleMesh& mesh : is.meshes) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (const glm::uvec3& t : mesh.triangles)
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(glm::length(mesh.normals[t[i]]), 1.0f, 1e-3f);
  }
  const Result<SampledScene> sampled = sample_scene(is, 0.012);
  ASSERT_TRUE(sampled) << sampled.error().text();
  EXPECT_EQ(sampled.value().fluid_positions.size(), sample_scene(was, 0.012).value().fluid_positions.size());
}

INSTANTIATE_TEST_SUITE_P(Files, Corpus, ::testing::ValuesIn(kCorpus),
                         [](const auto& tried) { return std::string(tried.param.name); });

TEST(Foreign, FacesWithoutNormalsAreShadedFlat) {
  const Inspection found = test::inspect_foreign([](json& j) {
    for (const char* node : {"cup", "table"}) mesh_of(j, node)["primitives"][0]["attributes"].erase("NORMAL");
  });
  ASSERT_TRUE(found.scene);
  for (const int mesh : {found.scene->bodies[0].mesh, found.scene->pictures[0].mesh}) {
    const TriangleMesh& m = found.scene->meshes[static_cast<std::size_t>(mesh)];
    for (const glm::uvec3& t : m.triangles) {
      const glm::vec3 face = glm::normalize(
          glm::cross(m.positions[t.y] - m.positions[t.x], m.positions[t.z] - m.positions[t.x]));
      for (int i = 0; i < 3; ++i) EXPECT_GT(glm::dot(face, m.normals[t[i]]), 0.9999f);
    }
  }
}

TEST(Foreign, NamesInCapitalsAreNames) {
  const test::TempFolder folder;
  ASSERT_TRUE(test::make_cup().write(folder / "cup.glb"));
  std::filesystem::rename(folder / "cup.glb", folder / "CUP.GLB");
  const Result<std::filesystem::path> found = find_scene((folder / "CUP.GLB").string());
  ASSERT_TRUE(found) << found.error().text();
  EXPECT_TRUE(load_scene(found.value()));
}

TEST(Foreign, APointerOfGitLfsIsNamed) {
  const test::TempFolder folder;
  test::write_text(folder / "cup.glb",
                   "version https://git-lfs.github.com/spec/v1\noid "
                   "sha256:4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 12345\n");
  test::expect_error(load_scene(folder / "cup.glb"), {"cup.glb", "Git LFS", "git lfs pull"});
}

}  // namespace
}  // namespace slosh
