#include "peer/hud/hud.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "peer/output/summary.h"
#include "peer/palette.h"

namespace slosh {
namespace {

constexpr double kChartSeconds = 5.0;
constexpr double kStatusSeconds = 1.5;  // simulated: a status of one step is shown long enough to be read
// In letters "0" wide and lines high: panels grow with the font, and the font with the picture.
constexpr float kPanelLetters = 27.0f;   // leaves 640 × 480 mostly to the picture
constexpr float kNarrowLetters = 18.5f;  // a hand's, where they stand beside each other
constexpr float kChartLines = 1.7f;
constexpr float kMargin = 8.0f;
constexpr float kLeastHeight = 400.0f;  // px: a smaller picture gets the time and what is wrong, no more
constexpr float kLeastForce = 1.0f;     // N, that a chart's height is at least
constexpr float kLeastTorque = 0.05f;   // N·m

constexpr ImGuiWindowFlags kPanel = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                    ImGuiWindowFlags_NoNav;

/// Brighter than on paper: the panel is dark.
ImVec4 bright(const DeviceColor& color) {
  const glm::vec3 c = glm::mix(color.srgb, glm::vec3(1.0f), 0.35f);
  return {c.r, c.g, c.b, 1.0f};
}

template <class... Numbers>
PanelRow labelled(const char* label, const char* pattern, Numbers... numbers) {
  char text[96];
  std::snprintf(text, sizeof text, pattern, numbers...);
  return {PanelRow::Kind::kLabelled, label, text};
}

glm::vec2 panel_size(float height, float width) {
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  return {width + 2.0f * padding.x, height + 2.0f * padding.y};
}

std::vector<Rect> clear_of(std::vector<Rect> shares, const glm::vec2& picture) {
  for (Rect& rect : shares) rect = {rect.low * picture, rect.high * picture};
  return shares;
}

float panel_width() {
  return kPanelLetters * ImGui::CalcTextSize("0").x;
}

/// A number's last seconds, beside it the number itself.
void draw_strip(const StripChart& strip, float width, const ImVec4& color, const char* pattern,
                double value) {
  char text[32];
  std::snprintf(text, sizeof text, pattern, value);
  const float letter = ImGui::CalcTextSize("0").x;
  const float height = kChartLines * ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 end(at.x + width - 11.0f * letter, at.y + height);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(at, end, IM_COL32(255, 255, 255, 16));
  std::vector<ImVec2> points;
  for (const glm::vec2& p : strip.curve({at.x, at.y}, {end.x, end.y})) points.emplace_back(p.x, p.y);
  list->AddPolyline(points.data(), static_cast<int>(points.size()), ImGui::GetColorU32(color), 0,
                    0.1f * ImGui::GetFontSize());
  list->AddText(ImVec2(end.x + letter, at.y + 0.5f * (height - ImGui::GetTextLineHeight())),
                ImGui::GetColorU32(ImGuiCol_Text), text);
  ImGui::Dummy(ImVec2(width, height));
}

}  // namespace

std::string status_lines(std::uint32_t status, const std::array<std::uint64_t, 32>& steps) {
  std::string lines;
  for (std::size_t bit = 0; bit < steps.size(); ++bit) {
    const std::string text = status_text(status & (1u << bit));
    if (text.empty()) continue;
    if (!lines.empty()) lines += '\n';
    lines += text;
    if (steps[bit] > 0) lines += " (in " + grouped(steps[bit]) + (steps[bit] == 1 ? " step)" : " steps)");
  }
  return lines;
}

Hud::Hud(const Scene& scene, HudFacts facts) : facts_(std::move(facts)) {
  const auto samples = static_cast<std::size_t>(std::max(2.0, kChartSeconds * facts_.picture_rate));
  for (const Grip& grip : scene.grips)
    hands_.push_back({grip.name, StripChart(samples, kLeastForce), StripChart(samples, kLeastTorque), {}});
}

void Hud::record(const Snapshot& snapshot) {
  const double before = time_;
  time_ = snapshot.rigid.time;
  if (time_ < before) status_until_.fill(-1.0);  // the world started again
  for (std::size_t bit = 0; bit < status_until_.size(); ++bit) {
    if (snapshot.rigid.status & (1u << bit)) status_until_[bit] = time_ + kStatusSeconds;
  }
  for (std::size_t i = 0; i < hands_.size() && i < snapshot.rigid.grips.size(); ++i) {
    Hand& hand = hands_[i];
    hand.now = snapshot.rigid.grips[i].on_hand;
    hand.force.add(static_cast<float>(glm::length(hand.now.force)));
    hand.torque.add(static_cast<float>(glm::length(hand.now.torque)));
  }
}

std::uint32_t Hud::status() const {
  std::uint32_t status = 0;
  for (std::size_t bit = 0; bit < status_until_.size(); ++bit) {
    if (status_until_[bit] >= time_) status |= 1u << bit;
  }
  // That walls held something back is how they hold; alone it asks for nothing (README.md, Warnings).
  if (!(status & kStatusCompressed)) status &= ~static_cast<std::uint32_t>(kStatusGuarded);
  return status;
}

std::vector<PanelRow> Hud::run_rows(const Rates& rates, bool brief) const {
  using Kind = PanelRow::Kind;
  std::vector<PanelRow> rows{{Kind::kTitle, facts_.title, {}}, {Kind::kLine, {}, {}}};
  rows.push_back(labelled("time", "%.2f s%s", time_, paused ? "  paused" : ""));
  if (!brief) {
    if (rates.real_time > 0.0) rows.push_back(labelled("real time", "\xC3\x97 %.2f", rates.real_time));
    if (rates.step_rate > 0.0)
      rows.push_back(labelled("steps", "%.0f Hz  %.2f ms", rates.step_rate, rates.step_ms));
    if (rates.device_rate > 0.0) rows.push_back(labelled("devices", "%.0f Hz", rates.device_rate));
    rows.push_back(labelled("fluid", "%zu", facts_.fluid_particles));
    if (facts_.boundary_particles > 0) rows.push_back(labelled("bodies", "%zu", facts_.boundary_particles));
    rows.push_back(labelled("spacing", "%.1f mm", 1e3 * facts_.spacing));
    for (const std::string* lines : {&rates.people, &rates.connection}) {
      if (lines->empty()) continue;
      rows.push_back({Kind::kLine, {}, {}});
      rows.push_back({Kind::kText, *lines, {}});
    }
  }
  const std::string warning = status_lines(status() | rates.device_status, rates.status_steps);
  for (const std::string& lines : {warning, rates.budgets})
    if (!lines.empty()) rows.push_back({Kind::kWarning, lines, {}});
  return rows;
}

void Hud::draw_hand(std::size_t device, float width) const {
  const Hand& hand = hands_[device];
  const ImVec4 color = bright(device_color(device));
  ImGui::TextColored(color, "%s", hand.grip.c_str());
  draw_strip(hand.force, width, color, "%7.2f N", glm::length(hand.now.force));
  draw_strip(hand.torque, width, color, "%7.3f Nm", glm::length(hand.now.torque));
}

void Hud::draw_run(const Rates& rates, const glm::vec2& picture, bool brief) {
  const std::vector<PanelRow> rows = run_rows(rates, brief);
  const glm::vec2 size = panel_size(rows_height(rows, panel_width()), panel_width());
  const std::array<glm::vec2, 2> places{glm::vec2(kMargin), glm::vec2(picture.x - kMargin - size.x, kMargin)};
  run_panel_.low = place_panel(size, places, clear_of(keep_clear, picture), run_panel_.low);
  run_panel_.high = run_panel_.low + size;
  ImGui::SetNextWindowPos(ImVec2(run_panel_.low.x, run_panel_.low.y));
  ImGui::SetNextWindowSize(ImVec2(size.x, size.y));
  ImGui::SetNextWindowBgAlpha(0.55f);
  if (ImGui::Begin("run", nullptr, kPanel)) draw_rows(rows, panel_width());
  ImGui::End();
}

void Hud::draw_hands(const glm::vec2& picture) {
  const float hand =
      (1.0f + 2.0f * kChartLines) * ImGui::GetTextLineHeight() + 3.0f * ImGui::GetStyle().ItemSpacing.y;
  const auto count = static_cast<float>(hands_.size());
  const float narrow = kNarrowLetters * ImGui::CalcTextSize("0").x;
  const glm::vec2 column = panel_size(count * hand, panel_width());
  const glm::vec2 row = panel_size(hand, count * narrow);
  // The run's panel must stay free too, and first of all.
  std::vector<Rect> clear = clear_of(keep_clear, picture);
  clear.insert(clear.end(), 4, run_panel_);
  const auto place = [&](const glm::vec2& size) {
    const glm::vec2 far = picture - size - kMargin;
    const std::array<glm::vec2, 4> places{glm::vec2(kMargin, far.y), far, glm::vec2(far.x, kMargin),
                                          glm::vec2(kMargin)};
    return place_panel(size, places, clear, hands_panel_.low);
  };
  // Many hands below each other may hide one: then beside each other, if that hides less.
  const glm::vec2 column_at = place(column);
  const glm::vec2 row_at = place(row);
  const float by_column = covered_area(column_at, column, clear);
  const float by_row = covered_area(row_at, row, clear);
  const bool fits = hands_.size() > 1 && row.x + 2.0f * kMargin < picture.x;
  in_a_row_ = fits && (in_a_row_ ? by_row <= by_column : by_row < 0.5f * by_column);
  const glm::vec2& size = in_a_row_ ? row : column;
  hands_panel_.low = in_a_row_ ? row_at : column_at;
  hands_panel_.high = hands_panel_.low + size;
  ImGui::SetNextWindowPos(ImVec2(hands_panel_.low.x, hands_panel_.low.y));
  ImGui::SetNextWindowSize(ImVec2(size.x, size.y));
  ImGui::SetNextWindowBgAlpha(0.55f);
  if (ImGui::Begin("forces", nullptr, kPanel)) {
    const ImVec2 corner = ImGui::GetCursorPos();
    for (std::size_t i = 0; i < hands_.size(); ++i) {
      if (in_a_row_) ImGui::SetCursorPos(ImVec2(corner.x + narrow * static_cast<float>(i), corner.y));
      ImGui::BeginGroup();
      draw_hand(i, in_a_row_ ? narrow : panel_width());
      ImGui::EndGroup();
    }
  }
  ImGui::End();
}

void Hud::draw(const Rates& rates) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 4.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(6.0f, 2.0f));
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const glm::vec2 picture(size.x, size.y);
  const bool brief = size.y < kLeastHeight;
  draw_run(rates, picture, brief);
  if (!hands_.empty() && !brief) draw_hands(picture);
  ImGui::PopStyleVar(3);
}

}  // namespace slosh
