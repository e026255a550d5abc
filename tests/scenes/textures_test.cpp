// Textures of a scene's file: where they lie, how they are read, and what is said of those that cannot be.
#include "scenes/images/decode.h"
#include "scenes/inspect.h"
#include "support.h"
#include "tests/scenes/images_kit.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::Bytes;
using test::TempFolder;

const Bytes kPixels = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255};

/// The cup with texture coordinates, a checker and what else `paint` names; images are kPixels.
make::SceneWriter textured_cup(make::Paint paint = {}) {
  make::SceneWriter writer(json{{"title", "a cup"}});
  const int checker = writer.add_image("checker", test::png(2, 2, kPixels));
  writer.add_image("bumps", test::png(2, 2, kPixels));
  paint.base_color_map.image = checker;
  const int paint_index = writer.add_material("paint", paint);
  TriangleMesh cup = make::with_normals(make::tank({0.1, 0.1, 0.1}, 0.02));
  for (const glm::vec3& p : cup.positions) cup.texcoords.emplace_back(p.x, 2.0f * p.y);
  writer.add_node("cup", writer.add_mesh("cup_mesh", cup, paint_index), {},
                  {{"slosh", "body"}, {"motion", "free"}, {"mass_kg", 0.5}});
  writer.add_node("water", writer.add_mesh("water", make::box({-0.05, 0.02, -0.05}, {0.05, 0.09, 0.05}), -1),
                  {}, {{"slosh", "fluid"}});
  return writer;
}

Result<Scene> load_textured(make::SceneWriter writer, const char* name = "cup.glb") {
  const TempFolder folder;
  EXPECT_TRUE(writer.write(folder / name));
  return load_scene(folder / name);
}

Result<Scene> load_changed(const test::Edit& edit,
                           const std::function<void(const TempFolder&)>& beside = {}) {
  const TempFolder folder;
  EXPECT_TRUE(textured_cup().write(folder / "cup.gltf"));
  json file = test::read_json(folder / "cup.gltf");
  edit(file);
  if (beside) beside(folder);
  test::write_text(folder / "cup.gltf", file.dump());
  return load_scene(folder / "cup.gltf");
}

