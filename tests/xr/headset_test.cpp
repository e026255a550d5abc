// The headset as the program has it, through the real loader, against a runtime of our own.
#include "render/headset.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <thread>

#include "tests/render/scene_kit.h"
#include "tests/support/places.h"
#include "tests/xr/runtime_kit.h"

namespace slosh {
namespace {

using xr_test::RuntimeFolder;

constexpr int kSize = 160;

class HeadsetTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    HeadlessOptions headless;
    headless.software_threads = 2;
    auto made = make_headless_context(headless);
    ASSERT_TRUE(made) << made.error().text();
    context_ = std::move(made.value());
  }
  static void TearDownTestSuite() { context_.reset(); }

  void SetUp() override { setenv("XR_RUNTIME_JSON", SLOSH_XR_MANIFEST, 1); }
  void TearDown() override { headset_.reset(); }

  void begin(const std::string& script, const HeadsetOptions& options = {}) {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_.emplace(test::build_dir() / "xr" / info->name(), "size 160 160\nrate 240\n" + script);
    setenv("SLOSH_TEST_XR", folder_->path().c_str(), 1);
    auto found = Headset::find(options);
    if (!found) {
      refusal_ = found.error().text();
      return;
    }
    headset_ = std::move(found.value());
    RenderOptions render;
    render.width = render.height = kSize;
    render.shadow_size = 128;
    auto made = Renderer::create(*context_, render);
    ASSERT_TRUE(made) << made.error().text();
    renderer_ = std::move(made.value());
    const Result<bool> started = headset_->start(*context_);
    if (!started) refusal_ = started.error().text();
  }
  /// One turn as the program takes it; true when both eyes were drawn and handed over.
  bool turn() {
    state_ = headset_->poll();
    note_problem();
    if (state_ == HeadsetState::kAway || state_ == HeadsetState::kLost || state_ == HeadsetState::kEnded) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return false;
    }
    const bool drawn = headset_->frame(
        [&](const Pose&) {
          HeadsetPanel panel;
          panel.pose.position = {0.0, 1.5, -1.2};
          panel.size = {0.8, 0.6};
          return HeadsetPlaces{{}, panel};
        },
        [&](const HeadsetPictures& p) {
          EXPECT_EQ(p.size, glm::ivec2(kSize));
          renderer_->prepare(frame_, p.views);
          for (std::size_t eye = 0; eye < 2; ++eye) renderer_->draw(p.views[eye], p.targets[eye]);
          if (p.panel.texture != 0) renderer_->draw_panel(p.panel_size, p.panel);
        });
    note_problem();
    drawn_ += drawn;
    return drawn;
  }
  void note_problem() {
    if (const std::string said = headset_->take_problem(); !said.empty()) said_ += said + "\n";
  }
  /// Until `drawn` more frames were, or it was tried a thousand times.
  bool draws(int drawn) {
    const int until = drawn_ + drawn;
    for (int i = 0; i < 1000 && drawn_ < until; ++i) turn();
    return drawn_ >= until;
  }

  static inline std::unique_ptr<Context> context_;
  std::optional<RuntimeFolder> folder_;
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<Headset> headset_;
  Frame frame_;
  HeadsetState state_ = HeadsetState::kAway;
  std::string refusal_;
  std::string said_;
  int drawn_ = 0;
};

TEST_F(HeadsetTest, SaysWhatIsMissing) {
  setenv("XR_RUNTIME_JSON", "/nowhere/openxr.json", 1);
  begin("");
  EXPECT_NE(refusal_.find("headset: "), std::string::npos) << refusal_;
  EXPECT_NE(refusal_.find("XR_RUNTIME_JSON names, /nowhere/openxr.json"), std::string::npos) << refusal_;
  setenv("XR_RUNTIME_JSON", SLOSH_XR_MANIFEST, 1);
  begin("headset 0\n");
  EXPECT_NE(refusal_.find("has no headset. Plug it in"), std::string::npos) << refusal_;
  begin("egl 0\n");
  EXPECT_NE(refusal_.find("takes pictures of a window alone"), std::string::npos) << refusal_;
}

