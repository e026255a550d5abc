// `slosh play` in a window on a virtual display: what its tests begin with.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "display.h"
#include "peer/haptics/script_device.h"
#include "peer/view/orbit_camera.h"
#include "process.h"
#include "scenes/load.h"

namespace slosh {

inline constexpr int kWidth = 640;
inline constexpr int kHeight = 480;

inline bool comes(const std::function<bool()>& there) {
  for (int i = 0; i < 1200; ++i) {  // two minutes, on a machine that does other things too
    if (there()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return false;
}

class WindowTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::remove_all(test::test_folder());
    for (const std::string needed : {"Xvfb", "xdotool"}) {
      if (!test::installed(needed)) GTEST_SKIP() << needed << " is not installed";
    }
    display = std::make_unique<test::Display>(test::test_folder());
    ASSERT_TRUE(display->there()) << test::read_text(test::test_folder() / "xvfb/stderr.txt");
    Result<Scene> loaded = load_scene(find_scene("bucket").value());
    ASSERT_TRUE(loaded) << loaded.error().text();
    scene = std::move(loaded.value());
  }

  /// Where in the window a place of the world is seen.
  glm::ivec2 pixel(const glm::dvec3& place) const {
    return glm::ivec2(OrbitCamera(scene.camera).pixel_of(place, {kWidth, kHeight}));
  }
  void point(glm::ivec2 at) const { display->act({"mousemove", std::to_string(at.x), std::to_string(at.y)}); }
  /// The newest pose that a hand has in poses.csv.
  Pose newest(int device) const {
    const Result<std::vector<PoseKey>> keys = read_poses(out / "poses.csv", device);
    return keys && !keys.value().empty() ? keys.value().back().pose : Pose{};
  }
  std::size_t rows() const {
    const Result<std::vector<PoseKey>> keys = read_poses(out / "poses.csv", 0);
    return keys ? keys.value().size() : 0;
  }
  static glm::dvec3 turn_of(const Pose& pose) {
    return rotation_between(glm::dquat(1.0, 0.0, 0.0, 0.0), pose.orientation);
  }

  std::unique_ptr<test::Display> display;
  Scene scene;
  std::filesystem::path out = test::test_folder() / "out";
};

}  // namespace slosh
