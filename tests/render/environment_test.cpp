// Rooms that light a scene: files of them, what is made of them, and pictures under them.
#include "render/environment.h"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <glm/gtc/constants.hpp>

#include "render/passes/frame_block.h"
#include "render/shader_math.h"
#include "tests/render/render_test.h"

namespace slosh {
namespace {

class EnvironmentFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("slosh_room_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& bytes) {
    const auto file = folder_ / "room.hdr";
    std::ofstream(file, std::ios::binary) << bytes;
    return file;
  }
  static std::string head(int width, int height) {
    return "#?RADIANCE\n# made by a test\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
           std::to_string(width) + "\n";
  }
  /// Upper half white, lower half red, rows packed as Radiance packs them: each channel by itself, one run,
  /// one literal.
  static std::string two_halves(int width, int height) {
    std::string bytes = head(width, height);
    for (int y = 0; y < height; ++y) {
      bytes += {2, 2, static_cast<char>(width >> 8), static_cast<char>(width & 255)};
      for (int channel = 0; channel < 4; ++channel) {
        const char value = channel == 3 ? char(129) : channel == 0 || y < height / 2 ? char(128) : char(0);
        bytes += {char(128 + 8), value, static_cast<char>(width - 8)};
        bytes.append(static_cast<std::size_t>(width - 8), value);
      }
    }
    return bytes;
  }
  std::filesystem::path folder_;
};

TEST_F(EnvironmentFile, IsReadAndExposed) {
  const auto read = read_environment(write(two_halves(64, 32)));
  ASSERT_TRUE(read) << read.error().text();
  const Environment& room = *read.value();
  EXPECT_EQ(room.width, 64);
  EXPECT_EQ(room.height, 32);
  const glm::vec3 above = room.from({0.0f, 1.0f, 0.0f});
  const glm::vec3 below = room.from(glm::normalize(glm::vec3(0.3f, -1.0f, 0.2f)));
  EXPECT_NEAR(above.y, above.x, 1e-5f);
  EXPECT_NEAR(below.x, above.x, 1e-5f);
  EXPECT_EQ(below.y, 0.0f);
  // As bright as the studio in the mean, whatever the file's unit was.
  const auto studio = make_studio_environment();
  const auto brightness = [](const glm::vec3& c) {
    return glm::dot(c, glm::vec3(0.2126f, 0.7152f, 0.0722f));
  };
  EXPECT_NEAR(brightness(room.mean()), brightness(studio->mean()), 1e-3f);
}

TEST_F(EnvironmentFile, AWideOneIsAveragedDown) {
  const auto read = read_environment(write(two_halves(120, 60)));
  ASSERT_TRUE(read) << read.error().text();
  const std::string wide = two_halves(3000, 2);  // rows of 2048 and more pixels are packed alike
  EXPECT_FALSE(read_environment(write(wide))) << "a run of 3000 cannot be one byte";
}

TEST_F(EnvironmentFile, WhatIsWrongIsSaid) {
  const auto said = [&](const std::string& bytes) {
    const auto read = read_environment(write(bytes));
    return read ? std::string("nothing") : read.error().text();
  };
  const auto missing = read_environment(folder_ / "no.hdr");
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().text().find("no such file"), std::string::npos);
  EXPECT_NE(said("").find("no Radiance picture"), std::string::npos);
  EXPECT_NE(said("\x89PNG\r\n").find("no Radiance picture"), std::string::npos);
  EXPECT_NE(said("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 2 +X 4\n").find("format"), std::string::npos);
  EXPECT_NE(said("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+X 4 -Y 2\n").find("size"), std::string::npos);
  EXPECT_NE(said(head(30000, 30000)).find("30000 x 30000"), std::string::npos);
  EXPECT_NE(said(head(99999999, 99999999)).find("99999999"), std::string::npos);
  const std::string whole = two_halves(64, 32);
  EXPECT_EQ(said(whole), "nothing");
  for (std::size_t length = head(64, 32).size(); length < whole.size(); length += 997)
    EXPECT_NE(said(whole.substr(0, length)).find("cut off in row"), std::string::npos) << length;
  std::string damaged = whole;
  damaged[head(64, 32).size() + 4] = char(255);  // a run over the row's end
  EXPECT_NE(said(damaged).find("damaged"), std::string::npos);
  // Any bytes at all: a sentence, never more.
  for (int seed = 1; seed < 200; ++seed) {
    std::string noise = whole;
    for (int k = 0; k < 6; ++k)
      noise[static_cast<std::size_t>(seed * 7919 + k * 104729) % noise.size()] ^= char(seed + k);
    (void)said(noise);
  }
}

