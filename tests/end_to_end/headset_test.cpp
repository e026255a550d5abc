// `--vr` from the command line, with the real loader and a runtime of the tests' own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "display.h"
#include "hosted_test.h"
#include "peer/haptics/script_device.h"
#include "peer/output/plot.h"
#include "process.h"
#include "render/image.h"
#include "tests/support/comes.h"
#include "tests/xr/runtime_kit.h"

namespace slosh {
namespace {

using nlohmann::json;
using test::Outcome;
using test::Process;
using test::read_text;
using xr_test::RuntimeFolder;

class VrTest : public test::HostedTest {
 protected:
  RuntimeFolder runtime(const std::string& name, const std::string& script) const {
    return {test::test_folder() / name, "size 128 128\nrate 60\n" + script};
  }
  std::vector<std::string> with(const RuntimeFolder& folder, std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"env", std::string("XR_RUNTIME_JSON=") + SLOSH_XR_MANIFEST,
                                         "SLOSH_TEST_XR=" + folder.path().string()});
    return arguments;
  }
  Outcome play(const RuntimeFolder& folder, const std::vector<std::string>& more) const {
    std::vector<std::string> all{"play", "bucket", "--spacing", "0.013"};
    all.insert(all.end(), more.begin(), more.end());
    return Process(with(folder, command(all)), test::test_folder()).wait();
  }
  std::filesystem::path out = test::test_folder() / "out";
};

/// Rows of a hand without a gap, from begin to end.
void expect_headset_rows(const std::filesystem::path& folder, int device, double seconds) {
  const Result<std::vector<PoseKey>> keys = read_poses(folder / "poses.csv", device);
  ASSERT_TRUE(keys) << keys.error().text();
  ASSERT_GT(keys.value().size(), 100u);
  EXPECT_NEAR(keys.value().back().time, seconds, 0.1);
  for (std::size_t i = 1; i < keys.value().size(); ++i)
    ASSERT_LT(keys.value()[i].time - keys.value()[i - 1].time, 0.3) << "s, row " << i;
}

TEST_F(VrTest, TwoControllersCarryTheBucket) {
  const std::string both =
      "swing left 0 0.1 0 1.6\nswing right 0 0.1 0 1.6\nsqueeze left 0 1e9\nsqueeze right 0 1e9\n";
  const RuntimeFolder xr = runtime("xr", both + "keep 10\n");
  const Outcome played = play(xr, {"--vr", "--device", "xr-left", "--device", "xr-right", "--seconds", "2",
                                   "--fps", "10", "--out", "out"});
  ASSERT_EQ(played.code, 0) << played.err;
  EXPECT_NE(played.err.find("headset: Test headset, Test runtime"), std::string::npos) << played.err;
  EXPECT_EQ(xr.wrong(), "");
  EXPECT_GT(xr.count("end"), 10);
  EXPECT_GT(xr.picture(10, "left").width, 0);
  EXPECT_NE(xr.picture(10, "left").rgb, xr.picture(10, "right").rgb);
  EXPECT_EQ(xr.count("session by EGL"), 1);
  EXPECT_GT(xr.count("vibrate left"), 0) << "the water's weight comes and goes";
  EXPECT_GT(xr.count("vibrate right"), 0);
  for (int hand = 0; hand < 2; ++hand) {
    expect_headset_rows(out, hand, 2.0);
    const Result<std::vector<PoseKey>> keys = read_poses(out / "poses.csv", hand);
    const auto [low, high] =
        std::ranges::minmax(keys.value(), {}, [](const PoseKey& k) { return k.pose.position.y; });
    EXPECT_NEAR(high.pose.position.y - low.pose.position.y, 0.1, 0.02) << "m, hand " << hand;
  }
  // Both carry: what each feels is downwards and about half of the whole, in the mean.
  const Result<std::vector<WrenchSeries>> series = read_wrenches(out / "wrenches.csv");
  ASSERT_TRUE(series) << series.error().text();
  std::array<double, 2> mean{};
  for (std::size_t hand = 0; hand < 2; ++hand) {
    for (const Wrench& w : series.value()[hand].on_hand)
      mean[hand] += w.force.y / static_cast<double>(series.value()[hand].on_hand.size());
  }
  EXPECT_LT(mean[0], -5.0) << "N";
  EXPECT_NEAR(mean[0] / mean[1], 1.0, 0.25);
  const Result<Image> last = read_png(out / "final.png");
  ASSERT_TRUE(last) << last.error().text();
  EXPECT_EQ(last.value().width, 256) << "both eyes side by side";
  EXPECT_EQ(last.value().height, 128);
  EXPECT_TRUE(std::filesystem::exists(out / "view.mp4"));
  const json summary = json::parse(read_text(out / "summary.json"));
  EXPECT_TRUE(summary["problems"].empty()) << summary["problems"];
}

