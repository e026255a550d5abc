#include "peer/view/live_panel.h"

#include <imgui.h>

#include <algorithm>

#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr float kWidth = 150.0f;  // px
constexpr float kMargin = 8.0f;
constexpr double kSendEvery = 0.1;        // s, while a slider is dragged
constexpr float kLeastViscosity = 1e-3f;  // Pa·s: water's
constexpr float kMostViscosity = 100.0f;  // above it the host may say by itself what it cannot do
constexpr float kSlowest = 0.05f;
constexpr float kMostFilter = 16.0f;
constexpr float kSoftest = 0.05f, kStiffest = 4.0f;  // of a grip, times the scene's: what World::set_grip_stiffness takes

}  // namespace

std::string grip_text(const LiveGrip& grip) {
  const double spring = grip.stiffness * grip.of_scene;
  if (!(grip.of_scene > 0.0)) return "";
  if (grip.of_device > 0.0 && spring > grip.of_device)
    return format("= %.4g N/m, felt as %.4g", spring, grip.of_device);
  return format("= %.4g N/m", spring);
}

void LivePanel::slider(std::size_t id, const char* label, const char* pattern, float least, float most,
                       bool logarithmic, double now, double wall_seconds, const LiveWish& wish) {
  if (sliders_.size() <= id) sliders_.resize(id + 1);
  Slider& s = sliders_[id];
  if (!s.active) s.shown = static_cast<float>(now);
  ImGui::PushID(static_cast<int>(id));
  ImGui::TextUnformatted(label);
  ImGui::SetNextItemWidth(kWidth);
  const ImGuiSliderFlags flags =
      (logarithmic ? ImGuiSliderFlags_Logarithmic : 0) | ImGuiSliderFlags_AlwaysClamp;
  const bool changed = ImGui::SliderFloat("##value", &s.shown, least, most, pattern, flags);
  const bool ended = ImGui::IsItemDeactivatedAfterEdit();
  s.active = ImGui::IsItemActive();
  if ((changed && wall_seconds - s.sent_at >= kSendEvery) || ended) {
    s.sent_at = wall_seconds;
    wishes_.push_back(wish);
    wishes_.back().value = static_cast<double>(s.shown);
  }
  ImGui::PopID();
}

void LivePanel::draw(const LiveValues& now, double wall_seconds, std::span<const Rect> taken) {
  if (!shown) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const glm::vec2 panel(kWidth + 2.0f * ImGui::GetStyle().WindowPadding.x, 0.5f * size.y);
  const bool left = covered_area({size.x - kMargin - panel.x, kMargin}, panel, taken) >
                    covered_area({kMargin, kMargin}, panel, taken);
  ImGui::SetNextWindowPos(ImVec2(left ? kMargin : size.x - kMargin, kMargin), ImGuiCond_Always,
                          ImVec2(left ? 0.0f : 1.0f, 0.0f));
  ImGui::SetNextWindowBgAlpha(0.7f);
  constexpr ImGuiWindowFlags kFlags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                      ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                                      ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_AlwaysAutoResize;
  if (ImGui::Begin("live", nullptr, kFlags)) {
    if (now.may_pace) {
      slider(0, "pace", "\xC3\x97 %.2f", kSlowest, 1.0f, true, now.pace, wall_seconds,
             {LiveWish::Kind::kPace, 0, 0.0});
    }
    slider(1, "surface filter", "%.0f turns", 0.0f, kMostFilter, false, now.filter, wall_seconds,
           {LiveWish::Kind::kFilter, 0, 0.0});
    if (now.may_change) {
      slider(2, "gravity", "\xC3\x97 %.2f", 0.0f, 2.0f, false, now.gravity_scale, wall_seconds,
             {LiveWish::Kind::kGravityScale, 0, 0.0});
      for (std::size_t i = 0; i < now.viscosities.size() && i < fluid_names_.size(); ++i) {
        const std::string label = "viscosity of " + fluid_names_[i];
        slider(3 + i, label.c_str(), "%.4g Pa\xC2\xB7s", kLeastViscosity, kMostViscosity, true,
               now.viscosities[i], wall_seconds, {LiveWish::Kind::kViscosity, i, 0.0});
      }
    }
    for (std::size_t i = 0; i < now.grips.size() && i < grip_names_.size(); ++i) {
      if (!now.grips[i].may_set) continue;
      const std::string label = "stiffness of " + grip_names_[i] + " " + grip_text(now.grips[i]);
      slider(3 + fluid_names_.size() + i, label.c_str(), "\xC3\x97 %.2f", kSoftest, kStiffest, true,
             now.grips[i].stiffness, wall_seconds, {LiveWish::Kind::kGripStiffness, i, 0.0});
    }
  }
  ImGui::End();
}

std::vector<LiveWish> LivePanel::take_wishes() {
  std::vector<LiveWish> taken;
  taken.swap(wishes_);
  return taken;
}

}  // namespace slosh
