// The shipped scenes: found, closed, sampled, held.
#include <cmath>
#include <cstdlib>
#include <set>

#include "scenes/load.h"
#include "scenes/mesh/tree.h"
#include "scenes/sample.h"
#include "support.h"

namespace slosh {
namespace {

using test::TempFolder;

class ShippedScene : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const auto file = find_scene(GetParam());
    ASSERT_TRUE(file) << file.error().text();
    auto scene = load_scene(file.value());
    ASSERT_TRUE(scene) << scene.error().text();
    scene_ = std::move(scene.value());
  }
  void expect_samples(double spacing) {
    const auto sampled = sample_scene(scene_, spacing);
    ASSERT_TRUE(sampled) << sampled.error().text();
    const SampledScene& s = sampled.value();
    ASSERT_EQ(s.surfaces.size(), scene_.bodies.size());
    ASSERT_EQ(s.distance_fields.size(), scene_.bodies.size());
    EXPECT_EQ(s.spacing, spacing);
    const ParticleEstimate estimate = estimate_particles(scene_, spacing);
    const auto fluid = static_cast<double>(s.fluid_positions.size());
    EXPECT_LT(fluid, 1.05 * estimate.fluid);
    EXPECT_GT(fluid, 0.65 * estimate.fluid);  // the half spacing along round walls stays empty
    for (const glm::vec3& p : s.fluid_positions) {
      ASSERT_TRUE(glm::all(glm::greaterThan(glm::dvec3(p), scene_.domain_min)));
      ASSERT_TRUE(glm::all(glm::lessThan(glm::dvec3(p), scene_.domain_max)));
    }
    for (std::size_t b = 0; b < scene_.bodies.size(); ++b) {
      EXPECT_EQ(s.surfaces[b].positions.size(), s.surfaces[b].normals.size());
      EXPECT_FALSE(s.surfaces[b].positions.empty());
      EXPECT_GT(s.surfaces[b].particle_volume, 0.0f);
      EXPECT_EQ(s.distance_fields[b].size.x == 0, scene_.bodies[b].point_probe);
    }
  }
  Scene scene_;
};

TEST_P(ShippedScene, SamplesAtItsLargestSpacing) {
  expect_samples(scene_.spacing_max);
}

TEST_P(ShippedScene, SamplesFine) {
  expect_samples(std::max(0.008, scene_.spacing_min));
}

// What the walls keep the lattice from goes on top: the fluid's mass is its mesh's, whatever the spacing.
TEST_P(ShippedScene, HoldsTheFluidThatItsMeshSays) {
  for (const double spacing : {scene_.spacing_max, std::max(0.008, scene_.spacing_min)}) {
    const auto sampled = sample_scene(scene_, spacing);
    ASSERT_TRUE(sampled) << sampled.error().text();
    const double wanted = estimate_particles(scene_, spacing).fluid;
    const auto count = static_cast<double>(sampled.value().fluid_positions.size());
    EXPECT_NEAR(count, wanted, 0.03 * wanted) << "spacing " << spacing;
  }
}

TEST_P(ShippedScene, HandsStartAtTheirGripsAndHoldStillForASecond) {
  ASSERT_FALSE(scene_.grips.empty());
  for (const Grip& grip : scene_.grips) {
    ASSERT_GT(grip.hand_motion.size(), 2u) << grip.name;
    const Pose at = compose(scene_.bodies[grip.body].pose, grip.pose);
    for (const PoseKey& key : grip.hand_motion) {
      if (key.time > 1.0) break;
      EXPECT_LT(glm::distance(key.pose.position, at.position), 1e-5) << grip.name << " at " << key.time;
      EXPECT_LT(glm::length(rotation_between(key.pose.orientation, at.orientation)), 1e-4) << grip.name;
    }
    EXPECT_NEAR(grip.hand_motion.back().time, scene_.duration, 1e-3);
  }
}

TEST_P(ShippedScene, HandsMoveSmoothly) {
  for (const Grip& grip : scene_.grips) {
    glm::dvec3 last_velocity(0.0);
    glm::dvec3 last_turning(0.0);
    for (std::size_t i = 1; i < grip.hand_motion.size(); ++i) {
      const PoseKey& a = grip.hand_motion[i - 1];
      const PoseKey& b = grip.hand_motion[i];
      const double dt = b.time - a.time;
      ASSERT_GT(dt, 0.0);
      ASSERT_LE(dt, 1.0 / 60.0 + 1e-4);
      const glm::dvec3 velocity = (b.pose.position - a.pose.position) / dt;
      const glm::dvec3 turning = rotation_between(a.pose.orientation, b.pose.orientation) / dt;
      EXPECT_LT(glm::length(velocity), 1.5) << grip.name << " at " << a.time;
      EXPECT_LT(glm::length(velocity - last_velocity) / dt, 8.0) << grip.name << " at " << a.time;
      EXPECT_LT(glm::length(turning - last_turning) / dt, 85.0) << grip.name << " at " << a.time;
      last_velocity = velocity;
      last_turning = turning;
    }
  }
}