TEST(LightProbe, AnEvenRoomIsEven) {
  const Environment room{32, 16, std::vector<glm::vec3>(32 * 16, glm::vec3(0.4f, 0.5f, 0.6f))};
  const LightProbe probe = make_light_probe(room);
  ASSERT_EQ(probe.blurred.size(), std::size_t{5 * 48 * 48});
  for (const std::vector<glm::vec3>& texels : {probe.sharp, probe.blurred})
    for (const glm::vec3& light : texels) ASSERT_NEAR(light.y, 0.5f, 1e-4f);
  EXPECT_NEAR(probe.diffuse[0].y * 0.282095f, 0.5f, 2e-3f);
  for (std::size_t k = 1; k < 9; ++k) EXPECT_NEAR(probe.diffuse[k].y, 0.0f, 5e-3f) << k;
}

/// Irradiance / π on a surface of this normal, summed over directions of one solid angle each.
template <class Radiance>
glm::dvec3 integral(const glm::vec3& normal, Radiance radiance) {
  glm::dvec3 sum(0.0);
  constexpr int kRows = 128;
  for (int y = 0; y < kRows; ++y) {
    const double up = 1.0 - 2.0 * (y + 0.5) / kRows;  // rows of one area each
    for (int x = 0; x < 2 * kRows; ++x) {
      const double round = glm::pi<double>() * (x + 0.5) / kRows;
      const double level = std::sqrt(1.0 - up * up);
      const glm::vec3 way(level * std::sin(round), up, -level * std::cos(round));
      sum += static_cast<double>(std::max(glm::dot(way, normal), 0.0f)) * glm::dvec3(radiance(way));
    }
  }
  return sum * (4.0 / (2.0 * kRows * kRows));
}

TEST(Room, ItsAmbientLightIsTheIntegral) {
  const Studio studio;
  const shader::Room room{studio.sky, studio.horizon, studio.ground, studio.softbox, {0.0f, 1.0f, 0.0f}};
  for (int k = 0; k < 200; ++k) {
    const glm::vec3 normal =
        glm::normalize(glm::vec3(std::sin(1.7f * k), std::cos(2.3f * k), std::sin(0.9f * k + 1.0f)));
    const glm::dvec3 right =
        integral(normal, [&](const glm::vec3& way) { return shader::room_radiance(room, way); });
    const glm::vec3 fitted = shader::room_ambient(room, normal);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(fitted[c], right[c], 0.1 * right[c]) << k << " channel " << c;
  }
}

TEST(LightProbe, DiffuseLightIsTheIntegral) {
  const auto room = make_studio_environment();
  const LightProbe probe = make_light_probe(*room);
  for (const glm::vec3 normal : {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1, 0, 0),
                                 glm::vec3(0, 0, -1), glm::normalize(glm::vec3(1, 1, 1))}) {
    const glm::dvec3 sum = integral(normal, [&](const glm::vec3& way) { return room->from(way); });
    const float b[9] = {0.282095f,
                        0.488603f * normal.y,
                        0.488603f * normal.z,
                        0.488603f * normal.x,
                        1.092548f * normal.x * normal.y,
                        1.092548f * normal.y * normal.z,
                        0.315392f * (3 * normal.z * normal.z - 1),
                        1.092548f * normal.x * normal.z,
                        0.546274f * (normal.x * normal.x - normal.y * normal.y)};
    glm::vec3 found(0.0f);
    for (std::size_t k = 0; k < 9; ++k) found += probe.diffuse[k] * b[k];
    // Three bands leave some 3 % of a lit half (Ramamoorthi & Hanrahan 2001); soft boxes are sharper.
    EXPECT_NEAR(found.y, sum.y, 0.08 * sum.y) << normal.x << " " << normal.y << " " << normal.z;
  }
}

