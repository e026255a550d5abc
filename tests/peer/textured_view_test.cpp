// A textured scene all the way: written by our own program, read from its file, sent to a peer, drawn.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>

#include "net/wire/scene_package.h"
#include "peer/view/frame_builder.h"
#include "scenes/load.h"
#include "scenes/make/solid.h"
#include "scenes/make/writer.h"
#include "tests/scenes/images_kit.h"
#include "tests/support/places.h"

namespace slosh {
namespace {

constexpr int kSide = 240;  // pixels
constexpr int kFields = 4;  // of the checker, a side

float from_srgb(int byte) {
  const float v = static_cast<float>(byte) / 255.0f;
  return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

/// A colour of its own a field.
glm::ivec3 field(int x, int y) {
  return {60 + 60 * x, 240 - 50 * y, (x + y) % 2 ? 200 : 30};
}

test::Bytes checker() {
  test::Bytes pixels;
  for (int y = 0; y < 8 * kFields; ++y)
    for (int x = 0; x < 8 * kFields; ++x) {
      const glm::ivec3 c = field(x / 8, y / 8);
      for (int k = 0; k < 3; ++k) pixels.push_back(static_cast<std::uint8_t>(c[k]));
      pixels.push_back(255);
    }
  return test::png(8 * kFields, 8 * kFields, pixels);
}

/// A plate of 0.4 × 0.4 m that lies on y = 0, seen straight from above; texture u along x, v along z.
std::filesystem::path write_plate(bool bumps) {
  make::SceneWriter writer(nlohmann::json{{"title", "a plate"}});
  make::Paint paint;
  paint.color = {1.0, 1.0, 1.0, 1.0};
  paint.base_color_map = {writer.add_image("checker", checker()), {}};
  // Tilted by 0.6 against u, as (−0.6, 0, 0.8).
  const test::Bytes one = {51, 128, 230, 255};
  const int image = writer.add_image("bumps", test::png(1, 1, one));
  if (bumps) paint.normal_map.image = image;
  TriangleMesh plate = make::with_normals(make::box({-0.2, -0.02, -0.2}, {0.2, 0.0, 0.2}));
  for (const glm::vec3& p : plate.positions)
    plate.texcoords.emplace_back(p.x / 0.4f + 0.5f, p.z / 0.4f + 0.5f);
  const int material = writer.add_material("checker", paint);
  writer.add_node("plate", writer.add_mesh("plate", plate, material), {}, {{"slosh", "body"}});
  const auto folder = test::build_dir() / "textured";
  std::filesystem::create_directories(folder);
  const auto file = folder / (bumps ? "bumps.glb" : "plate.glb");
  EXPECT_TRUE(writer.write(file));
  return file;
}

class TexturedView : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    HeadlessOptions options;
    options.software_threads = 2;
    auto made = make_headless_context(options);
    ASSERT_TRUE(made) << made.error().text();
    context_ = std::move(made.value());
  }
  static void TearDownTestSuite() { context_.reset(); }

  static FloatImage draw(const Scene& scene) {
    RenderOptions options;
    options.width = options.height = kSide;
    options.shadow_size = 0;
    options.ambient_occlusion = false;
    auto renderer = Renderer::create(*context_, options);
    EXPECT_TRUE(renderer) << renderer.error().text();
    FrameBuilder builder(scene, 0.01, *renderer.value());
    EXPECT_TRUE(builder.left_out().empty()) << builder.left_out()[0].text();
    Snapshot snapshot;
    Frame frame = builder.build(snapshot, 1.0);
    frame.light_direction = {0.3f, -1.0f, 0.1f};
    frame.view.view = glm::lookAt(glm::vec3(0, 1, 0), glm::vec3(0), glm::vec3(0, 0, -1));
    const float half = std::atan(0.2f);  // the plate fills the picture
    frame.view.projection = glm::perspective(2.0f * half, 1.0f, frame.view.near_plane, frame.view.far_plane);
    renderer.value()->draw(frame);
    return renderer.value()->read_buffer(Buffer::kFinalColor);
  }
  static Scene plain(Scene scene, float base) {
    scene.bodies[0].material.maps.base_color.image = -1;
    scene.bodies[0].material.base_color = glm::vec3(base);
    return scene;
  }

