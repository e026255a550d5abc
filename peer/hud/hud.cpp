#include "peer/hud/hud.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>

#include "peer/output/summary.h"
#include "peer/palette.h"

namespace slosh {
namespace {

constexpr double kChartSeconds = 5.0;
constexpr float kPanelWidth = 186.0f;  // px: leaves 640 × 480 mostly to the picture
constexpr float kChartHeight = 34.0f;
constexpr float kMargin = 8.0f;
constexpr float kLeastHeight = 400.0f;  // px: a smaller picture gets the time and what is wrong, no more

constexpr ImGuiWindowFlags kPanel = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                    ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize;

/// Brighter than on paper: the panel is dark.
ImVec4 bright(const DeviceColor& color) {
  const glm::vec3 c = glm::mix(color.srgb, glm::vec3(1.0f), 0.35f);
  return {c.r, c.g, c.b, 1.0f};
}

void labelled(const char* label, const char* value) {
  ImGui::TextColored(ImVec4(0.72f, 0.76f, 0.80f, 1.0f), "%s", label);
  ImGui::SameLine(80.0f);
  ImGui::TextUnformatted(value);
}

template <class... Numbers>
void labelled(const char* label, const char* pattern, Numbers... numbers) {
  char text[96];
  std::snprintf(text, sizeof text, pattern, numbers...);
  labelled(label, static_cast<const char*>(text));
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
  for (const Grip& grip : scene.grips) {
    Chart chart;
    chart.grip = grip.name;
    chart.force.assign(samples, 0.0f);
    chart.torque.assign(samples, 0.0f);
    charts_.push_back(std::move(chart));
  }
}

void Hud::record(const Snapshot& snapshot) {
  time_ = snapshot.rigid.time;
  status_ = snapshot.rigid.status;
  for (std::size_t i = 0; i < charts_.size() && i < snapshot.rigid.grips.size(); ++i) {
    Chart& chart = charts_[i];
    chart.now = snapshot.rigid.grips[i].on_hand;
    const auto force = static_cast<float>(glm::length(chart.now.force));
    chart.force[next_ % chart.force.size()] = force;
    chart.torque[next_ % chart.torque.size()] = static_cast<float>(glm::length(chart.now.torque));
    chart.top_force = std::max(chart.top_force, force);
  }
  next_ += 1;
}

void Hud::draw_run(const Rates& rates, bool brief) const {
  ImGui::TextUnformatted(facts_.title.c_str());
  ImGui::Separator();
  labelled("time", "%.2f s%s", time_, paused ? "  paused" : "");
  if (!brief) draw_numbers(rates);
  const std::string status = status_lines(status_ | rates.device_status, rates.status_steps);
  if (!status.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.0f, 0.78f, 0.35f, 1.0f));
    ImGui::PushTextWrapPos(kPanelWidth);
    ImGui::TextUnformatted(status.c_str());
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
  }
}

void Hud::draw_numbers(const Rates& rates) const {
  if (rates.real_time > 0.0) labelled("real time", "\xC3\x97 %.2f", rates.real_time);
  if (rates.step_rate > 0.0) labelled("steps", "%.0f Hz  %.2f ms", rates.step_rate, rates.step_ms);
  if (rates.device_rate > 0.0) labelled("devices", "%.0f Hz", rates.device_rate);
  labelled("fluid", "%zu", facts_.fluid_particles);
  if (facts_.boundary_particles > 0) labelled("bodies", "%zu", facts_.boundary_particles);
  labelled("spacing", "%.1f mm", 1e3 * facts_.spacing);
  for (const std::string* lines : {&rates.people, &rates.connection}) {
    if (lines->empty()) continue;
    ImGui::Separator();
    ImGui::PushTextWrapPos(kPanelWidth);
    ImGui::TextUnformatted(lines->c_str());
    ImGui::PopTextWrapPos();
  }
}

void Hud::draw_chart(std::size_t device) const {
  const Chart& chart = charts_[device];
  ImGui::PushID(static_cast<int>(device));
  ImGui::PushStyleColor(ImGuiCol_PlotLines, bright(device_color(device)));
  ImGui::PushStyleColor(ImGuiCol_FrameBg, ImVec4(1.0f, 1.0f, 1.0f, 0.06f));
  ImGui::TextColored(bright(device_color(device)), "%s", chart.grip.c_str());
  ImGui::Text("%6.2f N  %6.3f Nm", glm::length(chart.now.force), glm::length(chart.now.torque));
  ImGui::PlotLines("##force", chart.force.data(), static_cast<int>(chart.force.size()),
                   static_cast<int>(next_ % chart.force.size()), nullptr, 0.0f, 1.05f * chart.top_force,
                   ImVec2(kPanelWidth, kChartHeight));
  ImGui::PopStyleColor(2);
  ImGui::PopID();
}

void Hud::draw_help() const {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos(ImVec2(0.5f * size.x, 0.5f * size.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
  ImGui::SetNextWindowBgAlpha(0.8f);
  if (ImGui::Begin("help", nullptr, kPanel)) {
    if (mouse_hand) {
      ImGui::TextUnformatted(
          "move        the handle in the picture's plane\n"
          "wheel       the handle nearer and farther\n"
          "right drag  turn the handle\n"
          "left drag   turn the camera");
    } else {
      ImGui::TextUnformatted(
          "left drag   turn the camera\n"
          "right drag  shift the camera\n"
          "wheel       nearer and farther");
    }
    if (facts_.shared) ImGui::TextUnformatted("\nG           take a free grip, let go");
    if (facts_.may_change) {
      ImGui::TextUnformatted(
          "\nSpace       pause, go on\n"
          "R           start again");
    }
    ImGui::TextUnformatted(
        "C           the camera back to where it was\n"
        "H           this help\n"
        "Esc, Q      end");
  }
  ImGui::End();
}

void Hud::draw(const Rates& rates) {
  ImGui::SetNextWindowPos(ImVec2(kMargin, kMargin));
  ImGui::SetNextWindowBgAlpha(0.55f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 4.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(6.0f, 2.0f));
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const bool brief = size.y < kLeastHeight;
  float run_bottom = kMargin;
  if (ImGui::Begin("run", nullptr, kPanel)) {
    draw_run(rates, brief);
    ImGui::Dummy(ImVec2(kPanelWidth, 1.0f));
    run_bottom += ImGui::GetWindowHeight();
  }
  ImGui::End();
  if (!charts_.empty() && !brief) {
    // Below the other panel where there is room, else in the corner across.
    const float chart_height = kChartHeight + 2.0f * ImGui::GetTextLineHeightWithSpacing() + 8.0f;
    const bool below =
        run_bottom + static_cast<float>(charts_.size()) * chart_height + 3.0f * kMargin < size.y;
    ImGui::SetNextWindowPos(ImVec2(below ? kMargin : size.x - kMargin, size.y - kMargin), ImGuiCond_Always,
                            ImVec2(below ? 0.0f : 1.0f, 1.0f));
    ImGui::SetNextWindowBgAlpha(0.55f);
    if (ImGui::Begin("forces", nullptr, kPanel)) {
      for (std::size_t i = 0; i < charts_.size(); ++i) draw_chart(i);
    }
    ImGui::End();
  }
  if (show_help) draw_help();
  ImGui::PopStyleVar(3);
}

}  // namespace slosh
