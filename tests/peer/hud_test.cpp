// The numbers over the picture, drawn by Dear ImGui without a GPU and looked at as triangles.
#include "peer/view/hud/hud.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <array>
#include <string>

#include "hud_kit.h"
#include "render/passes/hud_pass.h"

namespace slosh {
namespace {

TEST(StripChart, StartsEmptyAndDrawsOnlyWhatWasMeasured) {
  StripChart chart(150, 1.0f);
  EXPECT_TRUE(chart.curve({0, 0}, {149, 34}).empty()) << "no force step that never was";
  for (int i = 0; i < 3; ++i) chart.add(10.0f);
  const std::vector<glm::vec2> curve = chart.curve({0, 0}, {149, 34});
  ASSERT_EQ(curve.size(), 3u);
  EXPECT_FLOAT_EQ(curve.back().x, 149.0f);
  EXPECT_FLOAT_EQ(curve.front().x, 147.0f);
  for (const glm::vec2& p : curve) EXPECT_NEAR(p.y, 34.0f - 34.0f / 1.05f, 1e-4f);
}

TEST(StripChart, KeepsTheNewestAndTheLargest) {
  StripChart chart(4, 1.0f);
  for (const float value : {8.0f, 1.0f, 2.0f, 3.0f, 4.0f}) chart.add(value);
  EXPECT_EQ(chart.size(), 4u);
  EXPECT_EQ(chart.top(), 8.0f);
  const std::vector<glm::vec2> curve = chart.curve({0, 0}, {3, 8.4f});
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(curve[i].y, 8.4f - static_cast<float>(i + 1), 1e-4f);
}

TEST(Panels, GoWhereTheyHideLeast) {
  const std::array<glm::vec2, 2> places{glm::vec2(0, 0), glm::vec2(500, 0)};
  const std::array<Rect, 1> left{Rect{{50, 50}, {150, 150}}};
  const std::array<Rect, 1> right{Rect{{550, 50}, {650, 150}}};
  EXPECT_EQ(place_panel({200, 200}, places, {}, {-1, -1}), places[0]) << "the first where all are free";
  EXPECT_EQ(place_panel({200, 200}, places, left, {-1, -1}), places[1]);
  EXPECT_EQ(place_panel({200, 200}, places, {}, places[1]), places[1]) << "it stays where it is";
  EXPECT_EQ(place_panel({200, 200}, places, right, places[1]), places[0]);
}

TEST(HudFont, GrowsWithThePicture) {
  EXPECT_EQ(hud_font_pixels(480.0f), 13);
  EXPECT_EQ(hud_font_pixels(1080.0f), 21);
  EXPECT_EQ(hud_font_pixels(2160.0f), 42);
  EXPECT_EQ(hud_font_pixels(1e6f), 96);
}

class HudTest : public test::PanelTest {
 protected:
  static void draw(Hud& hud, const Rates& rates = {}) {
    ImGui::NewFrame();
    hud.draw(rates);
    ImGui::Render();
  }
  /// Vertices of the panel after a step at `time` (s) with these status bits.
  static int drawn_with(Hud& hud, double time, std::uint32_t status) {
    Snapshot snapshot;
    snapshot.rigid.time = time;
    snapshot.rigid.status = status;
    hud.record(snapshot);
    draw(hud);
    return ImGui::GetDrawData()->TotalVtxCount;
  }
  static float cut_off() { return cut_off_below(); }
  static Scene scene() {
    Scene scene;
    scene.grips.resize(2);
    scene.grips[0].name = "left";
    scene.grips[1].name = "right";
    return scene;
  }
  static HudFacts facts() {
    HudFacts facts;
    facts.title = "a run";
    facts.fluid_particles = 1000;
    return facts;
  }
};

TEST_F(HudTest, AWarningIsWholeFromItsFirstPictureOn) {
  const Scene bare = scene();
  Hud hud(bare, facts());
  Snapshot snapshot;
  snapshot.rigid.grips.resize(2);
  for (int i = 0; i < 3; ++i) {
    hud.record(snapshot);
    draw(hud);
  }
  EXPECT_LE(cut_off(), 1.0f);
  snapshot.rigid.time = 0.1;
  snapshot.rigid.status = kStatusSpeedLimited | kStatusForceLimited;
  hud.record(snapshot);
  draw(hud);
  EXPECT_LE(cut_off(), 1.0f) << "px of it hidden";
}

TEST_F(HudTest, AWarningOfOneStepCanBeRead) {
  const Scene bare = scene();
  Hud hud(bare, facts());
  const auto vertices = [&](double time, std::uint32_t status) { return drawn_with(hud, time, status); };
  const int without = vertices(1.0, 0);
  const int with = vertices(1.1, kStatusSpeedLimited);
  EXPECT_GT(with, without);
  EXPECT_GT(vertices(2.0, 0), without) << "it stays";
  EXPECT_LE(vertices(5.0, 0), without + 8) << "and goes; the time may have another digit";
}

TEST_F(HudTest, AForceBudgetIsShownWhileADeviceClips) {
  const Scene bare = scene();
  Hud hud(bare, facts());
  hud.record(Snapshot{});
  const auto vertices = [&](const std::string& budgets) {
    Rates rates;
    rates.budgets = budgets;
    draw(hud, rates);
    return ImGui::GetDrawData()->TotalVtxCount;
  };
  const int without = vertices("");
  EXPECT_GT(vertices("left: 25.0 N asked of a device of 8.0 N"), without + 4 * 25) << "four a letter";
  EXPECT_LE(cut_off(), 1.0f);
  EXPECT_EQ(vertices(""), without);
}

TEST_F(HudTest, WallsThatHoldAreNoWarningUnlessTheyCrush) {
  const Scene bare = scene();
  Hud hud(bare, facts());
  const auto vertices = [&](double time, std::uint32_t status) { return drawn_with(hud, time, status); };
  const int without = vertices(1.0, 0);
  EXPECT_EQ(vertices(1.1, kStatusClamped), without);
  const int crushed = vertices(3.0, kStatusCompressed);
  EXPECT_GT(crushed, without);
  EXPECT_GT(vertices(3.1, kStatusClamped | kStatusCompressed), crushed) << "then both are said";
}

/// What left the world is counted in the snapshot and named by how; spilling is no warning.
TEST_F(HudTest, SpillingIsARowAndNoWarning) {
  const Scene bare = scene();
  HudFacts counted = facts();
  counted.counts_fluid = true;
  const auto colours = [&](const HudFacts& of, std::uint64_t lost) {
    Hud hud(bare, of);
    Snapshot snapshot;
    snapshot.rigid.status = kStatusEscaped;
    snapshot.fluid_index.assign(100, 0);
    std::fill_n(snapshot.fluid_index.begin(), 37, std::uint8_t{255});
    hud.record(snapshot);
    Rates rates;
    rates.lost = lost;
    draw(hud, rates);
    int orange = 0;
    const ImDrawData* data = ImGui::GetDrawData();
    for (int i = 0; i < data->CmdListsCount; ++i)
      for (const ImDrawVert& vertex : data->CmdLists[i]->VtxBuffer)
        orange +=
            (vertex.col & 0xffffffu) == (ImGui::GetColorU32(ImVec4(1.0f, 0.78f, 0.35f, 1.0f)) & 0xffffffu);
    return std::pair(orange, data->TotalVtxCount);
  };
  const auto [orange, spilled] = colours(counted, 0);
  EXPECT_EQ(orange, 0);
  EXPECT_GT(colours(counted, 3).second, spilled) << "lost has its own row";
  HudFacts leaky = counted;
  leaky.walls_hold = false;
  EXPECT_GT(colours(leaky, 0).first, 0) << "where walls do not hold, it may have gone through one";
  EXPECT_GT(colours(facts(), 0).second, 0);
  EXPECT_EQ(colours(facts(), 0).first, 0) << "over a network too";
}

TEST_F(HudTest, FourHandsHideNoneOfTheirGlasses) {
  // As the scene spin has them: across the picture, at half its height.
  Scene many = scene();
  many.grips.resize(4);
  Hud hud(many, facts());
  hud.keep_clear.clear();
  for (const float x : {0.13f, 0.38f, 0.62f, 0.87f})
    hud.keep_clear.push_back({{x - 0.06f, 0.37f}, {x + 0.06f, 0.58f}});
  Snapshot snapshot;
  snapshot.rigid.grips.resize(4);
  hud.record(snapshot);
  draw(hud);
  const ImDrawData* data = ImGui::GetDrawData();
  for (int i = 0; i < data->CmdListsCount; ++i) {
    for (const ImDrawCmd& command : data->CmdLists[i]->CmdBuffer) {
      const Rect panel{{command.ClipRect.x, command.ClipRect.y}, {command.ClipRect.z, command.ClipRect.w}};
      if (panel.high.x - panel.low.x > 639.0f) continue;  // the whole picture: no panel's
      for (const Rect& glass : hud.keep_clear) {
        const glm::vec2 size(640.0f, 480.0f);
        EXPECT_EQ(panel.shared_area({glass.low * size, glass.high * size}), 0.0f);
      }
    }
  }
  EXPECT_LE(cut_off(), 1.0f);
}

TEST_F(HudTest, TorqueIsDrawnToo) {
  const Scene bare = scene();
  const auto indices = [&](double torque) {
    Hud hud(bare, facts());
    Snapshot snapshot;
    snapshot.rigid.grips.resize(2);
    snapshot.rigid.grips[0].on_hand.torque = {torque, 0.0, 0.0};
    std::vector<float> heights;
    for (int i = 0; i < 40; ++i) hud.record(snapshot);
    draw(hud);
    std::vector<ImVec2> places;
    const ImDrawData* data = ImGui::GetDrawData();
    for (int i = 0; i < data->CmdListsCount; ++i) {
      for (const ImDrawVert& vertex : data->CmdLists[i]->VtxBuffer) places.push_back(vertex.pos);
    }
    return places;
  };
  const std::vector<ImVec2> none = indices(0.0);
  const std::vector<ImVec2> some = indices(0.04);
  ASSERT_EQ(none.size(), some.size()) << "numbers of as many digits";
  int moved = 0;
  for (std::size_t i = 0; i < none.size(); ++i) moved += std::abs(none[i].y - some[i].y) > 4.0f ? 1 : 0;
  EXPECT_GT(moved, 40) << "a curve of torque went up";
}

}  // namespace
}  // namespace slosh
