// The HUD in every window that a person may have: from 480 × 320 to 4K, with letters of 0.75 to 2 times their
// size.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "hud_kit.h"
#include "peer/view/hud/hud.h"
#include "peer/view/live_panel.h"
#include "peer/view/window_guide.h"
#include "render/passes/hud_pass.h"

namespace slosh {
namespace {

struct WindowSize {
  int width, height;
  float letters;
};

class HudSizes : public test::PanelTest, public ::testing::WithParamInterface<WindowSize> {
 protected:
  void SetUp() override {
    PanelTest::SetUp();
    take(GetParam());
  }
  /// Letters as HudPass makes them.
  static void take(const WindowSize& window) {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = ImVec2(static_cast<float>(window.width), static_cast<float>(window.height));
    const float pixels = std::round(window.letters * static_cast<float>(hud_font_pixels(io.DisplaySize.y)));
    io.FontGlobalScale = std::min(pixels, 96.0f) / 13.0f;
  }
  static glm::vec2 picture() { return {ImGui::GetIO().DisplaySize.x, ImGui::GetIO().DisplaySize.y}; }
  static float area(const Rect& rect) { return rect.shared_area(rect); }

  static Scene scene(std::size_t hands) {
    Scene scene;
    scene.grips.resize(hands);
    for (std::size_t i = 0; i < hands; ++i) scene.grips[i].name = "hand " + std::to_string(i + 1);
    return scene;
  }
  static HudFacts facts() {
    HudFacts facts;
    facts.title = "Pour: batter from a bowl into a pan";
    facts.spacing = 0.0139;
    facts.fluid_particles = 32768;
    facts.boundary_particles = 163540;
    facts.counts_fluid = true;
    return facts;
  }
  static Rates rates() {
    Rates rates;
    rates.real_time = 0.98;
    rates.step_rate = 541.0;
    rates.step_ms = 1.13;
    rates.device_rate = 1000.0;
    return rates;
  }
  static Snapshot snapshot(std::size_t hands, std::uint32_t status = 0) {
    Snapshot snapshot;
    snapshot.rigid.status = status;
    snapshot.rigid.grips.resize(hands);
    for (GripState& grip : snapshot.rigid.grips) grip.on_hand = {{0.0, -118.25, 0.0}, {0.0, 12.125, 0.0}};
    snapshot.fluid_index.assign(1000, 255);
    return snapshot;
  }
  template <class Draw>
  static void frame(Draw&& draw) {
    ImGui::NewFrame();
    draw();
    ImGui::Render();
  }
  static void expect_sound(const Hud& hud, const std::string& what) {
    const auto [run, hands] = hud.panels();
    EXPECT_LE(area(run) + area(hands), picture().x * picture().y / 3.0f + 1.0f) << what;
    EXPECT_EQ(run.shared_area(hands), 0.0f) << what;
    EXPECT_LE(outside(), 0.5f) << what;
    EXPECT_LE(cut_off_below(), 1.0f) << what;
    EXPECT_LE(cut_off_right(), 1.0f) << what;
    EXPECT_GT(area(run), 0.0f) << what;
  }
};

TEST_P(HudSizes, PanelsCoverNoMoreThanAThirdWhateverIsSaid) {
  for (const std::size_t hands : {0u, 1u, 2u, 4u}) {
    const Scene bare = scene(hands);
    Hud hud(bare, facts());
    Rates said = rates();
    hud.record(snapshot(hands));
    frame([&] { hud.draw(said); });
    expect_sound(hud, std::to_string(hands) + " hands");
    hud.record(snapshot(hands, ~0u));
    said.lost = 12;
    said.status_steps.fill(123456);
    said.budgets = "left: 25.0 N asked of a device of 8.0 N\nright: 31.5 N asked of a device of 8.0 N";
    said.people = "Ana: left_hand\nBen: right_hand\nZoe looks on\nHugo looks on";
    said.connection = "203.0.113.7:4433, 12 ms there and back, 1.2 MB/s";
    frame([&] { hud.draw(said); });
    expect_sound(hud, std::to_string(hands) + " hands, with every warning");
  }
}

TEST_P(HudSizes, ATaskHasItsPlaceBesideThem) {
  for (const std::size_t hands : {0u, 1u, 2u, 4u}) {
    const Scene bare = scene(hands);
    Hud hud(bare, facts());
    hud.record(snapshot(hands));
    Rates said = rates();
    frame([&] { hud.draw(said); });
    EXPECT_EQ(area(hud.task_panel()), 0.0f);
    said.task = {"step 2 of 12, 8 s left", "Pour until the pan holds 0.4 kg.",
                 "fluid in pan_inside 0.021 kg, wanted at least 0.4", ""};
    const std::string long_words(400, 'w');  // of a host that means no good
    for (const TaskLines& lines :
         {TaskLines{long_words, "x", "", ""}, TaskLines{"step", long_words, long_words, long_words}}) {
      Rates rude = rates();
      rude.task = lines;
      frame([&] { hud.draw(rude); });
      EXPECT_LE(area(hud.task_panel()), 0.34f * picture().x * picture().y);
      EXPECT_LE(outside(), 0.5f);
    }
    for (const char* words :
         {"Slowly.",
          "Tilt the bowl further: batter is thick, and takes its time until it runs over the lip and into "
          "the pan's middle, from where it spreads by itself."}) {
      said.task.hint = words;
      frame([&] { hud.draw(said); });
      const Rect task = hud.task_panel();
      EXPECT_GT(area(task), 0.0f);
      EXPECT_LE(area(task), 0.3f * picture().x * picture().y);
      for (const Rect& other : hud.panels()) EXPECT_EQ(task.shared_area(other), 0.0f) << hands << " hands";
      EXPECT_LE(outside(), 0.5f);
      EXPECT_LE(cut_off_below(), 1.0f);
      EXPECT_LE(cut_off_right(), 1.0f);
    }
  }
}

/// What a film shows of them: hands and bowls move, warnings and rates come and go.
TEST_P(HudSizes, PanelsStayWhereTheyAreThroughAFilm) {
  const Scene bare = scene(2);
  Hud hud(bare, facts());
  std::vector<glm::vec2> corners;
  for (int i = 0; i < 40; ++i) {
    const float x = 0.025f * static_cast<float>(i);
    hud.keep_clear = {{{x - 0.2f, 0.0f}, {x + 0.2f, 0.6f}}, {{0.8f - x, 0.5f}, {1.2f - x, 1.0f}}};
    hud.record(snapshot(2, i % 7 == 3 ? kStatusSpeedLimited : 0));
    frame([&] { hud.draw(i < 5 ? Rates{} : rates()); });
    const auto [run, hands] = hud.panels();
    corners.push_back(run.low);
    corners.push_back(hands.low);
    EXPECT_EQ(corners[0], run.low) << i;
    EXPECT_EQ(corners[1], hands.low) << i;
    EXPECT_EQ(hands.high.x - hands.low.x, hud.panels()[1].high.x - hud.panels()[1].low.x);
  }
}

TEST_P(HudSizes, TheHelpFits) {
  WindowGuide guide;
  GuideFacts facts;
  facts.can_grab = facts.shared = facts.may_change = facts.may_pace = true;
  facts.hands = 2;
  guide.show_all = true;
  frame([&] { guide.draw(facts, 0.0, {}); });
  EXPECT_GT(ImGui::GetDrawData()->TotalVtxCount, 4 * 500) << "four a letter";
  EXPECT_LE(outside(), 0.5f);
  EXPECT_LE(cut_off_below(), 1.0f);
  EXPECT_LE(cut_off_right(), 1.0f);
}

TEST_P(HudSizes, HintsAndSlidersFit) {
  WindowGuide guide;
  GuideFacts facts;
  facts.can_grab = true;
  guide.say("the picture is in /home/somebody/simulations/buckets/out/bucket-12/picture-3.png", 0.0);
  frame([&] { guide.draw(facts, 1.0, {}); });
  EXPECT_GT(ImGui::GetDrawData()->TotalVtxCount, 0);
  EXPECT_LE(outside(), 0.5f);
  EXPECT_LE(cut_off_right(), 1.0f);

  LivePanel panel({"water"}, {"left_hand", "right_hand"});
  panel.shown = true;
  LiveValues values;
  values.may_change = values.may_pace = true;
  values.viscosities = {1.0};
  values.grips = {{1.0, 500.0, 0.0}, {1.0, 500.0, 200.0}};
  frame([&] { panel.draw(values, 0.0, {}); });
  EXPECT_LE(outside(), 0.5f);
  EXPECT_LE(cut_off_below(), 1.0f);
  EXPECT_LE(cut_off_right(), 1.0f);
  EXPECT_LE(area(panel.panel()), picture().x * picture().y / 3.0f);
}

std::vector<WindowSize> windows() {
  std::vector<WindowSize> all;
  for (const auto& [width, height] : {std::pair{480, 320},
                                      {640, 480},
                                      {800, 600},
                                      {960, 540},
                                      {1280, 720},
                                      {1920, 1080},
                                      {1080, 1920},
                                      {2560, 1440},
                                      {3840, 2160}}) {
    for (const float letters : {0.75f, 1.0f, 1.5f, 2.0f}) all.push_back({width, height, letters});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(Windows, HudSizes, ::testing::ValuesIn(windows()), [](const auto& p) {
  return std::to_string(p.param.width) + "x" + std::to_string(p.param.height) + "Letters" +
         std::to_string(static_cast<int>(100.0f * p.param.letters));
});

}  // namespace
}  // namespace slosh