TEST_F(HeadsetTest, ARuntimesNameIsTextAndEnds) {
  const std::string hostile = "\x1b]0;owned\x07\u009b2J\u202e\xff=cmd";
  begin("runtime " + hostile + "\n");
  ASSERT_TRUE(headset_) << refusal_;
  EXPECT_EQ(headset_->description(), "Test headset, ?]0;owned??2J?=cmd");
  headset_.reset();
  begin("runtime " + std::string(500, 'n') + "\n");
  ASSERT_TRUE(headset_) << refusal_;
  EXPECT_EQ(headset_->description(), "Test headset, " + std::string(128, 'n'));
  headset_.reset();
  begin("headset 0\nruntime " + hostile + "\n");
  EXPECT_NE(refusal_.find("the runtime (?]0;owned??2J?=cmd) has no headset"), std::string::npos) << refusal_;
}

/// The mean place of what is much more red than green, in pixels; x < 0: nothing.
glm::dvec2 red_middle(const RuntimeFolder::Picture& picture) {
  glm::dvec2 sum(0.0);
  double count = 0.0;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const unsigned char* p = picture.at(x, y);
      if (p[0] < 2 * p[1] || p[0] < 40) continue;
      sum += glm::dvec2(x + 0.5, y + 0.5);
      count += 1.0;
    }
  }
  return count > 0.0 ? sum / count : glm::dvec2(-1.0);
}

TEST_F(HeadsetTest, EyesSeeAsFarApartAsTheyAre) {
  begin("ipd 0.064\nhead 0 1.6 0\nkeep 5\n");
  ASSERT_EQ(refusal_, "");
  const kit::Shape ball = kit::make_sphere(0.03f);
  MeshInstance instance{
      renderer_->add_mesh(ball.positions, ball.normals, ball.triangles), glm::mat4(1.0f), {}};
  instance.look.base_color = {0.9f, 0.02f, 0.02f};
  instance.look.roughness = 1.0f;
  const glm::dvec3 at(0.05, 1.25, -0.45);
  instance.model[3] = glm::vec4(glm::vec3(at), 1.0f);
  frame_.meshes = {instance};
  ASSERT_TRUE(draws(8));

  // As the runtime has its eyes: looking 30° down, wider to the outside (tests/xr/runtime).
  const glm::dquat down = glm::angleAxis(-glm::radians(30.0), glm::dvec3(1, 0, 0));
  std::array<glm::dvec2, 2> seen;
  for (int eye = 0; eye < 2; ++eye) {
    const glm::dvec3 from(eye == 0 ? -0.032 : 0.032, 1.6, 0.0);
    const glm::dvec3 e = glm::conjugate(down) * (at - from);
    const double left = std::tan(eye == 0 ? -0.75 : -0.65);
    const double right = std::tan(eye == 0 ? 0.65 : 0.75);
    const double top = std::tan(0.7);
    const glm::dvec2 wanted(kSize * (e.x / -e.z - left) / (right - left),
                            kSize * (top - e.y / -e.z) / (2.0 * top));
    const RuntimeFolder::Picture picture = folder_->picture(5, eye == 0 ? "left" : "right");
    ASSERT_EQ(picture.width, kSize);
    seen[static_cast<std::size_t>(eye)] = red_middle(picture);
    EXPECT_LT(glm::distance(seen[static_cast<std::size_t>(eye)], wanted), 0.8) << "px, eye " << eye;
  }
  EXPECT_GT(seen[0].x - seen[1].x, 3.0) << "px: the left eye sees it farther to the right";
  EXPECT_EQ(folder_->wrong(), "");
}