/// It loads, shows the cup by its numbers, and says once why.
void expect_left_out(const test::Edit& edit, std::initializer_list<const char*> words,
                     const std::function<void(const TempFolder&)>& beside = {}) {
  const Result<Scene> scene = load_changed(edit, beside);
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_EQ(scene.value().bodies[0].material.maps.base_color.image, -1);
  ASSERT_EQ(scene.value().left_out.size(), 1u);
  const std::string text = scene.value().left_out[0].text();
  for (const char* word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
  EXPECT_FALSE(scene.value().left_out[0].mend.empty()) << text;
}

TEST(SceneTextures, ComeFromTheFilesBuffer) {
  make::Paint paint;
  paint.base_color_map.sampling = {TextureWrap::kMirror, TextureWrap::kClamp,
                                   TextureShrink::kLinearMipNearest, true};
  paint.normal_map.image = 1;
  paint.normal_scale = 0.5;
  paint.occlusion_map.image = 0;
  paint.occlusion_strength = 0.25;
  paint.emissive = {0.5, 1.0, 0.0};
  paint.emissive_map.image = 1;
  paint.metallic_roughness_map.image = 1;
  for (const char* name : {"cup.glb", "cup.gltf"}) {
    const Result<Scene> read = load_textured(textured_cup(paint), name);
    ASSERT_TRUE(read) << read.error().text();
    const Scene& scene = read.value();
    EXPECT_TRUE(scene.left_out.empty()) << scene.left_out[0].text();
    ASSERT_EQ(scene.images.size(), 2u) << "each once";
    const Material& material = scene.bodies[0].material;
    ASSERT_EQ(material.maps.base_color.image, 0);
    EXPECT_EQ(scene.images[0].name, "checker");
    EXPECT_EQ(images::decode(scene.images[0].bytes, "x").value().rgba, kPixels);
    EXPECT_EQ(material.maps.base_color.sampling, paint.base_color_map.sampling);
    EXPECT_EQ(material.maps.normal.image, 1);
    EXPECT_EQ(material.maps.normal.sampling, TextureSampling{});
    EXPECT_FLOAT_EQ(material.maps.normal_scale, 0.5f);
    EXPECT_EQ(material.maps.occlusion.image, 0);
    EXPECT_FLOAT_EQ(material.maps.occlusion_strength, 0.25f);
    EXPECT_EQ(material.maps.metallic_roughness.image, 1);
    EXPECT_EQ(material.maps.emissive.image, 1);
    EXPECT_EQ(material.emissive, glm::vec3(0.5f, 1.0f, 0.0f));
    const TriangleMesh& mesh = scene.meshes[static_cast<std::size_t>(scene.bodies[0].mesh)];
    ASSERT_EQ(mesh.texcoords.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      EXPECT_FLOAT_EQ(mesh.texcoords[i].x, mesh.positions[i].x);
      EXPECT_FLOAT_EQ(mesh.texcoords[i].y, 2.0f * mesh.positions[i].y);
    }
    for (const TriangleMesh& other : scene.meshes)
      EXPECT_EQ(other.texcoords.empty(), &other != &mesh) << "nothing lies on the water";
  }
}

TEST(SceneTextures, AFileBesideTheSceneAndDataInIt) {
  const auto jpeg = test::jpeg(8, 8, Bytes(8 * 8 * 3, 90));
  const auto beside = [&](const TempFolder& folder) {
    std::filesystem::create_directories(folder / "textures");
    test::write_text(folder / "textures/my cup.jpg", std::string(jpeg.begin(), jpeg.end()));
  };
  const Result<Scene> scene = load_changed(
      [](json& file) {
        file["images"][0] = {{"uri", "textures/my%20cup.jpg"}};
        file["images"][1] = {
            {"uri",
             "data:image/"
             "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAAB"
             "JRU5ErkJggg=="}};
        file["textures"].push_back({{"source", 1}});
        file["materials"][0]["normalTexture"] = {{"index", file["textures"].size() - 1}};
      },
      beside);
  ASSERT_TRUE(scene) << scene.error().text();
  ASSERT_EQ(scene.value().images.size(), 2u);
  EXPECT_TRUE(scene.value().left_out.empty());
  EXPECT_EQ(scene.value().images[0].bytes, jpeg);
  EXPECT_EQ(images::decode(scene.value().images[1].bytes, "x").value().width, 1);
}

TEST(SceneTextures, WhatCannotBeShownIsLeftOutAndSaid) {
  expect_left_out(
      [](json& f) {
        f["images"][0] = {{"uri", "gone.png"}};
      },
      {"image", "gone.png", "no such file"});
  expect_left_out(
      [](json& f) {
        f["images"][0] = {{"uri", "notes.txt"}, {"name", "wood"}};
      },
      {"'wood'", "neither a PNG nor a JPEG"},
      [](const TempFolder& folder) { test::write_text(folder / "notes.txt", "hello"); });
  expect_left_out(
      [](json& f) {
        f["images"][0] = {{"uri", "big.png"}};
      },
      {"9000 × 9000", "8192"},
      [](const TempFolder& folder) {
        Bytes big = test::png(2, 2, kPixels);
        test::claim_size(big, 9000, 9000);
        test::write_text(folder / "big.png", std::string(big.begin(), big.end()));
      });
  expect_left_out([](json& f) { f["images"][0]["bufferView"] = 4711; }, {"neither a file nor data"});
  expect_left_out([](json& f) { f["images"][0] = {{"uri", "data:image/png;base64,!!"}}; }, {"base64"});
  expect_left_out([](json& f) { f["images"][0] = json::object(); }, {"neither a file nor data"});
  expect_left_out([](json& f) { f["images"] = 5; }, {"base colour texture", "names no image"});
  expect_left_out([](json& f) { f.erase("textures"); }, {"base colour texture", "names no image"});
  expect_left_out([](json& f) { f["textures"][0].erase("source"); },
                  {"base colour texture", "names no image"});
  expect_left_out(
      [](json& f) {
        f["textures"][0] = {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
        f["extensionsUsed"] = {"EXT_texture_webp"};
      },
      {"base colour texture", "a form that is not read", "PNG or JPEG"});
}

TEST(SceneTextures, WildNumbersDoNoHarm) {
  for (const json& wild : std::vector<json>{nullptr, -1, 1e300, "x", json::array(), json::object(), true}) {
    for (const char* path :
         {"/materials/0/pbrMetallicRoughness/baseColorTexture", "/textures", "/samplers",
          "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
          "/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", "/textures/0", "/textures/0/sampler",
          "/samplers/0", "/samplers/0/wrapS", "/images/0", "/images", "/images/0/bufferView",
          "/materials/0/emissiveTexture", "/materials/0/extensions/KHR_materials_emissive_strength"}) {
      const Result<Scene> scene = load_changed([&](json& file) { file[json::json_pointer(path)] = wild; });
      EXPECT_TRUE(scene) << path << " = " << wild << ": " << scene.error().text();
    }
  }
}

TEST(SceneTextures, OneMappingAMaterial) {
  const json moved = {{"KHR_texture_transform",
                       {{"offset", {0.5, 0.25}}, {"scale", {2, 3}}, {"rotation", 1.5707963267948966}}}};
  const Result<Scene> scene = load_changed([&](json& file) {
    json& material = file["materials"][0];
    material["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] = moved;
    material["normalTexture"] = {{"index", 0}, {"extensions", moved}};
    material["emissiveTexture"] = {{"index", 0}};
    material["occlusionTexture"] = {{"index", 0}, {"texCoord", 1}, {"extensions", moved}};
  });
  ASSERT_TRUE(scene) << scene.error().text();
  const MaterialMaps& maps = scene.value().bodies[0].material.maps;
  EXPECT_GE(maps.base_color.image, 0);
  EXPECT_GE(maps.normal.image, 0);
  EXPECT_EQ(maps.emissive.image, -1);
  EXPECT_EQ(maps.occlusion.image, -1);
  EXPECT_EQ(scene.value().left_out.size(), 2u);
  const TriangleMesh& mesh = scene.value().meshes[static_cast<std::size_t>(scene.value().bodies[0].mesh)];
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    // Scaled, turned a quarter (u′ = v, v′ = −u), moved.
    EXPECT_NEAR(mesh.texcoords[i].x, 3.0f * 2.0f * mesh.positions[i].y + 0.5f, 1e-5f);
    EXPECT_NEAR(mesh.texcoords[i].y, -2.0f * mesh.positions[i].x + 0.25f, 1e-5f);
  }
}

TEST(SceneTextures, AlphaCutsOutWhereTheMaterialAsksForIt) {
  const auto cutoff = [](const test::Edit& edit) { return load_changed(edit).value().bodies[0].material; };
  EXPECT_EQ(cutoff([](json&) {}).alpha_cutoff, 0.0f);
  EXPECT_EQ(cutoff([](json& f) { f["materials"][0]["alphaMode"] = "MASK"; }).alpha_cutoff, 0.5f);
  EXPECT_EQ(cutoff([](json& f) {
              f["materials"][0]["alphaMode"] = "MASK";
              f["materials"][0]["alphaCutoff"] = 0.75;
            }).alpha_cutoff,
            0.75f);
  const Material label = cutoff([](json& f) { f["materials"][0]["alphaMode"] = "BLEND"; });
  EXPECT_EQ(label.alpha_cutoff, 0.5f) << "blended by its texture alone";
  EXPECT_EQ(label.opacity, 1.0f);
  const Material glass = cutoff([](json& f) {
    f["materials"][0]["alphaMode"] = "BLEND";
    f["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, 0.25};
  });
  EXPECT_EQ(glass.alpha_cutoff, 0.0f);
  EXPECT_EQ(glass.opacity, 0.25f);
}

TEST(SceneTextures, TooManyPixelsInAllAreLeftOut) {
  // Each fits, both together do not.
  const Result<Scene> scene = load_changed(
      [](json& file) {
        file["images"] = {{{"uri", "a.png"}}, {{"uri", "b.png"}}};
        file["textures"].push_back({{"source", 1}});
        file["materials"][0]["normalTexture"] = {{"index", file["textures"].size() - 1}};
      },
      [](const TempFolder& folder) {
        Bytes big = test::png(2, 2, kPixels);
        test::claim_size(big, 8192, 6000);
        for (const char* name : {"a.png", "b.png"})
          test::write_text(folder / name, std::string(big.begin(), big.end()));
      });
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_EQ(scene.value().images.size(), 1u);
  ASSERT_EQ(scene.value().left_out.size(), 1u);
  EXPECT_NE(scene.value().left_out[0].text().find("64 million pixels"), std::string::npos);
}

TEST(SceneTextures, CheckUnpacksThemAndWarns) {
  const TempFolder folder;
  ASSERT_TRUE(textured_cup().write(folder / "cup.gltf"));
  const auto kinds = [&] {
    std::string all;
    for (const Finding& finding : inspect_scene(folder / "cup.gltf").warnings)
      if (finding.kind == "texture") all += finding.text.text() + "\n";
    return all;
  };
  EXPECT_EQ(kinds(), "");
  json file = test::read_json(folder / "cup.gltf");
  Bytes cut = test::png(2, 2, kPixels);
  cut.resize(cut.size() - 20);
  test::write_text(folder / "cut.png", std::string(cut.begin(), cut.end()));
  file["images"][0] = {{"uri", "cut.png"}, {"name", "wood"}};
  test::write_text(folder / "cup.gltf", file.dump());
  EXPECT_NE(kinds().find("image 'wood': is a PNG that cannot be read"), std::string::npos) << kinds();
}

}  // namespace
}  // namespace slosh