TEST_P(ShippedScene, DomainLeavesRoomRoundEveryBodyThatIsHeld) {
  for (const FluidVolume& volume : scene_.fluid_volumes) {
    for (const glm::vec3& p : scene_.meshes[volume.mesh].positions) {
      const glm::dvec3 w = transform_point(volume.pose, glm::dvec3(p));
      EXPECT_TRUE(glm::all(glm::greaterThan(w - 0.1, scene_.domain_min))) << volume.name;
      EXPECT_TRUE(glm::all(glm::lessThan(w + 0.1, scene_.domain_max))) << volume.name;
    }
  }
}

TEST_P(ShippedScene, GoesThroughGlbUnchanged) {
  // The same maker writes both containers; the reader must not tell them apart.
  const std::string name = GetParam();
  const TempFolder folder;
  make::SceneWriter writer = name == "bucket"   ? make::make_bucket()
                             : name == "spoon"  ? make::make_spoon()
                             : name == "pour"   ? make::make_pour()
                             : name == "spin"   ? make::make_spin()
                             : name == "pool"   ? make::make_pool()
                             : name == "crepe"  ? make::make_crepe()
                             : name == "mixer"  ? make::make_mixer()
                             : name == "vessel" ? make::make_vessel()
                                                : make::make_probe();
  ASSERT_TRUE(writer.write(folder / (name + ".glb")));
  const auto binary = load_scene(folder / (name + ".glb"));
  ASSERT_TRUE(binary) << binary.error().text();
  EXPECT_EQ(binary.value().title, scene_.title);
  ASSERT_EQ(binary.value().meshes.size(), scene_.meshes.size());
  for (std::size_t i = 0; i < scene_.meshes.size(); ++i) {
    EXPECT_EQ(binary.value().meshes[i].positions, scene_.meshes[i].positions);
    EXPECT_EQ(binary.value().meshes[i].triangles, scene_.meshes[i].triangles);
  }
  ASSERT_EQ(binary.value().bodies.size(), scene_.bodies.size());
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
    EXPECT_EQ(binary.value().bodies[i].mass.mass, scene_.bodies[i].mass.mass);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ShippedScene,
                         ::testing::Values("bucket", "spoon", "pour", "spin", "pool", "probe", "crepe",
                                           "mixer", "vessel"),
                         [](const auto& param) { return std::string(param.param); });

TEST(ShippedScenes, AreListedInOrderWithTitles) {
  const std::vector<SceneEntry> entries = shipped_scenes();
  ASSERT_EQ(entries.size(), 9u);
  const char* const names[] = {"bucket", "spoon", "pour",  "spin",  "pool",
                               "probe",  "crepe", "mixer", "vessel"};
  for (std::size_t i = 0; i < entries.size(); ++i) {
    EXPECT_EQ(entries[i].name, names[i]);
    EXPECT_GT(entries[i].title.size(), 10u);
    EXPECT_EQ(entries[i].title.find('\n'), std::string::npos);
  }
}

TEST(ShippedScenes, UnknownNameListsTheKnown) {
  test::expect_error(find_scene("bukket"), {"bukket", "bucket", "probe"});
  test::expect_error(find_scene("missing.gltf"), {"missing.gltf", "no such file"});
}

TEST(ShippedScenes, FolderCanBeChosen) {
  const TempFolder folder;
  ASSERT_TRUE(test::make_cup().write(folder / "cup.gltf"));
  ASSERT_EQ(setenv("SLOSH_SCENES", (folder / "").c_str(), 1), 0);
  const auto entries = shipped_scenes();
  const auto found = find_scene("cup");
  unsetenv("SLOSH_SCENES");
  ASSERT_EQ(entries.size(), 1u);
  EXPECT_EQ(entries[0].title, "a cup");
  EXPECT_TRUE(found);
}

Scene load_shipped(const char* name) {
  return load_scene(find_scene(name).value()).value();
}

TEST(Bucket, WeighsWhatItShouldAndIsHeldByTwo) {
  const Scene scene = load_shipped("bucket");
  ASSERT_EQ(scene.bodies.size(), 2u);
  const Body& bucket = scene.bodies[1];
  EXPECT_EQ(bucket.mass.mass, 0.8);
  EXPECT_LT(std::hypot(bucket.mass.center_of_mass.x, bucket.mass.center_of_mass.z), 1e-6);
  ASSERT_EQ(scene.grips.size(), 2u);
  EXPECT_LT(scene.grips[0].pose.position.x, 0.0);
  EXPECT_GT(scene.grips[1].pose.position.x, 0.0);
  // Both hands turn as one rigid body.
  for (std::size_t i = 0; i < scene.grips[0].hand_motion.size(); ++i) {
    const Pose& left = scene.grips[0].hand_motion[i].pose;
    const Pose& right = scene.grips[1].hand_motion[i].pose;
    const glm::dvec3 way = glm::conjugate(left.orientation) * (right.position - left.position);
    EXPECT_LT(glm::distance(way, scene.grips[1].pose.position - scene.grips[0].pose.position), 1e-5);
  }
}

