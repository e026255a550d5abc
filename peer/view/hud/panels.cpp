#include "peer/view/hud/panels.h"

#include <imgui.h>

#include <algorithm>

namespace slosh {
namespace {

/// Where values stand, in widths of a letter "0".
constexpr float kValueColumn = 10.0f;

float row_height(const PanelRow& row, float width, float letters) {
  switch (row.kind) {
    case PanelRow::Kind::kLine:
      return 1.0f;
    case PanelRow::Kind::kTitle:
    case PanelRow::Kind::kText:
    case PanelRow::Kind::kWarning:
      return letters * ImGui::CalcTextSize(row.text.c_str(), nullptr, false, width / letters).y;
    case PanelRow::Kind::kLabelled:
      break;
  }
  return letters * ImGui::GetTextLineHeight();
}

/// Where a text of UTF-8 may end, `at` or before it.
std::size_t letter_end(const std::string& text, std::size_t at) {
  while (at > 0 && (static_cast<unsigned char>(text[at]) & 0xC0u) == 0x80u) --at;
  return at;
}

/// As ImGui::Separator, no wider than the rows.
void line(float width) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddRectFilled(at, ImVec2(at.x + width, at.y + 1.0f),
                                            ImGui::GetColorU32(ImGuiCol_Separator));
  ImGui::Dummy(ImVec2(width, 1.0f));
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

float rows_height(std::span<const PanelRow> rows, float width, float letters) {
  float height = 0.0f;
  for (const PanelRow& row : rows)
    height += row_height(row, width, letters) + ImGui::GetStyle().ItemSpacing.y;
  return height;
}

void cut_rows(std::vector<PanelRow>& rows, float width, float height, float letters) {
  // People and connection give way before warnings, and of these the last ones.
  for (const PanelRow::Kind kind : {PanelRow::Kind::kText, PanelRow::Kind::kWarning}) {
    for (std::size_t i = rows.size(); i-- > 0;) {
      if (rows[i].kind != kind || rows_height(rows, width, letters) <= height) continue;
      const std::string whole = rows[i].text;
      std::size_t fits = 0;
      for (std::size_t step = std::size_t{1} << 14; step > 0; step /= 2) {
        if (fits + step >= whole.size()) continue;
        rows[i].text = whole.substr(0, letter_end(whole, fits + step)) + "...";
        if (rows_height(rows, width, letters) <= height) fits += step;
      }
      rows[i].text = whole.substr(0, letter_end(whole, fits)) + "...";
      if (fits == 0) rows.erase(rows.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }
  // A line that nothing stands below any more.
  while (!rows.empty() && rows.back().kind == PanelRow::Kind::kLine) rows.pop_back();
}

float letters_that_fit(const glm::vec2& size, const glm::vec2& room) {
  const glm::vec2 share = glm::max(room, glm::vec2(1.0f)) / glm::max(size, glm::vec2(1.0f));
  return std::min({share.x, share.y, 1.0f});
}

void draw_rows(std::span<const PanelRow> rows, float width) {
  for (const PanelRow& row : rows) {
    switch (row.kind) {
      case PanelRow::Kind::kLine:
        line(width);
        break;
      case PanelRow::Kind::kLabelled:
        ImGui::TextColored(ImVec4(0.72f, 0.76f, 0.80f, 1.0f), "%s", row.text.c_str());
        ImGui::SameLine(kValueColumn * ImGui::CalcTextSize("0").x + ImGui::GetStyle().WindowPadding.x);
        ImGui::TextUnformatted(row.value.c_str());
        break;
      case PanelRow::Kind::kTitle:
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
