// Hand animation: LINEAR, STEP, CUBICSPLINE, parents, resampling.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/gtc/quaternion.hpp>

#include "support.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::TempFolder;

std::string base64(const std::string& bytes) {
  static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t v = 0;
    for (std::size_t k = 0; k < 3; ++k)
      v = v << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (int k = 3; k >= 0; --k) {
      out += 3 - k <= static_cast<int>(bytes.size() - i) ? kDigits[(v >> (6 * k)) & 63] : '=';
    }
  }
  return out;
}

/// Adds an accessor over floats in a buffer of its own; returns its index.
int add_floats(json& root, const std::vector<float>& numbers, const char* type) {
  std::string bytes(numbers.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  const int components = std::string(type) == "SCALAR" ? 1 : (std::string(type) == "VEC3" ? 3 : 4);
  root["buffers"].push_back(
      {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}});
  root["bufferViews"].push_back({{"buffer", root["buffers"].size() - 1}, {"byteLength", bytes.size()}});
  root["accessors"].push_back({{"bufferView", root["bufferViews"].size() - 1},
                               {"componentType", 5126},
                               {"count", numbers.size() / static_cast<std::size_t>(components)},
                               {"type", type}});
  return static_cast<int>(root["accessors"].size()) - 1;
}

/// Replaces the hand's animation of one path.
void animate(json& root, const char* path, const char* interpolation, const std::vector<float>& times,
             const std::vector<float>& values) {
  const bool moves = std::string(path) == "translation";
  for (std::size_t i = 0; i < root["nodes"].size(); ++i) {
    if (root["nodes"][i]["name"] != "hand") continue;
    const int input = add_floats(root, times, "SCALAR");
    const int output = add_floats(root, values, moves ? "VEC3" : "VEC4");
    root["animations"] = json::array();
    root["animations"].push_back(
        {{"name", "test"},
         {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", i}, {"path", path}}}}}}});
  }
}

std::vector<PoseKey> motion_of(const test::Edit& edit) {
  const auto scene = test::load_edited(edit);
  EXPECT_TRUE(scene) << scene.error().text();
  return scene ? scene.value().grips.at(0).hand_motion : std::vector<PoseKey>{};
}

TEST(HandMotion, LinearIsCutToSixtyHertz) {
  const auto keys = motion_of([](json& j) {
    animate(j, "translation", "LINEAR", {0, 1}, {0, 0.1f, 0, 0.6f, 0.1f, 0});
  });
  ASSERT_EQ(keys.size(), 61u);
  for (const PoseKey& key : keys) EXPECT_NEAR(key.pose.position.x, 0.6 * key.time, 1e-6);
}

TEST(HandMotion, StepIsARampOverOneKey) {
  const auto keys = motion_of([](json& j) {
    animate(j, "translation", "STEP", {0, 0.5f, 1}, {0, 0.1f, 0, 0.2f, 0.1f, 0, 0.3f, 0.1f, 0});
  });
  for (const PoseKey& key : keys) {
    const double expected = key.time < 0.5 ? 0.0 : (key.time < 1.0 ? 0.2 : 0.3);
    EXPECT_NEAR(key.pose.position.x, expected, 1e-6) << key.time;
  }
}

TEST(HandMotion, CubicSplineFollowsHermite) {
  // In-tangent, value, out-tangent a key: from 0 to 0.1 with speeds 0.2 and −0.1 over 2 s.
  const auto keys = motion_of([](json& j) {
    animate(j, "translation", "CUBICSPLINE", {0, 2},
            {0, 0, 0, 0, 0.1f, 0, 0.2f, 0, 0, -0.1f, 0, 0, 0.1f, 0.1f, 0, 0, 0, 0});
  });
  ASSERT_EQ(keys.size(), 121u);
  for (const PoseKey& key : keys) {
    const double u = key.time / 2.0;
    const double expected = 2.0 * 0.2 * (u * u * u - 2 * u * u + u) + 0.1 * (-2 * u * u * u + 3 * u * u) +
                            2.0 * -0.1 * (u * u * u - u * u);
    EXPECT_NEAR(key.pose.position.x, expected, 1e-6);
  }
}

TEST(HandMotion, RotationTurnsEvenly) {
  const float h = std::sqrt(0.5f);
  const auto keys = motion_of([h](json& j) {
    animate(j, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 1, 0, h, 0, h});
  });
  ASSERT_EQ(keys.size(), 61u);
  for (const PoseKey& key : keys) {
    EXPECT_NEAR(rotation_between({1, 0, 0, 0}, key.pose.orientation).y, key.time * 1.5707963, 1e-5);
    EXPECT_NEAR(key.pose.position.y, 0.1, 1e-6);  // no channel: the node's own
  }
}

TEST(HandMotion, StartsAtTimeZeroWhenItsKeysDoNot) {
  const auto keys = motion_of([](json& j) {
    animate(j, "translation", "LINEAR", {0.5f, 1}, {0, 0.1f, 0, 0.2f, 0.1f, 0});
  });
  EXPECT_EQ(keys.front().time, 0.0);
  EXPECT_NEAR(keys.front().pose.position.x, 0.0, 1e-9);
  EXPECT_NEAR(keys.back().pose.position.x, 0.2, 1e-6);
}

TEST(HandMotion, StillHandHasOneKey) {
  EXPECT_EQ(motion_of([](json& j) { j.erase("animations"); }).size(), 1u);
}

TEST(HandMotion, HangsOnAStillParent) {
  const auto keys = motion_of([](json& j) {
    // hand → a parent that is turned by 90° about y and moved up: the hand's own 0.1 comes from the parent's.
    json& nodes = j["nodes"];
    std::size_t hand = 0;
    while (nodes[hand]["name"] != "hand") ++hand;
    nodes.push_back({{"name", "stand"},
                     {"translation", {0, 0.1, 0}},
                     {"rotation", {0, std::sqrt(0.5), 0, std::sqrt(0.5)}},
                     {"children", {hand}}});
    for (json& root : j["scenes"][0]["nodes"]) {
      if (root == hand) root = nodes.size() - 1;
    }
    animate(j, "translation", "LINEAR", {0, 1}, {0, 0, 0, 0.5f, 0, 0});
  });
  ASSERT_FALSE(keys.empty());
  EXPECT_NEAR(keys.front().pose.position.y, 0.1, 1e-6);
  EXPECT_NEAR(keys.back().pose.position.z, -0.5, 1e-6);  // the parent's x axis
  EXPECT_NEAR(rotation_between({1, 0, 0, 0}, keys.back().pose.orientation).y, 1.5707963, 1e-6);
}

TEST(HandMotion, Errors) {
  test::expect_edit_error(
      [](json& j) {
        animate(j, "translation", "LINEAR", {0, 1}, {0, 0.1f, 0});
      },
      {"cup.gltf", "'hand'", "do not match"});
  test::expect_edit_error(
      [](json& j) {
        animate(j, "translation", "LINEAR", {1, 0.5f}, {0, 0.1f, 0, 0, 0.1f, 0});
      },
      {"'hand'", "do not rise"});
  test::expect_edit_error(
      [](json& j) {
        animate(j, "translation", "BEZIER", {0, 1}, {0, 0.1f, 0, 0, 0.1f, 0});
      },
      {"'hand'", "BEZIER", "CUBICSPLINE"});
  test::expect_edit_error(
      [](json& j) {
        animate(j, "translation", "LINEAR", {0, 1}, {0.2f, 0.1f, 0, 0, 0.1f, 0});
      },
      {"'hand'", "200 mm", "'handle'"});
  test::expect_edit_error(
      [](json& j) {
        animate(j, "rotation", "LINEAR", {0, 1}, {0, 0, 0, 0, 0, 0, 0, 1});
      },
      {"'hand'", "length zero"});
  test::expect_edit_error([](json& j) { j["animations"].push_back(j["animations"][0]); },
                          {"'hand'", "animated twice"});
  test::expect_edit_error(
      [](json& j) {
        for (std::size_t i = 0; i < j["nodes"].size(); ++i) {
          if (j["nodes"][i]["name"] != "cup") continue;
          for (json& channel : j["animations"][0]["channels"]) channel["target"]["node"] = i;
        }
      },
      {"'cup'", "only a hand can be animated"});
}

}  // namespace
}  // namespace slosh
