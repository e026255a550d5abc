// What keys do, in the order in which they came, and what is read off the picture.
#include "peer/app/window_controls.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "peer/app/window_tap.h"
#include "peer/view/force_panel.h"
#include "peer/view/measures.h"

namespace slosh {
namespace {

/// A run that notes what it was asked.
class NotedRun : public LiveRun {
 public:
  void start() override {}
  void request_stop() override {}
  bool running() override { return true; }
  void stop() override {}
  SnapshotQueue& snapshots() override { return queue_; }
  HudFacts facts(double) const override { return {}; }
  bool paused() const override { return paused_; }
  LiveValues live_values() const override {
    LiveValues values;
    values.may_change = values.may_pace = true;
    values.pace = pace;
    return values;
  }
  void change(const LiveWish& wish) override { pace = wish.value; }
  void step_standing(int count) override { steps += count; }
  void report(RunSummary&) const override {}

  double pace = 1.0;
  int steps = 0;

 private:
  Rates world_rates() override { return {}; }
  void ask(const RemoteCommand& command, bool) override {
    paused_ = command.action == wire::WorldAction::kPause;
  }

  SnapshotQueue queue_{1 << 20};
  bool paused_ = false;
};

class WindowControlsTest : public ::testing::Test {
 protected:
  WindowControls controls(const std::vector<std::string>& keys = {},
                          const std::filesystem::path& views = {}) {
    return {scene,
            run,
            camera,
            KeyBindings::make(keys).value(),
            KeptViews(views),
            [this](const std::string& line) { told += line + "\n"; }};
  }
  static InputState pressed(std::vector<KeyPress> presses) {
    InputState input;
    input.presses = std::move(presses);
    return input;
  }

  Scene scene;
  NotedRun run;
  OrbitCamera camera{Camera{}};
  std::string told;
};

/// On a slow picture several come at once. A step and then "go on" left the world standing when each key was
/// looked for by itself.
TEST_F(WindowControlsTest, KeysOfOnePictureActInTheirOrder) {
  WindowControls window = controls();
  window.follow(pressed({{Key::kSpace}}), {640, 480}, nullptr);
  EXPECT_TRUE(run.paused());
  window.follow(pressed({{Key::kN}, {Key::kN, true}, {Key::kSpace}}), {640, 480}, nullptr);
  EXPECT_FALSE(run.paused()) << "it goes on";
  EXPECT_EQ(run.steps, 11) << "one, and ten with Shift";
  window.follow(pressed({{Key::kSpace}, {Key::kSpace}, {Key::kSpace}}), {640, 480}, nullptr);
  EXPECT_TRUE(run.paused()) << "pressed thrice";
  window.follow(pressed({{Key::kDown}, {Key::kDown}}), {640, 480}, nullptr);
  EXPECT_LT(run.pace, 0.6);
  EXPECT_EQ(window.follow(pressed({{Key::kP}, {Key::kTab}}), {640, 480}, nullptr),
            WindowControls::Wish::kPicture);
  EXPECT_EQ(window.follow(pressed({{Key::kP}, {Key::kQ}}), {640, 480}, nullptr), WindowControls::Wish::kEnd);
}

TEST_F(WindowControlsTest, KeysAreThoseThatSomebodyChose) {
  WindowControls window = controls({"pause=K", "end=F10"});
  EXPECT_EQ(window.follow(pressed({{Key::kSpace}, {Key::kQ}, {Key::kEscape}}), {640, 480}, nullptr),
            WindowControls::Wish::kNothing);
  EXPECT_FALSE(run.paused());
  window.follow(pressed({{Key::kK}}), {640, 480}, nullptr);
  EXPECT_TRUE(run.paused());
  EXPECT_EQ(window.follow(pressed({{Key::kF10}}), {640, 480}, nullptr), WindowControls::Wish::kEnd);
  GuideFacts facts;
  facts.may_change = true;
  const std::string keys = WindowGuide::all_keys(facts, KeyBindings::make({"pause=K", "picture="}).value());
  EXPECT_NE(keys.find("\nK                  pause"), std::string::npos) << keys;
  EXPECT_EQ(keys.find("Space"), std::string::npos) << keys;
  EXPECT_EQ(keys.find("picture as a file"), std::string::npos) << "no key does it: " << keys;
  EXPECT_NE(WindowGuide(KeyBindings::make({"help=F1"}).value()).hint(facts).find("F1: all keys"),
            std::string::npos);
}

TEST_F(WindowControlsTest, ViewsAreKeptAndComeBack) {
  WindowControls window = controls();
  camera.turn(0.5, 0.1);
  camera.zoom(0.5);
  const glm::dvec3 eye = camera.eye();
  window.follow(pressed({{Key::k2, true}}), {640, 480}, nullptr);
  window.follow(pressed({{Key::kC}}), {640, 480}, nullptr);
  EXPECT_GT(glm::distance(camera.eye(), eye), 0.05);
  window.follow(pressed({{Key::k1}}), {640, 480}, nullptr);
  EXPECT_GT(glm::distance(camera.eye(), eye), 0.05) << "nothing is kept there";
  window.follow(pressed({{Key::k2}}), {640, 480}, nullptr);
  EXPECT_LT(glm::distance(camera.eye(), eye), 1e-12);
}

TEST_F(WindowControlsTest, ViewsAreThereInTheNextRun) {
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / ("views_" + std::to_string(getpid()));
  std::filesystem::remove_all(folder);
  const std::filesystem::path file = folder / "deep/bucket.json";
  camera.turn(0.5, 0.1);
  camera.pan({0.1, -0.2});
  const glm::dvec3 eye = camera.eye();
  const glm::dvec3 target = camera.target();
  const auto comes_back = [&] {
    camera.reset();
    controls({}, file).follow(pressed({{Key::k2}}), {640, 480}, nullptr);
    return glm::distance(camera.eye(), eye) + glm::distance(camera.target(), target) < 1e-9;
  };
  EXPECT_FALSE(comes_back()) << "no file yet";
  camera.turn(0.5, 0.1);
  camera.pan({0.1, -0.2});
  {
    WindowControls one = controls({}, file);
    WindowControls other = controls({}, file);
    one.follow(pressed({{Key::k2, true}}), {640, 480}, nullptr);
    other.follow(pressed({{Key::k4, true}}), {640, 480}, nullptr);  // of another run at the same time
  }
  EXPECT_TRUE(comes_back());
  EXPECT_TRUE(KeptViews(file).view(3));
  EXPECT_EQ(told, "");

  // What cannot be read is said, and nobody writes over it.
  for (const char* bytes :
       {"", "not json", "{\"format\": \"slosh views 1\", \"views\": {\"2\": {\"distance_m\": -1}}}",
        "{\"format\": \"slosh views 1\", \"views\": {\"9\": {}}}", "[1, 2]"}) {
    std::ofstream(file) << bytes;
    told.clear();
    WindowControls window = controls({}, file);
    EXPECT_NE(told.find(file.string()), std::string::npos) << bytes;
    EXPECT_NE(told.find("Mend it or move it away"), std::string::npos) << told;
    window.follow(pressed({{Key::k1, true}}), {640, 480}, nullptr);
    EXPECT_NE(told.find("in this run"), std::string::npos) << told;
    const glm::dvec3 kept = camera.eye();
    camera.turn(1.0, 0.0);
    window.follow(pressed({{Key::k1}}), {640, 480}, nullptr);
    EXPECT_LT(glm::distance(camera.eye(), kept), 1e-9) << "for this run they are kept";
    std::ifstream in(file);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), bytes);
  }
  std::filesystem::remove_all(folder);
}