TEST_F(HeadsetTest, FramesComeInOrderWithThePanel) {
  begin("keep 4\n");
  ASSERT_EQ(refusal_, "");
  frame_.hud = [] {
    ImGui::Begin("forces");
    ImGui::Text("left hand 12.3 N");
    ImGui::End();
  };
  ASSERT_TRUE(draws(10));
  EXPECT_GT(headset_->period(), 0.0);
  EXPECT_EQ(state_, HeadsetState::kFocused);
  EXPECT_EQ(folder_->wrong(), "");
  int before = 0;
  for (const std::string& line : folder_->log()) {
    int frame = 0;
    int pairs = 0;
    int quads = 0;
    if (std::sscanf(line.c_str(), "end %d pairs %d quads %d", &frame, &pairs, &quads) != 3) continue;
    EXPECT_EQ(frame, before + 1);
    before = frame;
    EXPECT_LE(pairs, 1);
    EXPECT_EQ(quads, pairs);
  }
  EXPECT_GE(before, 10);
  EXPECT_EQ(folder_->count("panel at 0.000 1.500 -1.200, 0.800 x 0.600 m"), 1);
  const RuntimeFolder::Picture panel = folder_->picture(4, "panel");
  ASSERT_GT(panel.width, 0);
  EXPECT_GT(std::ranges::count_if(panel.rgb, [](unsigned char c) { return c > 200; }), 50) << "letters";
  headset_.reset();
  EXPECT_EQ(folder_->wrong(), "") << "also in the end: everything goes before what it belongs to";
  EXPECT_EQ(folder_->count("session gone"), 1);
}

TEST_F(HeadsetTest, EveryStateIsLivedThrough) {
  begin(
      "at 4 state visible\nat 8 state synchronized\nat 12 state focused\nat 16 state stopping\nat 30 state "
      "exiting\n");
  ASSERT_EQ(refusal_, "");
  bool visible = false;
  bool hidden = false;
  bool away = false;
  bool tracked_when_visible = false;
  for (int i = 0; i < 1000 && state_ != HeadsetState::kEnded; ++i) {
    turn();
    visible |= state_ == HeadsetState::kVisible;
    hidden |= state_ == HeadsetState::kHidden;
    away |= state_ == HeadsetState::kAway;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));  // longer than buttons are kept for
    if (state_ == HeadsetState::kVisible)
      tracked_when_visible |= headset_->hands()->read(HandSide::kLeft).tracked;
  }
  EXPECT_EQ(state_, HeadsetState::kEnded);
  EXPECT_TRUE(visible);
  EXPECT_TRUE(hidden);
  EXPECT_TRUE(away);
  EXPECT_EQ(folder_->count("session begun"), 2) << "ended, and begun again when the headset was put on again";
  EXPECT_EQ(folder_->count("session ended"), 1);
  EXPECT_EQ(folder_->wrong(), "");
  EXPECT_EQ(said_, "") << "none of this is worth a word";
}

TEST_F(HeadsetTest, ALostSessionIsTakenUpAgain) {
  for (const char* how : {"at 5 lose\n", "at 5 state loss_pending\n"}) {
    said_.clear();
    drawn_ = 0;
    begin(how);
    ASSERT_EQ(refusal_, "");
    for (int i = 0; i < 1000 && state_ != HeadsetState::kLost; ++i) turn();
    ASSERT_EQ(state_, HeadsetState::kLost) << how;
    EXPECT_NE(said_.find("headset: "), std::string::npos);
    for (int i = 0; i < 10; ++i) {
      headset_->hands()->read(i % 2 == 0 ? HandSide::kLeft : HandSide::kRight);
      std::this_thread::sleep_for(std::chrono::milliseconds(6));  // longer than hands are not asked for anew
    }
    EXPECT_LE(folder_->count("hands asked for of a session that is lost"), 1) << "what is gone is let be";
    headset_->stop();
    EXPECT_FALSE(headset_->hands()->read(HandSide::kLeft).tracked) << "and it is no crash to ask";
    headset_->hands()->vibrate(HandSide::kLeft, 1.0, 0.1);
    const Result<bool> again = headset_->start(*context_);
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_TRUE(draws(5));
    EXPECT_EQ(folder_->count("instance of slosh"), 2) << "from the instance on";
    headset_.reset();
    EXPECT_EQ(folder_->wrong(), "");
    state_ = HeadsetState::kAway;
  }
}

