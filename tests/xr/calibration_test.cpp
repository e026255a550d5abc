// A haptic device and a headset in one space, through the real loader: controllers as a runtime has them, and
// a made-up device that stands in the room at a place that is known.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <thread>

#include "peer/devices/shared_space.h"
#include "render/headset.h"
#include "tests/support/places.h"
#include "tests/xr/runtime_kit.h"

namespace slosh {
namespace {

using xr_test::RuntimeFolder;

const Pose kKnown{{0.25, 0.8, -0.5}, glm::normalize(glm::dquat(0.8, 0.1, -0.5, 0.3))};

/// Where a device that stands at kKnown has its tip when that is at `in_room`.
glm::dvec3 tip_at(const glm::dvec3& in_room) {
  return glm::conjugate(kKnown.orientation) * (in_room - kKnown.position);
}

class Calibration : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto made = make_headless_context({});
    ASSERT_TRUE(made) << made.error().text();
    context_ = std::move(made.value());
  }
  static void TearDownTestSuite() { context_.reset(); }
  void SetUp() override { setenv("XR_RUNTIME_JSON", SLOSH_XR_MANIFEST, 1); }

  /// A session with the left controller at `place`, squeezed after 0.4 s; the device's tip is held to it.
  TouchPlaces::Heard touch(const glm::dvec3& place, const glm::dvec3& tip_off = glm::dvec3(0.0)) {
    char script[160];
    std::snprintf(script, sizeof script,
                  "size 64 64\nrate 120\nhand left %g %g %g\nsqueeze left 0.4 1e9\nno_hand right\n", place.x,
                  place.y, place.z);
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    const RuntimeFolder folder(test::build_dir() / "xr" / (std::string("calibration_") + info->name()),
                               script);
    setenv("SLOSH_TEST_XR", folder.path().c_str(), 1);
    auto found = Headset::find({});
    EXPECT_TRUE(found) << found.error().text();
    if (!found) return TouchPlaces::Heard::kNothing;
    Headset& headset = *found.value();
    const Result<bool> started = headset.start(*context_);
    EXPECT_TRUE(started) << started.error().text();
    TouchPlaces::Heard heard = TouchPlaces::Heard::kNothing;
    for (int i = 0; i < 3000 && heard == TouchPlaces::Heard::kNothing; ++i) {
      const HeadsetState state = headset.poll();
      if (state == HeadsetState::kAway) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        continue;
      }
      headset.frame([](const Pose&) { return HeadsetPlaces{}; }, [](const HeadsetPictures&) {});
      const HandReading left = headset.hands()->read(HandSide::kLeft);
      const HandReading right = headset.hands()->read(HandSide::kRight);
      time_ += 1.0 / 120.0;
      const auto tip = left.tracked ? std::optional(tip_at(left.pose.position) + tip_off) : std::nullopt;
      heard = touched_.follow(time_, tip, left, right);
    }
    headset.stop();
    EXPECT_EQ(folder.wrong(), "");
    return heard;
  }

  static inline std::unique_ptr<Context> context_;
  TouchPlaces touched_;
  double time_ = 0.0;
};

TEST_F(Calibration, ThreeTouchesFindWhereTheDeviceStands) {
  for (const glm::dvec3& place :
       {glm::dvec3(0.2, 0.9, -0.4), glm::dvec3(0.35, 0.9, -0.45), glm::dvec3(0.25, 1.05, -0.55)})
    ASSERT_EQ(touch(place), TouchPlaces::Heard::kTaken);
  ASSERT_TRUE(touched_.complete());
  const Result<SharedSpace> fitted = fit_shared_space(touched_.places());
  ASSERT_TRUE(fitted) << fitted.error().text();
  EXPECT_LT(glm::distance(fitted.value().device_in_room.position, kKnown.position), 1e-4);
  EXPECT_LT(1.0 - std::abs(glm::dot(fitted.value().device_in_room.orientation, kKnown.orientation)), 1e-8);
  EXPECT_LT(fitted.value().residual, 1e-4);
}

TEST_F(Calibration, PlacesOnALineAndATipThatWasElsewhereAreRefused) {
  for (const double x : {0.1, 0.2, 0.3}) ASSERT_EQ(touch({x, 1.0, -0.4}), TouchPlaces::Heard::kTaken);
  EXPECT_NE(fit_shared_space(touched_.places()).error().text().find("on one line"), std::string::npos);
  touched_.again();
  ASSERT_EQ(touch({0.2, 0.9, -0.4}), TouchPlaces::Heard::kTaken);
  ASSERT_EQ(touch({0.35, 0.9, -0.45}), TouchPlaces::Heard::kTaken);
  ASSERT_EQ(touch({0.25, 1.05, -0.55}, {0.0, 0.06, 0.0}), TouchPlaces::Heard::kTaken);
  EXPECT_NE(fit_shared_space(touched_.places()).error().text().find("do not fit"), std::string::npos);
}

}  // namespace
}  // namespace slosh
