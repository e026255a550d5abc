#include "net/wire/scene_package.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "net/wire/scene_fields.h"
#include "scenes/load.h"
#include "tests/net/wire/damage.h"
#include "tests/net/wire/package_kit.h"
#include "tests/net/wire/same_scene.h"
#include "tests/support/small_scene.h"

namespace slosh {
namespace {

using test::package_error;
using test::packed;
using test::stored;
using wire::Bytes;
using wire::ByteView;

TEST(ScenePackage, ShippedScenesComeBackToTheBit) {
  for (const SceneEntry& entry : shipped_scenes()) {
    SCOPED_TRACE(entry.name);
    const Result<Scene> scene = load_scene(entry.file);
    ASSERT_TRUE(static_cast<bool>(scene)) << scene.error().text();
    const Bytes all = packed(scene.value());
    const Result<UnpackedScene> back = unpack_scene(all);
    ASSERT_TRUE(static_cast<bool>(back)) << back.error().text();
    test::expect_same_scene(back.value().scene, scene.value());
    EXPECT_EQ(back.value().spacing, 0.01);
    const Bytes seen = packed(scene.value(), SceneParts::kSeen);
    EXPECT_LE(seen.size(), all.size());
    Bytes plain;
    EXPECT_FALSE(wire::encode(wire::SceneAt<wire::kPlainScene>{{scene.value(), 0.01}}, plain));
    std::printf("%-8s %7zu bytes plain, %7zu packed, %7zu what is seen\n", entry.name.c_str(), plain.size(),
                all.size(), seen.size());
    EXPECT_LT(plain.size(), 32 * all.size()) << "stored for want of belief";
  }
}

TEST(ScenePackage, KeepsWhatAPeerSeesAndHolds) {
  const Scene scene = test::small_scene();
  const Result<UnpackedScene> back = unpack_scene(packed(scene, SceneParts::kSeen));
  ASSERT_TRUE(static_cast<bool>(back)) << back.error().text();
  Scene expected = scene;
  expected.source_file.clear();
  expected.fluid_volumes.clear();
  expected.meshes.erase(expected.meshes.begin());
  expected.bodies[0].mesh = 0;
  expected.bodies[1].mesh = 1;
  expected.pictures[0].mesh = 1;
  test::expect_same_scene(back.value().scene, expected);
}

TEST(ScenePackage, FieldsRoundTripAndEveryCutAndDamageIsRefused) {
  const wire::SceneAt<wire::kPlainScene> scene{{test::small_scene(), 0.0123456789}};
  test::expect_round_trip(scene);
  test::expect_cuts_refused(scene);
  EXPECT_GT(test::expect_damages_refused(scene), 1000u);
}

TEST(ScenePackage, TellsWhatTookTheGoneModelsPlace) {
  const wire::SceneAt<wire::kPlainScene> scene{{test::small_scene(), 0.01}};
  wire::Damaged damaged;
  for (std::size_t which = 0; damaged.damage != "a choice that is gone"; ++which) {
    damaged = wire::damaged_message(scene, which);
    ASSERT_FALSE(damaged.field.empty());
  }
  wire::SceneAt<wire::kPlainScene> back;
  EXPECT_EQ(wire::decode(damaged.bytes, back).text(),
            "model: 0 is the model `consistent`, which is no more: `corrected` took its place; there are "
            "paper, corrected, incompressible");
}

TEST(ScenePackage, InstrumentsTravelOnlyWhereTheyAreNeeded) {
  Scene scene = test::small_scene();
  EXPECT_EQ(packed(scene)[0], 1) << "as programs from before read it";
  scene.gauges.push_back({"level", 0, {0.1, 0.2, 0.3}});
  scene.gauges.push_back({"shore", -1, {0.4, 0.0, 0.0}});
  scene.regions.push_back({"in the bucket", 0, 0, {{0.0, 0.1, 0.0}, {1, 0, 0, 0}}});
  const Bytes all = packed(scene);
  EXPECT_EQ(all[0], 2);
  const Result<UnpackedScene> back = unpack_scene(all);
  ASSERT_TRUE(static_cast<bool>(back)) << back.error().text();
  test::expect_same_scene(back.value().scene, scene);
  const Bytes seen = packed(scene, SceneParts::kSeen);
  EXPECT_EQ(seen[0], 1) << "a peer measures nothing";
  test::expect_round_trip(wire::SceneAt<wire::kMeasuredScene>{{scene, 0.01}});
  test::expect_cuts_refused(wire::SceneAt<wire::kMeasuredScene>{{scene, 0.01}});
  scene.regions[0].mesh = 99;
  EXPECT_NE(pack_scene(scene, 0.01, SceneParts::kAll).error().text().find("regions.mesh"), std::string::npos);
}

TEST(ScenePackage, SettlingTravelsOnlyWhereItIsAskedFor) {
  Scene scene = test::small_scene();
  scene.settle = 1.25;
  const Bytes all = packed(scene);
  EXPECT_EQ(all[0], 3);
  const Result<UnpackedScene> back = unpack_scene(all);
  ASSERT_TRUE(static_cast<bool>(back)) << back.error().text();
  test::expect_same_scene(back.value().scene, scene);
  EXPECT_EQ(packed(scene, SceneParts::kSeen)[0], 1) << "a peer settles nothing";
  scene.gauges.push_back({"level", 0, {0.1, 0.2, 0.3}});
  test::expect_same_scene(unpack_scene(packed(scene)).value().scene, scene);
  test::expect_round_trip(wire::SceneAt<wire::kSettledScene>{{scene, 0.01}});
  test::expect_cuts_refused(wire::SceneAt<wire::kSettledScene>{{scene, 0.01}});
  scene.settle = 61.0;
  EXPECT_NE(pack_scene(scene, 0.01, SceneParts::kAll).error().text().find("settle"), std::string::npos);
}

TEST(ScenePackage, LooksTravelOnlyWhereTheyAreGiven) {
  Scene scene = test::small_scene();
  scene.fluids[0].extinction = glm::vec3(400.0f);
  scene.fluids[0].scattering = usual_scattering(scene.fluids[0].extinction);
  const Bytes usual = packed(scene);
  EXPECT_EQ(usual[0], 1) << "as programs from before read it";
  test::expect_same_scene(unpack_scene(usual).value().scene, scene);
  for (const auto& change : std::initializer_list<void (*)(Fluid&)>{
           [](Fluid& f) { f.gloss = 0.25f; }, [](Fluid& f) { f.refraction = 1.49f; },
           [](Fluid& f) { f.scattering = 0.3f; }, [](Fluid& f) { f.roughness = 0.4f; }}) {
    Scene looked = scene;
    change(looked.fluids[0]);
    for (const SceneParts parts : {SceneParts::kAll, SceneParts::kSeen}) {
      const Bytes bytes = packed(looked, parts);
      EXPECT_EQ(bytes[0], 4);
      const Result<UnpackedScene> back = unpack_scene(bytes);
      ASSERT_TRUE(static_cast<bool>(back)) << back.error().text();
      EXPECT_EQ(back.value().scene.fluids, looked.fluids);
    }
  }
  const wire::SceneAt<wire::kLookedScene> whole{{scene, 0.01}};
  test::expect_round_trip(whole);
  test::expect_cuts_refused(whole);
  scene.fluids[0].refraction = 0.9f;
  EXPECT_NE(pack_scene(scene, 0.01, SceneParts::kAll).error().text().find("looks.refraction"),
            std::string::npos);
}

/// Two images, one of them on a body and on the picture; the second on the picture alone.
Scene textured_scene() {
  Scene scene = test::small_scene();
  scene.images = {{"paint", {1, 2, 3, 4, 5}}, {"bumps", {9, 8, 7}}};
  for (TriangleMesh& mesh : scene.meshes)
    for (const glm::vec3& p : mesh.positions) mesh.texcoords.emplace_back(p.x, 1.0f - p.y);
  Material& body = scene.bodies[0].material;
  body.maps.base_color = {
      0, {TextureWrap::kMirror, TextureWrap::kClamp, TextureShrink::kNearestMipLinear, true}};
  body.emissive = {0.5f, 0.25f, 4.0f};
  body.alpha_cutoff = 0.5f;
  Material& picture = scene.pictures[0].material;
  picture.maps.normal = {1, {}};
  picture.maps.normal_scale = -0.75f;
  picture.maps.occlusion = {0, {}};
  picture.maps.occlusion_strength = 0.5f;
  return scene;
}

TEST(ScenePackage, TexturesTravelWithTheSceneThatHasThem) {
  const Scene scene = textured_scene();
  const Bytes all = packed(scene);
  EXPECT_EQ(all[0], 5);
  const Result<UnpackedScene> back = unpack_scene(all);
  ASSERT_TRUE(static_cast<bool>(back)) << back.error().text();
  test::expect_same_scene(back.value().scene, scene);
  EXPECT_EQ(packed(test::small_scene())[0], 1) << "as programs from before read it";
  Scene glows = test::small_scene();
  glows.bodies[0].material.emissive = glm::vec3(1.0f);
  EXPECT_EQ(packed(glows)[0], 5);
  EXPECT_EQ(unpack_scene(packed(glows)).value().scene.bodies[0].material, glows.bodies[0].material);
  // A peer gets what is shown, and an image that nothing shows does not travel at all.
  Scene one = scene;
  one.pictures[0].material.maps.normal.image = -1;
  const Scene seen = unpack_scene(packed(one, SceneParts::kSeen)).value().scene;
  ASSERT_EQ(seen.images.size(), 1u);
  EXPECT_EQ(seen.images[0].name, "paint");
  EXPECT_EQ(seen.pictures[0].material.maps.occlusion.image, 0);
}

TEST(ScenePackage, TexturesFieldsAreCheckedLikeAllOthers) {
  const wire::SceneAt<wire::kTexturedScene> whole{{textured_scene(), 0.01}};
  test::expect_round_trip(whole);
  test::expect_cuts_refused(whole);
  EXPECT_GT(test::expect_damages_refused(whole), 1000u);
  wire::SceneAt<wire::kTexturedScene> short_one = whole;
  short_one.packed.scene.meshes[0].texcoords.pop_back();
  Bytes bytes;
  wire::encode(short_one, bytes);
  wire::SceneAt<wire::kTexturedScene> read;
  EXPECT_NE(wire::decode(bytes, read).text().find("texcoords"), std::string::npos);
}

TEST(ScenePackage, ImagesBeyondTheLimitStayBehindAndAreNamed) {
  Scene scene = textured_scene();
  scene.images[0].bytes.assign(wire::kMaxSentImages - 2, 77);
  const std::vector<std::string> told = images_left_behind(scene);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find("'bumps'"), std::string::npos) << told[0];
  EXPECT_NE(told[0].find("16 MB"), std::string::npos) << told[0];
  const Result<UnpackedScene> back = unpack_scene(packed(scene, SceneParts::kSeen));
  ASSERT_TRUE(static_cast<bool>(back)) << back.error().text();
  ASSERT_EQ(back.value().scene.images.size(), 1u);
  EXPECT_EQ(back.value().scene.pictures[0].material.maps.normal.image, -1);
  EXPECT_EQ(back.value().scene.pictures[0].material.maps.occlusion.image, 0);
  EXPECT_TRUE(images_left_behind(textured_scene()).empty());
}

TEST(ScenePackage, AWallHasAViscosityOrTheFluidsOrNone) {
  Scene scene = test::small_scene();
  for (const double wall : {kFluidsViscosity, kFreeSlip}) {
    scene.bodies[0].dynamic_viscosity = wall;
    const Result<UnpackedScene> back = unpack_scene(packed(scene));
    ASSERT_TRUE(static_cast<bool>(back)) << back.error().text();
    EXPECT_EQ(back.value().scene.bodies[0].dynamic_viscosity, wall);
  }
  scene.bodies[0].dynamic_viscosity = -0.5;
  EXPECT_NE(pack_scene(scene, 0.01, SceneParts::kAll).error().text().find("dynamic_viscosity"),
            std::string::npos);
}

TEST(ScenePackage, RulesBetweenFieldsHold) {
  const struct {
    const char* field;
    std::function<void(Scene&)> damage;
  } cases[] = {
      {"meshes.triangles.b", [](Scene& s) { s.meshes[1].triangles[2].y = 4; }},
      {"meshes.normals", [](Scene& s) { s.meshes[1].normals.pop_back(); }},
      {"meshes.normals.normal", [](Scene& s) { s.meshes[1].normals[0] *= 1.1f; }},
      {"fluid_volumes.mesh", [](Scene& s) { s.fluid_volumes[0].mesh = 3; }},
      {"fluid_volumes.mesh", [](Scene& s) { s.fluid_volumes[0].mesh = -1; }},
      {"fluid_volumes.fluid", [](Scene& s) { s.fluid_volumes[0].fluid = 1; }},
      {"bodies.mesh", [](Scene& s) { s.bodies[1].mesh = -1; }},
      {"bodies.mesh", [](Scene& s) { s.bodies[1].mesh = 9; }},
      {"bodies.mass", [](Scene& s) { s.bodies[0].mass.mass = 0.0; }},
      {"bodies.inertia_x", [](Scene& s) { s.bodies[0].mass.inertia = glm::dmat3(0.0); }},
      {"bodies.inertia_x", [](Scene& s) { s.bodies[0].mass.inertia[1][1] = -0.01; }},
      {"pictures.mesh", [](Scene& s) { s.pictures[0].mesh = -1; }},
      {"grips.body", [](Scene& s) { s.grips[0].body = 3; }},
      {"grips.body", [](Scene& s) { s.grips[0].body = -1; }},
      {"grips.body", [](Scene& s) { s.grips[0].body = 1; }},  // fixed
      {"grips.hand_motion.time", [](Scene& s) { s.grips[0].hand_motion[1].time = 1.0; }},
      {"grips.hand_motion.time", [](Scene& s) { s.grips[0].hand_motion[1].time = 0.0; }},
      {"target", [](Scene& s) { s.camera.target = s.camera.eye; }},
      {"light_direction", [](Scene& s) { s.light_direction = glm::vec3(0.0f); }},
      {"spacing_min", [](Scene& s) { s.spacing_min = 1.0; }},
      {"domain_min", [](Scene& s) { s.domain_min.y = s.domain_max.y; }},
  };
  for (const auto& each : cases) {
    wire::SceneAt<wire::kPlainScene> scene{{test::small_scene(), 0.01}};
    each.damage(scene.packed.scene);
    EXPECT_NE(pack_scene(scene.packed.scene, 0.01, SceneParts::kAll).error().text().find(each.field),
              std::string::npos)
        << each.field;
    Bytes content;
    EXPECT_EQ(wire::encode(scene, content).field, each.field);
    // A Writer mends a normal by itself; the rest is written as it is.
    if (std::string(each.field) != "meshes.normals.normal") {
      EXPECT_NE(package_error(stored(content)), "") << each.field;
    }
  }
}

TEST(ScenePackage, WhatDoesNotFitIsNamedAndNotCut) {
  Scene scene = test::small_scene();
  scene.bodies.resize(wire::kMaxBodies + 1, scene.bodies[1]);
  const Result<Bytes> many = pack_scene(scene, 0.01, SceneParts::kAll);
  ASSERT_FALSE(static_cast<bool>(many));
  EXPECT_NE(many.error().text().find("bodies: 257 entries are too many"), std::string::npos)
      << many.error().text();

  scene = test::small_scene();
  scene.bodies[0].pose.position.x = 1e5;
  EXPECT_FALSE(static_cast<bool>(pack_scene(scene, 0.01, SceneParts::kSeen)));
  EXPECT_FALSE(static_cast<bool>(pack_scene(test::small_scene(), std::nan(""), SceneParts::kAll)));
}

TEST(ScenePackage, AWildNameIsCleaned) {
  Scene scene = test::small_scene();
  scene.bodies[0].name = std::string(1000, 'b') + "\x1b[2J";
  scene.title = "two\nlines";
  const Result<UnpackedScene> back = unpack_scene(packed(scene));
  ASSERT_TRUE(static_cast<bool>(back)) << back.error().text();
  EXPECT_EQ(back.value().scene.bodies[0].name, std::string(wire::kMaxText, 'b'));
  EXPECT_EQ(back.value().scene.title, "two?lines");
}

TEST(ScenePackage, EveryCutAndEveryFlippedBitOfTheCompressedIsStood) {
  const Bytes whole = packed(test::small_scene());
  ASSERT_EQ(whole[1], 1) << "compressed";
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_NE(package_error(ByteView(whole).first(size)), "");
  std::size_t refused = 0;
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    Bytes damaged = whole;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1u << (bit % 8));
    refused += !package_error(damaged).empty();
  }
  EXPECT_GT(refused, whole.size());  // a flipped bit of a position is a position
  Bytes longer = whole;
  longer.push_back(0);
  EXPECT_NE(package_error(longer), "");
}