TEST_F(HeadsetTest, RefusedPicturesCostTheirFramesAlone) {
  begin(
      "at 5 fail xrAcquireSwapchainImage 2\nat 12 fail xrWaitSwapchainImage 1\nat 20 fail xrEndFrame 1\n"
      "at 25 fail xrWaitFrame 1\n");
  ASSERT_EQ(refusal_, "");
  ASSERT_TRUE(draws(40));
  EXPECT_NE(state_, HeadsetState::kLost);
  EXPECT_NE(said_.find("swapchain failed: XR_ERROR_RUNTIME_FAILURE"), std::string::npos) << said_;
  EXPECT_NE(said_.find("xrEndFrame failed"), std::string::npos) << said_;
  EXPECT_EQ(folder_->count("refused xrAcquireSwapchainImage"), 2);
  EXPECT_GE(folder_->count("end 5 pairs 0"), 1) << "the frame is handed over, without a picture";
  EXPECT_EQ(folder_->wrong(), "");
}

TEST_F(HeadsetTest, ARuntimeThatRefusesForeverIsLost) {
  begin("at 5 fail xrAcquireSwapchainImage 1000\n");
  ASSERT_EQ(refusal_, "");
  for (int i = 0; i < 200 && state_ != HeadsetState::kLost; ++i) turn();
  EXPECT_EQ(state_, HeadsetState::kLost);
  EXPECT_EQ(std::ranges::count(said_, '\n'), 1) << "said once: " << said_;
}

TEST_F(HeadsetTest, HandsGoOnBesideAPictureThatWaits) {
  begin("rate 2\nhand left -0.2 1.1 -0.3\nswing right 0 0.1 0 0.5\nsqueeze left 0 100\n");
  ASSERT_EQ(refusal_, "");
  ASSERT_TRUE(draws(1));
  const std::shared_ptr<HeadsetHands> hands = headset_->hands();
  std::atomic<bool> over{false};
  std::vector<HandReading> right;
  std::thread other([&] {
    while (!over) {
      right.push_back(hands->read(HandSide::kRight));
      hands->vibrate(HandSide::kRight, 0.5, 0.02);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
  });
  ASSERT_TRUE(draws(2));  // half a second each
  over = true;
  other.join();
  const HandReading left = hands->read(HandSide::kLeft);
  ASSERT_TRUE(left.tracked);
  EXPECT_LT(glm::distance(left.pose.position, glm::dvec3(-0.2, 1.1, -0.3)), 1e-6);
  EXPECT_FLOAT_EQ(left.squeeze, 1.0f);
  EXPECT_TRUE(left.buttons & kHandSqueeze);
  double low = 9.0;
  double high = -9.0;
  double fastest = 0.0;
  std::size_t places = 0;
  for (std::size_t i = 0; i < right.size(); ++i) {
    ASSERT_TRUE(right[i].tracked);
    low = std::min(low, right[i].pose.position.y);
    high = std::max(high, right[i].pose.position.y);
    fastest = std::max(fastest, std::abs(right[i].twist.linear.y));
    places += i > 0 && right[i].pose.position.y != right[i - 1].pose.position.y;
  }
  EXPECT_GT(high - low, 0.05) << "m of the 0.1 that it swings, between two pictures";
  EXPECT_GT(fastest, 0.2);
  EXPECT_GT(places, 20u) << "many readings a picture";
  EXPECT_GT(folder_->count("vibrate right 0.500 20 ms"), 20);
  EXPECT_EQ(folder_->wrong(), "");
}

}  // namespace
}  // namespace slosh
