// The path tracer and the fluid's surface of triangles: known answers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/passes/frame_block.h"
#include "render/renderer.h"
#include "render/shader_math.h"
#include "tests/lab/picture/reference/fluid_mesh.h"
#include "tests/lab/picture/reference/focused_light.h"
#include "tests/lab/picture/reference/path_tracer.h"
#include "tests/render/scene_kit.h"

namespace slosh {
namespace {

Frame frame_of(const std::vector<glm::vec3>& points, const std::vector<std::uint8_t>& fluids, float radius,
               int width, int height) {
  Frame frame;
  frame.view = kit::make_view({0.0f, 0.0f, 1.0f}, glm::vec3(0.0f), width, height);
  frame.particles = points;
  frame.particle_fluid = fluids;
  frame.fluids = {kit::water()};
  frame.particle_radius = radius;
  return frame;
}

double volume(const reference::FluidMesh& mesh) {
  double sum = 0.0;
  for (const glm::uvec3& t : mesh.triangles)
    sum += glm::dot(glm::dvec3(mesh.positions[t.x]),
                    glm::cross(glm::dvec3(mesh.positions[t.y]), glm::dvec3(mesh.positions[t.z]))) /
           6.0;
  return sum;
}

TEST(FluidMesh, AParticleAloneIsABallOfItsVolume) {
  const std::vector<glm::vec3> points{{0.3f, -0.2f, 0.1f}};
  const std::vector<std::uint8_t> fluids{0};
  const auto meshes = reference::mesh_fluids(frame_of(points, fluids, 0.01f, 64, 48), 0.2f);
  ASSERT_EQ(meshes.size(), 1u);
  const double ball = 4.0 / 3.0 * M_PI * 1e-6;
  EXPECT_NEAR(volume(meshes[0]), ball, 0.1 * ball) << "and it is turned outward";
  for (std::size_t i = 0; i < meshes[0].positions.size(); ++i)
    EXPECT_GT(glm::dot(meshes[0].normals[i], meshes[0].positions[i] - points[0]), 0.0f);
}

TEST(FluidMesh, AFullBoxHasItsVolumeAndEachFluidItsMesh) {
  auto points = kit::jitter_lattice(glm::vec3(0.0f), {0.2f, 0.1f, 0.2f}, 0.01f, 3);
  kit::relax(points, 0.01f, glm::vec3(0.005f), {0.195f, 0.095f, 0.195f}, 8);
  std::vector<std::uint8_t> fluids(points.size(), 0);
  points.emplace_back(0.5f, 0.0f, 0.0f);
  fluids.push_back(1);
  points.emplace_back(NAN, 0.0f, 0.0f);
  fluids.push_back(1);
  Frame frame = frame_of(points, fluids, 0.0062f, 64, 48);
  frame.fluids = {kit::water(), kit::batter()};
  const auto meshes = reference::mesh_fluids(frame);
  ASSERT_EQ(meshes.size(), 2u);
  EXPECT_NEAR(volume(meshes[0]), 0.004, 0.0004);
  EXPECT_EQ(meshes[1].fluid, 1u);
}

class PathTracing : public ::testing::Test {
 protected:
  void SetUp() override {
    auto made = reference::PathTracer::create();
    if (!made) GTEST_SKIP() << made.error().text();
    tracer_ = std::move(made.value());
  }
  reference::Options small(int samples) {
    reference::Options options;
    options.width = 24;
    options.height = 18;
    options.samples = samples;
    return options;
  }
  std::unique_ptr<reference::PathTracer> tracer_;
};

TEST_F(PathTracing, ABallIsSeenFirstAsLargeAndAsRoundAsItIs) {
  constexpr int kSide = 200;
  constexpr float kRadius = 0.1f;
  const std::vector<glm::vec3> points{{0.0f, 0.0f, 0.0f}};
  const std::vector<std::uint8_t> fluids{0};
  const Frame frame = frame_of(points, fluids, kRadius, kSide, kSide);
  reference::Options options;
  options.width = options.height = kSide;
  options.cell = 0.1f;
  const score::Exact seen = tracer_->first_seen(frame, options);
  // The eye is 1 m away: the outline is that of the cone that touches the ball.
  const float touches = kRadius / std::sqrt(1.0f - kRadius * kRadius);
  const float radius = 0.5f * kSide * frame.view.projection[1][1] * touches;
  const auto pixels =
      std::ranges::count_if(seen.depth.values, [](float d) { return d < 0.5f * kNoFluidDepth; });
  EXPECT_NEAR(static_cast<double>(pixels), M_PI * radius * radius, 0.05 * M_PI * radius * radius);
  EXPECT_NEAR(seen.depth.at(kSide / 2, kSide / 2), 1.0f - kRadius, 0.004f);
  EXPECT_GT(seen.normal.at(kSide / 2, kSide / 2, 2), 0.99f);
  const int right = kSide / 2 + static_cast<int>(0.8f * radius);
  EXPECT_NEAR(seen.normal.at(right, kSide / 2, 0), 0.8f, 0.06f);
}

TEST_F(PathTracing, AnEmptyFrameIsTheRoom) {
  Frame frame = frame_of({}, {}, 0.01f, 24, 18);
  const FloatImage image = tracer_->draw(frame, small(64));
  const Studio studio;
  const shader::Room room{studio.sky, studio.horizon, studio.ground, studio.softbox,
                          direction_to_light(frame)};
  const glm::vec3 ahead = shader::room_radiance(room, {0.0f, 0.0f, -1.0f});
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.at(12, 9, c), ahead[c], 0.03f);
}

TEST_F(PathTracing, AWallIsLitByTheKeyAndTheRoomByItsColour) {
  Frame frame = frame_of({}, {}, 0.01f, 24, 18);
  frame.light_direction = {0.0f, 0.0f, -1.0f};
  const kit::Shape box = kit::make_box({-2.0f, -2.0f, -0.3f}, {2.0f, 2.0f, 0.0f});
  MeshLook look;
  look.roughness = 1.0f;
  look.base_color = glm::vec3(0.4f);
  frame.meshes = {{tracer_->add_mesh(box.positions, box.normals, box.triangles), glm::mat4(1.0f), look}};
  const float lit = tracer_->draw(frame, small(256)).at(12, 9, 1);
  frame.light_direction = {0.0f, 0.0f, 1.0f};
  const float shaded = tracer_->draw(frame, small(256)).at(12, 9, 1);
  const float expected = Studio{}.key_light.y * 0.4f / 3.14159265f;
  EXPECT_NEAR(lit - shaded, expected, 0.12f * expected) << "Lambert's law, and a little sheen";
  EXPECT_GT(shaded, 0.1f);
}

TEST_F(PathTracing, ClearFluidTakesLightByItsThickness) {
  // A slab of fluid that does not refract, before the room: Beer and Lambert's law and nothing else.
  auto points = kit::jitter_lattice({-0.4f, -0.3f, -0.05f}, {0.4f, 0.3f, 0.05f}, 0.01f, 3);
  kit::relax(points, 0.01f, {-0.4f, -0.3f, -0.045f}, {0.4f, 0.3f, 0.045f}, 8);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  Frame frame = frame_of(points, fluids, 0.0062f, 24, 18);
  frame.fluids[0].refraction = 1.0f;
  frame.fluids[0].scattering = 0.0f;
  frame.fluids[0].extinction = {10.0f, 5.0f, 0.0f};
  const FloatImage image = tracer_->draw(frame, small(64));
  const Frame bare = frame_of({}, {}, 0.01f, 24, 18);
  const FloatImage room = tracer_->draw(bare, small(64));
  for (int c = 0; c < 3; ++c) {
    const float through = std::exp(-0.1f * frame.fluids[0].extinction[c]);
    EXPECT_NEAR(image.at(12, 9, c) / room.at(12, 9, c), through, 0.08f) << c;
  }
}

TEST_F(PathTracing, ACloudyFluidsDeepLayerGivesItsColourBack) {
  // A wall of milk that mirrors nothing, lit by the key alone in front: F_c of it comes back.
  auto points = kit::jitter_lattice({-0.5f, -0.4f, -0.1f}, {0.5f, 0.4f, 0.0f}, 0.02f, 3);
  kit::relax(points, 0.02f, {-0.5f, -0.4f, -0.1f}, {0.5f, 0.4f, -0.01f}, 8);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  Frame frame = frame_of(points, fluids, 0.0124f, 24, 18);
  frame.fluids[0] = kit::batter();
  frame.fluids[0].gloss = 0.0f;
  frame.fluids[0].refraction = 1.0f;
  frame.fluids[0].color = glm::vec3(0.8f);
  frame.fluids[0].extinction = glm::vec3(800.0f);
  frame.light_direction = {0.0f, 0.0f, -1.0f};
  const auto mean = [&] {
    const FloatImage image = tracer_->draw(frame, small(96));
    double sum = 0.0;
    for (int y = 5; y < 13; ++y) {
      for (int x = 6; x < 18; ++x) sum += image.at(x, y, 1) / 96.0;
    }
    return sum;
  };
  const double lit = mean();
  frame.light_direction = {0.0f, 0.0f, 1.0f};
  const double expected = Studio{}.key_light.y * 0.8 / M_PI;
  EXPECT_NEAR(lit - mean(), expected, 0.2 * expected);
}

/// Water 0.1 m deep over a floor, 0.48 m square, its surface a · cos(k x); and the photons that come through.
class PhotonsThroughAWave : public PathTracing {
 protected:
  static constexpr float kLength = 0.24f, kDepth = 0.1f, kHalf = 0.24f;
  static constexpr float kIndex = 1.33f;
  static constexpr double kNumber = 2.0 * M_PI / kLength;  // 1/m

