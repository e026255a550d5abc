// Light that the fluid's surface focuses on a floor: closed forms.
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/lab/picture/reference/fluid_mesh.h"
#include "tests/lab/picture/reference/focused_light.h"
#include "tests/render/render_test.h"

namespace slosh {
namespace {

using CausticsTest = RenderTest;
constexpr float kCausticSpacing = 0.012f;
constexpr float kWave = 0.24f;   // m, its length along x
constexpr float kDepth = 0.10f;  // m, of the level water

/// Water over a floor at y = 0, looked at and lit straight from above; its surface a wave along x.
struct Waves {
  std::vector<glm::vec3> particles;
  std::vector<std::uint8_t> fluids;
  Frame frame;

  Waves(MeshSink& meshes, float height) {
    const glm::vec3 low(-0.36f, 0.0f, -0.36f);
    const glm::vec3 high(0.36f, 0.2f, 0.36f);
    particles = score::make_fluid(low, high, kCausticSpacing, [&](float x, float) {
      return kDepth - 0.5f * kCausticSpacing + height * std::cos(glm::two_pi<float>() * x / kWave);
    });
    fluids.assign(particles.size(), 0);
    const kit::Shape floor = kit::make_box({-1.0f, -0.02f, -1.0f}, {1.0f, 0.0f, 1.0f});
    frame.meshes = {{meshes.add_mesh(floor.positions, floor.normals, floor.triangles), glm::mat4(1.0f), {}}};
    // A post far aside, so that there is a light's map.
    const kit::Shape post = kit::make_box({0.8f, 0.0f, 0.8f}, {0.82f, 0.1f, 0.82f});
    frame.meshes.push_back(
        {meshes.add_mesh(post.positions, post.normals, post.triangles), glm::mat4(1.0f), {}});
    frame.view.view = glm::lookAt(glm::vec3(0.0f, 2.0f, 0.0f), glm::vec3(0.0f), glm::vec3(0.0f, 0.0f, -1.0f));
    frame.view.projection = glm::perspective(glm::radians(18.0f), 1.0f, 0.02f, 20.0f);
    frame.light_direction = {0.0f, -1.0f, 0.0f};
    frame.particles = particles;
    frame.particle_fluid = fluids;
    frame.fluids = {kit::water()};
    frame.particle_radius = 0.62f * kCausticSpacing;
  }
};

/// Mean ratio of the columns whose floor is at x, over the middle of the picture: (x m, ratio).
std::vector<std::pair<double, double>> across(const FloatImage& ratio, const View& view) {
  std::vector<std::pair<double, double>> columns;
  for (int x = 0; x < ratio.width; ++x) {
    double sum = 0.0;
    int rows = 0;
    for (int y = ratio.height / 4; y < 3 * ratio.height / 4; ++y, ++rows) sum += ratio.at(x, y);
    const double at = (2.0 * (x + 0.5) / ratio.width - 1.0) * 2.0 / view.projection[0][0];
    if (std::abs(at) < 0.2) columns.emplace_back(at, sum / rows);
  }
  return columns;
}

class Focus : public CausticsTest {
 protected:
  std::vector<std::pair<double, double>> ratios(float height) {
    RenderOptions options = small();
    options.width = options.height = 320;
    options.quality = Quality::kFull;
    options.caustics = true;
    auto renderer = make(options);
    const Waves waves(*renderer, height);
    renderer->draw(waves.frame);
    return across(renderer->read_buffer(Buffer::kCaustics), waves.frame.view);
  }
};

TEST_F(Focus, ALevelSurfaceLightsEvenly) {
  const auto flat = ratios(0.0f);
  ASSERT_GT(flat.size(), 50u);
  for (const auto& [x, ratio] : flat) EXPECT_NEAR(ratio, 1.0, 0.1) << x;
}

TEST_F(Focus, AWaveFocusesAsItsCurvatureSays) {
  // Straight light that meets a slope s goes on by (1 − 1/n) s aside of straight down (small slopes), so what
  // falls at x lands at x − h (1 − 1/n) a k sin(k x): under a crest it is 1 / (1 − h/f) as dense, f = 1 / ((1
  // − 1/n) a k²).
  const double k = 2.0 * M_PI / kWave;
  const double height = 0.01;
  const double curved = (1.0 - 1.0 / 1.33) * height * k * k;  // 1/f
  const auto found = ratios(static_cast<float>(height));
  const auto near = [&](double where) {
    double sum = 0.0;
    int count = 0;
    for (const auto& [x, ratio] : found) {
      if (std::abs(std::abs(x) - where) > 0.012) continue;
      sum += ratio;
      ++count;
    }
    return sum / count;
  };
  EXPECT_NEAR(near(0.0), 1.0 / (1.0 - (kDepth + height) * curved), 0.06) << "below a crest";
  EXPECT_NEAR(near(0.5 * kWave), 1.0 / (1.0 + (kDepth - height) * curved), 0.06) << "below a trough";
}

/// Light on the floor by photons through the surface that the path tracer makes of the particles.
struct Photons {
  explicit Photons(float height) : meshes(), waves(meshes, height) {
    reference::FocusedLight::Source source;
    for (reference::FluidMesh& fluid : reference::mesh_fluids(waves.frame)) {
      for (const glm::vec3& p : fluid.positions) source.fluids.add(p);
      scene.add({std::move(fluid.positions), std::move(fluid.normals), std::move(fluid.triangles), {}},
                glm::mat4(1.0f), nullptr, 0);
    }
    // Below the lower side of that surface, which is the floor of the particles.
    const kit::Shape floor = kit::make_box({-1.0f, -0.03f, -1.0f}, {1.0f, -0.01f, 1.0f});
    scene.add({floor.positions, floor.normals, floor.triangles, {}}, glm::mat4(1.0f), &look, -1);
    scene.finish();
    source.photons = 2'000'000;
    source.threads = 2;
    source.arriving = [](const glm::vec3&) { return glm::vec3(1.0f); };
    light = {scene, waves.frame.fluids, {}, source};
  }
  double at(double x) const {
    double sum = 0.0;
    for (int i = -40; i <= 40; ++i)
      sum += light.at({static_cast<float>(x), -0.01f, 0.004f * static_cast<float>(i)}, {0.0f, 1.0f, 0.0f}).y /
             81.0;
    return sum;
  }