TEST_F(VrTest, WhatTheRuntimeRefusesDoesNotReachTheHands) {
  const RuntimeFolder xr = runtime(
      "xr", "squeeze left 0 1e9\nsqueeze right 0 1e9\nat 6 fail xrAcquireSwapchainImage 2\nat 10 lose\n");
  const Outcome played =
      play(xr, {"--vr", "--device", "xr-left", "--device", "xr-right", "--seconds", "4", "--out", "out"});
  ASSERT_EQ(played.code, 0) << played.err;
  EXPECT_NE(played.err.find("swapchain failed"), std::string::npos) << played.err;
  EXPECT_NE(played.err.find("XR_ERROR_SESSION_LOST"), std::string::npos) << played.err;
  EXPECT_NE(played.err.find("it is back"), std::string::npos) << played.err;
  EXPECT_NE(played.err.find("controller is not seen"), std::string::npos) << played.err;
  EXPECT_NE(played.err.find("slosh: what was out of order is in use again"), std::string::npos) << played.err;
  EXPECT_EQ(xr.wrong(), "");
  for (int hand = 0; hand < 2; ++hand) expect_headset_rows(out, hand, 4.0);
}

TEST_F(VrTest, WithoutARuntimeOrAHeadsetItSaysSoAndGoesOn) {
  const Outcome missing = Process({"env", "XR_RUNTIME_JSON=/nowhere.json", test::program(), "play", "bucket",
                                   "--vr", "--seconds", "0.2", "--spacing", "0.013", "--out", "out"},
                                  test::test_folder())
                              .wait();
  EXPECT_EQ(missing.code, 0) << missing.err;
  EXPECT_NE(missing.err.find("headset: "), std::string::npos) << missing.err;
  EXPECT_NE(missing.err.find("the run goes on without it"), std::string::npos) << missing.err;
  EXPECT_EQ(missing.err.find("OpenXR-Loader"), std::string::npos)
      << "the loader's own log stays away: " << missing.err;
  EXPECT_TRUE(std::filesystem::exists(out / "view.mp4")) << "a film, as without a display";

  const RuntimeFolder xr = runtime("xr", "headset 0\n");
  const Outcome bare = play(xr, {"--vr", "--device", "xr-left", "--device", "script", "--seconds", "0.2"});
  EXPECT_NE(bare.code, 0);
  EXPECT_NE(bare.err.find("has no headset"), std::string::npos) << bare.err;
  EXPECT_NE(bare.err.find("--device xr-left: no headset is in use"), std::string::npos) << bare.err;
}

TEST_F(VrTest, AWindowMirrorsTheLeftEye) {
  if (!test::installed("Xvfb")) GTEST_SKIP() << "Xvfb is not installed";
  test::Display display(test::test_folder());
  ASSERT_TRUE(display.there());
  const RuntimeFolder xr = runtime("xr", "at 40 state exiting\n");
  Process slosh(
      display.on(with(xr, command({"play", "bucket", "--spacing", "0.013", "--vr", "--size", "320x240"}))),
      test::test_folder());
  const Outcome played = slosh.wait();
  EXPECT_EQ(played.code, 0) << "ended from within the headset: " << played.err;
  EXPECT_EQ(xr.count("session by GLX"), 1) << played.err;
  EXPECT_GT(xr.count("end"), 30);
  EXPECT_EQ(xr.wrong(), "");
}

TEST_F(VrTest, TwoPeopleWithHeadsetsHoldOneBucket) {
  auto host =
      run("host", {"host", "bucket", "--spacing", "0.013", "--wait", "2", "--seconds", "4", "--listen",
                   "127.0.0.1:0", "--links", "links.txt", "--checkpoint", "none", "--no-supervisor"});
  ASSERT_TRUE(hosting(*host)) << read_text(folder("host") / "stderr.txt");
  const std::string held =
      "swing left 0 0.08 0 2\nswing right 0 0.08 0 2\nsqueeze left 0 1e9\nsqueeze right 0 1e9\n";
  const RuntimeFolder ana_xr = runtime("ana-xr", held);
  const RuntimeFolder ben_xr = runtime("ben-xr", held);
  Process ana(with(ana_xr, command({"join", link("hold"), "--name", "Ana", "--vr", "--device", "xr-left",
                                    "--seconds", "2", "--out", "out"})),
              folder("ana"));
  Process ben(with(ben_xr, command({"join", link("hold"), "--name", "Ben", "--vr", "--device", "xr-right",
                                    "--seconds", "2", "--out", "out"})),
              folder("ben"));
  EXPECT_EQ(ana.wait().code, 0) << read_text(folder("ana") / "stderr.txt");
  EXPECT_EQ(ben.wait().code, 0) << read_text(folder("ben") / "stderr.txt");
  for (const RuntimeFolder* xr : {&ana_xr, &ben_xr}) {
    EXPECT_EQ(xr->wrong(), "");
    EXPECT_GT(xr->count("end"), 3);
  }
  for (const char* who : {"ana", "ben"}) {
    const Result<std::vector<WrenchSeries>> series = read_wrenches(folder(who) / "out/wrenches.csv");
    ASSERT_TRUE(series) << who << ": " << series.error().text();
    double least = 0.0;
    for (const WrenchSeries& hand : series.value()) {
      for (const Wrench& w : hand.on_hand) least = std::min(least, w.force.y);
    }
    EXPECT_LT(least, -5.0) << "N: " << who << " feels its share of the weight";
  }
}

}  // namespace
}  // namespace slosh