  reference::FocusedLight through(float height, const glm::vec3& to_light, int photons) {
    constexpr int kSteps = 480;
    reference::Triangles water;
    for (int row = 0; row < 2; ++row) {
      for (int i = 0; i <= kSteps; ++i) {
        const float x = kHalf * (2.0f * static_cast<float>(i) / kSteps - 1.0f);
        const auto k = static_cast<float>(kNumber);
        water.positions.emplace_back(x, kDepth + height * std::cos(k * x), row == 0 ? -kHalf : kHalf);
        water.normals.push_back(glm::normalize(glm::vec3(height * k * std::sin(k * x), 1.0f, 0.0f)));
        const auto a = static_cast<std::uint32_t>(i), b = static_cast<std::uint32_t>(kSteps + 1 + i);
        if (row == 0 && i < kSteps)
          water.triangles.insert(water.triangles.end(), {{a, b, a + 1}, {a + 1, b, b + 1}});
      }
    }
    const kit::Shape ground = kit::make_box({-1.0f, -0.02f, -1.0f}, {1.0f, 0.0f, 1.0f});
    scene_ = std::make_unique<reference::RayScene>();
    scene_->add(water, glm::mat4(1.0f), nullptr, 0);
    scene_->add({ground.positions, ground.normals, ground.triangles, {}}, glm::mat4(1.0f), &look_, -1);
    scene_->finish();
    looks_ = {kit::water()};
    looks_[0].refraction = kIndex;
    looks_[0].extinction = glm::vec3(1.0f, 2.0f, 0.0f);
    reference::FocusedLight::Source source;
    source.to_light = to_light;
    for (const glm::vec3& p : water.positions) source.fluids.add(p);
    source.photons = photons;
    source.threads = 2;
    source.arriving = [](const glm::vec3&) { return glm::vec3(1.0f); };
    return {*scene_, looks_, {}, source};
  }
  /// What falls on the floor, on the mean over a strip along z at x.
  static glm::dvec3 falls(const reference::FocusedLight& light, float x) {
    glm::dvec3 sum(0.0);
    for (int i = -20; i <= 20; ++i)
      sum += light.at({x, 0.0f, 0.004f * static_cast<float>(i)}, {0.0f, 1.0f, 0.0f});
    return sum / 41.0;
  }

