#include "peer/view/live_panel.h"

#include <imgui.h>

#include <algorithm>

#include "peer/view/hud/hud_layout.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr float kWidth = 150.0f;   // px, at least
constexpr float kLetters = 19.0f;  // of a slider: as wide as those
constexpr float kPanelMargin = 8.0f;
constexpr float kSmallest = 0.35f;       // letters, times their size
constexpr double kSendEvery = 0.1;       // s, while a slider is dragged
constexpr float kMinViscosity = 1e-3f;   // Pa·s: water's
constexpr float kMaxViscosity = 100.0f;  // above it the host may say by itself what it cannot do
constexpr float kSlowest = 0.05f;
constexpr float kMaxFilter = 16.0f;
constexpr float kSoftest = 0.05f,
                kStiffest = 4.0f;  // of a grip, times the scene's: what World::set_grip_stiffness takes

}  // namespace

std::string grip_text(const LiveGrip& grip) {
  const double spring = grip.stiffness * grip.of_scene;
  if (!(grip.of_scene > 0.0)) return "";
  if (grip.of_device > 0.0 && spring > grip.of_device)
    return format("= %.4g N/m, felt as %.4g", spring, grip.of_device);
  return format("= %.4g N/m", spring);
}

void LivePanel::slider(const Row& row, float width, double wall_seconds) {
  if (sliders_.size() <= row.id) sliders_.resize(row.id + 1);
  Slider& s = sliders_[row.id];
  if (!s.active) s.shown = static_cast<float>(row.now);
  ImGui::PushID(static_cast<int>(row.id));
  ImGui::TextUnformatted(row.label.c_str());
  ImGui::SetNextItemWidth(width);
  const ImGuiSliderFlags flags =
      (row.logarithmic ? ImGuiSliderFlags_Logarithmic : 0) | ImGuiSliderFlags_AlwaysClamp;
  // Kept until it is sent: a mouse that stops within the pause sends what it stopped at, too.
  s.unsent |= ImGui::SliderFloat("##value", &s.shown, row.least, row.most, row.pattern, flags);
  const bool ended = ImGui::IsItemDeactivatedAfterEdit();
  s.active = ImGui::IsItemActive();
  if ((s.unsent && wall_seconds - s.sent_at >= kSendEvery) || ended) {
    s.unsent = false;
    s.sent_at = wall_seconds;
    wishes_.push_back(row.wish);
    wishes_.back().value = static_cast<double>(s.shown);
  }
  ImGui::PopID();
}

std::vector<LivePanel::Row> LivePanel::rows_of(const LiveValues& now) const {
  using Kind = LiveWish::Kind;
  std::vector<Row> rows;
  const auto add = [&](std::size_t id, std::string label, const char* pattern, float least, float most,
                       bool logarithmic, double value, const LiveWish& wish) {
    rows.push_back({id, std::move(label), pattern, least, most, logarithmic, value, wish});
  };
  if (now.may_pace) add(0, "pace", "\xC3\x97 %.2f", kSlowest, 1.0f, true, now.pace, {Kind::kPace, 0, 0.0});
  add(1, "surface filter", "%.0f iterations", 0.0f, kMaxFilter, false, now.filter, {Kind::kFilter, 0, 0.0});
  if (now.may_change) {
    add(2, "gravity", "\xC3\x97 %.2f", 0.0f, 2.0f, false, now.gravity_scale, {Kind::kGravityScale, 0, 0.0});
    for (std::size_t i = 0; i < now.viscosities.size() && i < fluid_names_.size(); ++i)
      add(3 + i, "viscosity of " + fluid_names_[i], "%.4g Pa\xC2\xB7s", kMinViscosity, kMaxViscosity, true,
          now.viscosities[i], {Kind::kViscosity, i, 0.0});
  }
  for (std::size_t i = 0; i < now.grips.size() && i < grip_names_.size(); ++i) {
    if (!now.grips[i].may_set) continue;
    add(3 + fluid_names_.size() + i, "stiffness of " + grip_names_[i] + " " + grip_text(now.grips[i]),
        "\xC3\x97 %.2f", kSoftest, kStiffest, true, now.grips[i].stiffness, {Kind::kGripStiffness, i, 0.0});
  }
  return rows;
}

LivePanel::Size LivePanel::size_of(const std::vector<Row>& rows, const glm::vec2& picture) {
  const ImGuiStyle& style = ImGui::GetStyle();
  Size size;
  for (; size.letters > kSmallest; size.letters -= 0.05f) {
    size.slider = std::max(kWidth, kLetters * size.letters * ImGui::CalcTextSize("0").x);
    float width = size.slider;
    for (const Row& row : rows)
      width = std::max(width, size.letters * ImGui::CalcTextSize(row.label.c_str()).x);
    const float each =
        2.0f * size.letters * (ImGui::GetTextLineHeight() + style.ItemSpacing.y + style.FramePadding.y);
    size.panel =
        glm::vec2(width, static_cast<float>(rows.size()) * each - size.letters * style.ItemSpacing.y) +
        2.0f * glm::vec2(style.WindowPadding.x, style.WindowPadding.y);
    const bool fits = glm::all(glm::lessThan(size.panel, picture - 2.0f * kPanelMargin));
    if (fits && size.panel.x * size.panel.y <= kMaxCovered * picture.x * picture.y) break;
  }
  return size;
}

void LivePanel::draw(const LiveValues& now, double wall_seconds, std::span<const Rect> taken) {
  if (!shown) return;
  const glm::vec2 picture(ImGui::GetIO().DisplaySize.x, ImGui::GetIO().DisplaySize.y);
  const std::vector<Row> rows = rows_of(now);
  const Size size = size_of(rows, picture);
  const glm::vec2 right(picture.x - kPanelMargin - size.panel.x, kPanelMargin);
  const bool left =
      covered_area(right, size.panel, taken) > covered_area({kPanelMargin, kPanelMargin}, size.panel, taken);
  panel_.low = left ? glm::vec2(kPanelMargin) : right;
  panel_.high = panel_.low + size.panel;
  ImGui::SetNextWindowPos(ImVec2(panel_.low.x, panel_.low.y));
  ImGui::SetNextWindowSize(ImVec2(size.panel.x, size.panel.y));
  ImGui::SetNextWindowBgAlpha(0.7f);
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                                      ImGuiWindowFlags_NoFocusOnAppearing;
  if (ImGui::Begin("live", nullptr, kFlags)) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const auto smaller = [&](ImVec2 of) { return ImVec2(size.letters * of.x, size.letters * of.y); };
    ImGui::SetWindowFontScale(size.letters);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, smaller(style.FramePadding));
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, smaller(style.ItemSpacing));
    for (const Row& row : rows) slider(row, size.slider, wall_seconds);
    ImGui::PopStyleVar(2);
  }
  ImGui::End();
}

std::vector<LiveWish> LivePanel::take_wishes() {
  std::vector<LiveWish> taken;
  taken.swap(wishes_);
  return taken;
}

}  // namespace slosh