TEST(ScenePackage, ALyingSizeIsNotBelieved) {
  // A zstd frame of one byte that claims 60 MB.
  const Bytes liar{1, 1, 0x28, 0xb5, 0x2f, 0xfd, 0xa0, 0x00, 0x00, 0xc0, 0x03, 0x03, 0x00, 0x00, 0x00};
  EXPECT_NE(package_error(liar).find("claims to be 62914560 bytes"), std::string::npos)
      << package_error(liar);
  EXPECT_NE(package_error(Bytes{1, 1, 'x', 'y'}).find("does not begin as zstd does"), std::string::npos);
  EXPECT_NE(package_error(Bytes{9, 0}).find("its version is 9"), std::string::npos);
  EXPECT_NE(package_error(Bytes{1, 7}).find("its coding is 7"), std::string::npos);
}

TEST(ScenePackage, WhatPacksTooWellIsStored) {
  Scene scene = test::small_scene();
  TriangleMesh& mesh = scene.meshes[2];
  mesh.triangles.assign(200'000, mesh.triangles[0]);
  const Bytes bytes = packed(scene);
  EXPECT_EQ(bytes[1], 0);
  const Result<UnpackedScene> back = unpack_scene(bytes);
  ASSERT_TRUE(static_cast<bool>(back)) << back.error().text();
  EXPECT_EQ(back.value().scene.meshes[2].triangles.size(), 200'000u);
}

}  // namespace
}  // namespace slosh