 private:
  MeshLook look_;
  std::vector<FluidLook> looks_;
  std::unique_ptr<reference::RayScene> scene_;
};

TEST_F(PhotonsThroughAWave, LevelWaterTakesFresnelsAndBeersShare) {
  const double slant = 0.5;  // radians off the vertical
  const auto light = through(0.0f, {0.0f, std::cos(slant), std::sin(slant)}, 1'000'000);
  const double inside = std::asin(std::sin(slant) / kIndex);
  const double s = std::pow(std::sin(slant - inside) / std::sin(slant + inside), 2.0);
  const double p = std::pow(std::tan(slant - inside) / std::tan(slant + inside), 2.0);
  for (int c = 0; c < 3; ++c) {
    const double taken = std::array{1.0, 2.0, 0.0}[static_cast<std::size_t>(c)] * kDepth / std::cos(inside);
    const double expected = std::cos(slant) * (1.0 - 0.5 * (s + p)) * std::exp(-taken);
    EXPECT_NEAR(falls(light, 0.0f)[c], expected, 0.01 * expected) << c;
  }
}

TEST_F(PhotonsThroughAWave, CrestsGatherAndTroughsSpreadAsCurvatureSays) {
  const double height = 0.01;
  const auto level = through(0.0f, {0.0f, 1.0f, 0.0f}, 1'000'000);
  const double plain = falls(level, 0.0f).z;
  const auto wave = through(static_cast<float>(height), {0.0f, 1.0f, 0.0f}, 4'000'000);
  const double curved = (1.0 - 1.0 / kIndex) * height * kNumber * kNumber;  // 1/f
  const double crest = 1.0 / (1.0 - (kDepth + height) * curved);
  const double trough = 1.0 / (1.0 + (kDepth - height) * curved);
  EXPECT_NEAR(falls(wave, 0.0f).z / plain, crest, 0.02 * crest);
  EXPECT_NEAR(falls(wave, 0.5f * kLength).z / plain, trough, 0.02 * trough);
}

TEST_F(PhotonsThroughAWave, SlantingLightIsGatheredAcrossItsPlaneByCoddingtonsEquation) {
  // Light whose plane of incidence lies along the crests: n/s' = (n cos t' − cos t) / R, s' along the ray.
  const double height = 0.006;
  const double slant = 0.6;
  const double inside = std::asin(std::sin(slant) / kIndex);
  const glm::vec3 to_light(0.0f, std::cos(slant), std::sin(slant));
  const auto wave = through(static_cast<float>(height), to_light, 4'000'000);
  const auto level = through(0.0f, to_light, 1'000'000);
  const double power = (kIndex * std::cos(inside) - std::cos(slant)) * height * kNumber * kNumber / kIndex;
  const double crest = 1.0 / (1.0 - (kDepth + height) / std::cos(inside) * power);
  EXPECT_NEAR(falls(wave, 0.0f).z / falls(level, 0.0f).z, crest, 0.02 * crest);
}

TEST_F(PathTracing, WithPhotonsALevelPoolsFloorIsAsBrightAsStraightLightMakesIt) {
  auto points = kit::jitter_lattice({-0.4f, -0.1f, -0.4f}, {0.4f, 0.0f, 0.4f}, 0.02f, 3);
  kit::relax(points, 0.02f, {-0.4f, -0.09f, -0.4f}, {0.4f, -0.01f, 0.4f}, 8);
  const std::vector<std::uint8_t> fluids(points.size(), 0);
  Frame frame = frame_of(points, fluids, 0.0124f, 24, 18);
  frame.view = kit::make_view({0.0f, 1.0f, 0.2f}, {0.0f, -0.1f, 0.0f}, 24, 18);
  frame.light_direction = {0.0f, -1.0f, 0.0f};
  const kit::Shape ground = kit::make_box({-1.0f, -0.12f, -1.0f}, {1.0f, -0.105f, 1.0f});
  frame.meshes = {
      {tracer_->add_mesh(ground.positions, ground.normals, ground.triangles), glm::mat4(1.0f), {}}};
  const auto mean = [&](int photons) {
    reference::Options options = small(48);
    options.photons = photons;
    options.threads = 2;
    const FloatImage image = tracer_->draw(frame, options);
    double sum = 0.0;
    for (int y = 6; y < 12; ++y) {
      for (int x = 8; x < 16; ++x) sum += image.at(x, y, 1) / 48.0;
    }
    return sum;
  };
  const double straight = mean(0);
  EXPECT_NEAR(mean(400'000), straight, 0.06 * straight) << "gathered or not, it is the same light";
}

TEST_F(PathTracing, TheSameAgainIsTheSame) {
  Frame frame = frame_of({}, {}, 0.01f, 24, 18);
  reference::Options options = small(4);
  const FloatImage once = tracer_->draw(frame, options);
  options.threads = 2;
  EXPECT_EQ(tracer_->draw(frame, options).values, once.values);
}

}  // namespace
}  // namespace slosh