  static inline std::unique_ptr<Context> context_;
};

TEST_F(TexturedView, EachFieldOfACheckerHasItsColourHereAndAtAPeer) {
  const Result<Scene> read = load_scene(write_plate(false));
  ASSERT_TRUE(read) << read.error().text();
  const Scene& scene = read.value();
  ASSERT_TRUE(scene.left_out.empty()) << scene.left_out[0].text();
  const FloatImage image = draw(scene);
  const FloatImage black = draw(plain(scene, 0.0f)), white = draw(plain(scene, 1.0f));
  for (int y = 0; y < kFields; ++y)
    for (int x = 0; x < kFields; ++x) {
      const int px = (2 * x + 1) * kSide / (2 * kFields), py = (2 * y + 1) * kSide / (2 * kFields);
      for (int c = 0; c < 3; ++c) {
        const float share =
            (image.at(px, py, c) - black.at(px, py, c)) / (white.at(px, py, c) - black.at(px, py, c));
        EXPECT_NEAR(share, from_srgb(field(x, y)[c]), 4e-3f)
            << "field " << x << ", " << y << " channel " << c;
      }
    }
  const Result<wire::Bytes> package = pack_scene(scene, 0.01, SceneParts::kSeen);
  ASSERT_TRUE(package) << package.error().text();
  const Result<UnpackedScene> there = unpack_scene(package.value());
  ASSERT_TRUE(there) << there.error().text();
  EXPECT_EQ(draw(there.value().scene).values, image.values);
}

TEST_F(TexturedView, ANormalMapLightsThePlateAsIfItWereTilted) {
  const Result<Scene> read = load_scene(write_plate(true));
  ASSERT_TRUE(read) << read.error().text();
  const FloatImage mapped = draw(read.value());
  // The same plate with vertices that have the map's normal: u is x, v is z, so the map's y is −z.
  Scene tilted = read.value();
  tilted.bodies[0].material.maps.normal.image = -1;
  const FloatImage flat = draw(tilted);
  const glm::vec3 texel = glm::vec3(51.0f, 128.0f, 230.0f) / 127.5f - 1.0f;
  for (glm::vec3& n : tilted.meshes[0].normals) n = glm::normalize(glm::vec3(texel.x, texel.z, -texel.y));
  const FloatImage turned = draw(tilted);
  double flat_off = 0.0;
  for (int y = 10; y < kSide - 10; y += 7)
    for (int x = 10; x < kSide - 10; x += 7)
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(mapped.at(x, y, c), turned.at(x, y, c), 0.01f) << x << ", " << y;
        flat_off = std::max(flat_off, std::abs(static_cast<double>(flat.at(x, y, c) - turned.at(x, y, c))));
      }
  EXPECT_GT(flat_off, 0.05) << "it makes a difference";
}

TEST_F(TexturedView, AnImageThatIsDamagedOnTheWayIsToldAndTheRestIsShown) {
  Result<Scene> read = load_scene(write_plate(false));
  ASSERT_TRUE(read) << read.error().text();
  Scene scene = std::move(read.value());
  scene.images[0].bytes.resize(60);
  scene.images[0].name = "checker\x1b[2J";
  auto renderer = Renderer::create(*context_, {});
  ASSERT_TRUE(renderer) << renderer.error().text();
  const FrameBuilder builder(scene, 0.01, *renderer.value());
  ASSERT_EQ(builder.left_out().size(), 1u);
  const std::string text = builder.left_out()[0].text();
  EXPECT_NE(text.find("is a PNG that cannot be read"), std::string::npos) << text;
  EXPECT_EQ(text.find('\x1b'), std::string::npos) << text;
}

}  // namespace
}  // namespace slosh