TEST(Octahedral, DirectionsComeBack) {
  for (int i = 0; i < 500; ++i) {
    const float up = 1.0f - 2.0f * (static_cast<float>(i) + 0.5f) / 500.0f;
    const float turn = 2.39996f * static_cast<float>(i);
    const float side = std::sqrt(1.0f - up * up);
    const glm::vec3 way(side * std::cos(turn), up, side * std::sin(turn));
    EXPECT_LT(glm::distance(shader::from_octahedral(shader::octahedral(way)), way), 1e-5f);
  }
}

using EnvironmentPicture = RenderTest;

TEST_F(EnvironmentPicture, IsBehindMirroredAndLightsFromItsSide) {
  // Red light from the left (−x), blue from the right.
  auto room = std::make_shared<Environment>(Environment{64, 32, {}});
  for (int i = 0; i < 64 * 32; ++i)
    room->radiance.push_back(i % 64 < 32 ? glm::vec3(0.8f, 0.05f, 0.05f) : glm::vec3(0.05f, 0.05f, 0.8f));
  RenderOptions options = small();
  options.display = Display::kSrgb;
  options.environment = room;
  const auto renderer = make(options);
  Frame frame;
  frame.view = kit::make_view({0.0f, 0.0f, 1.0f}, glm::vec3(0.0f), kWidth, kHeight);
  frame.light_direction = {0.0f, 0.0f, 1.0f};  // from behind: what is seen is lit by the room
  MeshLook mirror;
  mirror.metallic = 1.0f;
  mirror.base_color = glm::vec3(1.0f);
  for (const float roughness : {0.0f, 0.5f, 1.0f}) {
    mirror.roughness = roughness;
    frame.meshes = {place(*renderer, kit::make_sphere(0.2f), mirror)};
    renderer->draw(frame);
    const FloatImage light = renderer->read_buffer(Buffer::kFinalColor);
    EXPECT_GT(light.at(kWidth / 2 - 22, kHeight / 2, 0), 2.0f * light.at(kWidth / 2 - 22, kHeight / 2, 2))
        << roughness;
    EXPECT_GT(light.at(kWidth / 2 + 22, kHeight / 2, 2), 2.0f * light.at(kWidth / 2 + 22, kHeight / 2, 0))
        << roughness;
    EXPECT_GT(light.at(2, 2, 0), 0.5f) << "the room itself, at the left";
    EXPECT_GT(light.at(kWidth - 2, 2, 2), 0.5f);
  }
  // Back to the formula, and the same renderer draws as a fresh one.
  options.environment = nullptr;
  ASSERT_TRUE(renderer->set_options(options));
  renderer->draw(frame);
  const auto fresh = make(options);
  frame.meshes = {place(*fresh, kit::make_sphere(0.2f), mirror)};
  fresh->draw(frame);
  EXPECT_EQ(renderer->read_back().rgba, fresh->read_back().rgba);
}

TEST_F(EnvironmentPicture, FluidShowsIt) {
  RenderOptions options = small();
  const auto plain = make(options);
  kit::DamBreak scene(*plain, 800, kWidth, kHeight);
  plain->draw(scene.frame);
  const Image before = plain->read_back();
  options.environment = make_studio_environment();
  const auto lit = make(options);
  kit::DamBreak same(*lit, 800, kWidth, kHeight);
  lit->draw(same.frame);
  const FloatImage light = lit->read_buffer(Buffer::kFinalColor);
  for (const float value : light.values) ASSERT_TRUE(std::isfinite(value));
  EXPECT_NE(before.rgba, lit->read_back().rgba);
}

}  // namespace
}  // namespace slosh