TEST(Bucket, HandlesAreWatertightAgainstTheInside) {
  // The handles' ends stay inside the wall: no point of the cavity is solid.
  const Scene scene = load_shipped("bucket");
  const mesh::MeshTree tree(scene.meshes[scene.bodies[1].mesh]);
  for (float y = 0.02f; y < 0.17f; y += 0.005f) {
    const float inner = 0.080f + 0.015f * (y - 0.014f) / 0.160f;
    for (int i = 0; i < 72; ++i) {
      const float angle = 0.0872665f * static_cast<float>(i);
      const glm::vec3 p((inner - 0.001f) * std::cos(angle), y, (inner - 0.001f) * std::sin(angle));
      EXPECT_FALSE(tree.inside(p)) << y << " " << i;
    }
  }
}

TEST(Spin, GlassesShareOneMeshAndDifferInViscosity) {
  const Scene scene = load_shipped("spin");
  ASSERT_EQ(scene.bodies.size(), 4u);
  std::set<double> viscosities;
  for (const Body& body : scene.bodies) {
    EXPECT_EQ(body.mesh, scene.bodies[0].mesh);
    EXPECT_LT(body.material.opacity, 0.5f);
    viscosities.insert(body.dynamic_viscosity);
  }
  EXPECT_EQ(viscosities, (std::set<double>{2.0, 10.0, 20.0, 40.0}));
  ASSERT_EQ(scene.fluids.size(), 1u);
  EXPECT_EQ(scene.fluids[0].dynamic_viscosity, 2.0);
}

TEST(Spin, HandsTurnAtOneRoundASecond) {
  const Scene scene = load_shipped("spin");
  double turned = 0.0;
  const auto& keys = scene.grips[0].hand_motion;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const double step = rotation_between(keys[i - 1].pose.orientation, keys[i].pose.orientation).y;
    turned += step;
    const double dt = keys[i].time - keys[i - 1].time;
    if (keys[i - 1].time > 1.7 && keys[i].time < 4.6) {
      EXPECT_NEAR(step / dt, 6.2832, 0.02);
    }
    if (keys[i].time < 1.5 || keys[i - 1].time > 4.81) {
      EXPECT_NEAR(step, 0.0, 1e-5);
    }
  }
  EXPECT_NEAR(turned, 6.2831853 * 3.15, 1e-3);
}

TEST(Probe, IsAPointThatCannotTurn) {
  const Scene scene = load_shipped("probe");
  const Body& probe = scene.bodies[1];
  EXPECT_TRUE(probe.point_probe);
  EXPECT_EQ(probe.motion, BodyMotion::kFree);
  EXPECT_EQ(probe.mass.mass, 0.05);
  EXPECT_EQ(scene.grips[0].rotational_stiffness, 0.0);
}

TEST(Pour, LipStaysOverThePanWhileTheBowlTilts) {
  const Scene scene = load_shipped("pour");
  const Body& bowl = scene.bodies[1];
  const Body& pan = scene.bodies[2];
  const Grip& hold = scene.grips[0];
  for (const PoseKey& key : hold.hand_motion) {
    const Pose pose = compose(key.pose, inverse(hold.pose));
    const glm::dvec3 lip = transform_point(pose, {0.082, 0.089, 0.0});
    EXPECT_LT(std::hypot(lip.x - pan.pose.position.x, lip.z - pan.pose.position.z), 0.05);
    EXPECT_GT(lip.y, pan.pose.position.y + 0.1);
  }
  EXPECT_GT(bowl.pose.position.y, 0.2);
}

/// tinygltf's own writer says that all went well in each of these.
TEST(SceneWriter, SaysWhatCannotBeWritten) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "scene_writer";
  std::filesystem::create_directories(folder);
  for (const char* name : {"probe.gltf", "probe.glb"}) {
    EXPECT_FALSE(make::make_probe().write(folder / "missing" / name)) << "no such folder";
    EXPECT_TRUE(make::make_probe().write(folder / name));
    EXPECT_TRUE(load_scene(folder / name)) << "and what was written is a scene";
  }
  if (std::filesystem::exists("/dev/full")) {
    EXPECT_FALSE(make::make_probe().write("/dev/full")) << "a full disk";
  }
}

}  // namespace
}  // namespace slosh