TEST(WindowTap, ReadsPressuresOnlyWhileItIsLookedAt) {
  WindowTap tap;
  EXPECT_EQ(tap.pressures(false), nullptr);
  EXPECT_EQ(tap.pressures(true), nullptr) << "none yet";
}

TEST(ForcePanel, KeepsATableAndStartsAnewWithTheWorld) {
  Scene scene;
  scene.grips.resize(1);
  scene.grips[0].name = "left, hand";
  ForcePanel panel(scene);
  BodySnapshot bodies;
  bodies.grips.resize(1);
  for (int i = 0; i < 5; ++i) {
    bodies.time = 0.1 * i;
    bodies.grips[0].on_hand.force = {0.0, -2.0 - i, 0.0};
    bodies.grips[0].on_hand.torque = {0.25, 0.0, 0.0};
    panel.record(bodies);
    panel.record(bodies);  // the same again: a picture more than states
  }
  const std::string table = panel.table();
  std::stringstream lines(table);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line,
            "time_s,left_ hand_fx_n,left_ hand_fy_n,left_ hand_fz_n,left_ hand_tx_nm,left_ hand_ty_nm,left_ "
            "hand_tz_nm");
  std::getline(lines, line);
  EXPECT_EQ(line, "0.000000,0,-2,0,0.25,0,0");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 6);
  EXPECT_FALSE(panel.take_table()) << "nobody asked";
  panel.zoom(100.0);
  EXPECT_DOUBLE_EQ(panel.span(), 0.1);
  panel.zoom(-1000.0);
  EXPECT_DOUBLE_EQ(panel.span(), 600.0);
  bodies.time = 0.05;
  panel.record(bodies);
  const std::string again = panel.table();
  EXPECT_EQ(std::count(again.begin(), again.end(), '\n'), 2) << "the world started again";
}

TEST(Measures, HaveVelocitiesOfTwoSnapshotsAndRoundScales) {
  Measures measures;
  Snapshot snapshot;
  snapshot.positions = {{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}};
  snapshot.fluid_index = {0, 0};
  measures.record(snapshot);
  EXPECT_TRUE(measures.velocities().empty());
  snapshot.rigid.time = 0.5;
  snapshot.positions[1].y = 0.25f;
  measures.record(snapshot);
  ASSERT_EQ(measures.velocities().size(), 2u);
  EXPECT_EQ(measures.velocities()[0], glm::vec3(0.0f));
  EXPECT_EQ(measures.velocities()[1], glm::vec3(0.0f, 0.5f, 0.0f));
  snapshot.rigid.time = 0.1;
  measures.record(snapshot);
  EXPECT_TRUE(measures.velocities().empty()) << "the world started again";
  EXPECT_DOUBLE_EQ(round_length(0.07), 0.05);
  EXPECT_DOUBLE_EQ(round_length(0.2), 0.2);
  EXPECT_DOUBLE_EQ(round_length(1.7), 1.0);
  EXPECT_EQ(length_text(0.05), "50 mm");
  EXPECT_EQ(length_text(2.0), "2 m");
  // Brighter the faster, so that it reads without colours too.
  float before = -1.0f;
  for (int i = 0; i <= 10; ++i) {
    const glm::vec3 c = speed_color(0.1f * static_cast<float>(i));
    const float bright = 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
    EXPECT_GT(bright, before) << i;
    before = bright;
  }
}

}  // namespace
}  // namespace slosh
