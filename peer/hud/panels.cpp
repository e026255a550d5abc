#include "peer/hud/panels.h"

#include <imgui.h>

namespace slosh {
namespace {

/// Where values stand, in widths of a letter "0".
constexpr float kValueColumn = 10.0f;

float row_height(const PanelRow& row, float width) {
  switch (row.kind) {
    case PanelRow::Kind::kLine:
      return 1.0f;
    case PanelRow::Kind::kText:
    case PanelRow::Kind::kWarning:
      return ImGui::CalcTextSize(row.text.c_str(), nullptr, false, width).y;
    case PanelRow::Kind::kTitle:
    case PanelRow::Kind::kLabelled:
      break;
  }
  return ImGui::GetTextLineHeight();
}

void wrapped(const std::string& text, float width) {
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
}

}  // namespace

float covered_area(const glm::vec2& at, const glm::vec2& size, std::span<const Rect> clear) {
  float area = 0.0f;
  for (const Rect& rect : clear) area += rect.shared_area({at, at + size});
  return area;
}

float rows_height(std::span<const PanelRow> rows, float width) {
  float height = 0.0f;
  for (const PanelRow& row : rows) height += row_height(row, width) + ImGui::GetStyle().ItemSpacing.y;
  return height;
}

void draw_rows(std::span<const PanelRow> rows, float width) {
  for (const PanelRow& row : rows) {
    switch (row.kind) {
      case PanelRow::Kind::kLine:
        ImGui::Separator();
        break;
      case PanelRow::Kind::kTitle:
        ImGui::TextUnformatted(row.text.c_str());
        break;
      case PanelRow::Kind::kLabelled:
        ImGui::TextColored(ImVec4(0.72f, 0.76f, 0.80f, 1.0f), "%s", row.text.c_str());
        ImGui::SameLine(kValueColumn * ImGui::CalcTextSize("0").x + ImGui::GetStyle().WindowPadding.x);
        ImGui::TextUnformatted(row.value.c_str());
        break;
      case PanelRow::Kind::kText:
        wrapped(row.text, width);
        break;
      case PanelRow::Kind::kWarning:
        ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.0f, 0.78f, 0.35f, 1.0f));
        wrapped(row.text, width);
        ImGui::PopStyleColor();
        break;
    }
  }
}

glm::vec2 place_panel(const glm::vec2& size, std::span<const glm::vec2> places, std::span<const Rect> clear,
                      const glm::vec2& now) {
  glm::vec2 best = places.front();
  float least = covered_area(best, size, clear);
  for (const glm::vec2& place : places.subspan(1)) {
    const float area = covered_area(place, size, clear);
    if (area < 0.5f * least) {
      least = area;
      best = place;
    }
  }
  for (const glm::vec2& place : places) {
    if (place == now && covered_area(now, size, clear) <= 2.0f * least) return now;
  }
  return best;
}

}  // namespace slosh