  struct NoMeshes : MeshSink {
    MeshHandle add_mesh(std::span<const glm::vec3>, std::span<const glm::vec3>, std::span<const glm::uvec3>,
                        std::span<const glm::vec2>) override {
      return 0;
    }
    void remove_mesh(MeshHandle) override {}
    TextureHandle add_texture(const TextureImage&) override { return kNoTexture; }
  } meshes;
  Waves waves;
  MeshLook look;
  reference::RayScene scene;
  reference::FocusedLight light;
};

TEST_F(Focus, OfThePictureIsNearThatOfPhotons) {
  if (const auto there = reference::RayScene::available(); !there) GTEST_SKIP() << there.error().text();
  const Photons wave(0.01f);
  const Photons level(0.0f);
  const auto found = ratios(0.01f);
  // Columns alone differ by the ripples, as wide as particles, that both surfaces have: strips of four of
  // them.
  for (int at = -3; at <= 3; ++at) {
    const double strip = 0.048 * at;
    double drawn = 0.0, traced = 0.0;
    int count = 0;
    for (const auto& [x, ratio] : found) {
      if (std::abs(x - strip) > 0.024) continue;
      drawn += ratio;
      traced += wave.at(x) / level.at(x);
      ++count;
    }
    std::printf("%+.3f m: %.3f in the picture, %.3f by photons\n", strip, drawn / count, traced / count);
    EXPECT_NEAR(drawn / count, traced / count, 0.1) << strip;
  }
}

TEST_F(Focus, IsOfFullQualityAloneAndOnlyWhereAskedFor) {
  RenderOptions options = small();
  for (const auto& [quality, wanted] : {std::pair(Quality::kFast, true), {Quality::kFull, false}}) {
    options.quality = quality;
    options.caustics = wanted;
    auto renderer = make(options);
    renderer->set_timing(true);
    const Waves waves(*renderer, 0.003f);
    renderer->draw(waves.frame);
    EXPECT_EQ(std::ranges::count(renderer->pass_times(), std::string("caustics"), &PassTime::pass), 0);
  }
}

}  // namespace
}  // namespace slosh
