#include "peer/view/hud/hud.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "peer/output/summary.h"
#include "peer/view/palette.h"

namespace slosh {
namespace {

constexpr double kChartSeconds = 5.0;
constexpr double kStatusSeconds = 1.5;  // simulated: a status of one step is shown long enough to be read
constexpr float kTaskLetters = 52.0f;   // of a line of the task's panel, at most
constexpr float kMaxTask = 0.3f;        // of the picture's height
constexpr float kMinForce = 1.0f;       // N, that a chart's height is at least
constexpr float kMinTorque = 0.05f;     // N·m

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

std::vector<Rect> clear_of(std::vector<Rect> shares, const glm::vec2& picture) {
  for (Rect& rect : shares) rect = {rect.low * picture, rect.high * picture};
  return shares;
}

/// As panels are drawn in, at their full size.
LetterSize letter_size() {
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  return {ImGui::CalcTextSize("0").x,
          ImGui::GetTextLineHeight() + ImGui::GetStyle().ItemSpacing.y,
          {padding.x, padding.y}};
}

/// Begins a panel there, with letters of `letters` times their size; End() whatever it returns.
bool begin_panel(const char* name, const Rect& rect, float letters) {
  ImGui::SetNextWindowPos(ImVec2(rect.low.x, rect.low.y));
  ImGui::SetNextWindowSize(ImVec2(rect.high.x - rect.low.x, rect.high.y - rect.low.y));
  ImGui::SetNextWindowBgAlpha(0.55f);
  const bool shown = ImGui::Begin(name, nullptr, kPanel);
  ImGui::SetWindowFontScale(letters);
  return shown;
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
    hands_.push_back({grip.name, StripChart(samples, kMinForce), StripChart(samples, kMinTorque), {}});
}

void Hud::record(const Snapshot& snapshot) {
  const double before = time_;
  time_ = snapshot.rigid.time;
  if (time_ < before) status_until_.fill(-1.0);  // the world started again
  for (std::size_t bit = 0; bit < status_until_.size(); ++bit) {
    if (snapshot.rigid.status & (1u << bit)) status_until_[bit] = time_ + kStatusSeconds;
  }
  const auto left = std::count(snapshot.fluid_index.begin(), snapshot.fluid_index.end(), std::uint8_t{255});
  left_ = static_cast<std::uint64_t>(std::max<std::int64_t>(0, left - snapshot.rigid.waiting));
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
  // The clamp at walls acts in most steps of a sound run: alone it asks for nothing (peer/view/README.md).
  if (!(status & kStatusCompressed)) status &= ~static_cast<std::uint32_t>(kStatusClamped);
  // Spilling is what many scenes are for, and stands in a row of its own.
  if (facts_.walls_hold) status &= ~static_cast<std::uint32_t>(kStatusEscaped);
  return status;
}

void Hud::add_what_left(const Rates& rates, std::vector<PanelRow>& rows) const {
  if (!facts_.counts_fluid) {
    if (facts_.walls_hold && status_until_[1] >= time_)
      rows.push_back({PanelRow::Kind::kLabelled, "spilled", "some fluid"});
    return;
  }
  const std::uint64_t lost = facts_.walls_hold ? std::min(rates.lost, left_) : left_;
  if (left_ > lost) rows.push_back({PanelRow::Kind::kLabelled, "spilled", grouped(left_ - lost)});
  if (lost > 0) rows.push_back({PanelRow::Kind::kLabelled, "lost", grouped(lost)});
}

std::string Hud::warnings(const Rates& rates) const {
  std::string lines = status_lines(status() | rates.device_status, rates.status_steps);
  if (!rates.budgets.empty()) lines += (lines.empty() ? "" : "\n") + rates.budgets;
  return lines;
}

std::vector<PanelRow> Hud::run_rows(const Rates& rates) const {
  using Kind = PanelRow::Kind;
  using Detail = HudLayout::Detail;
  std::vector<PanelRow> rows;
  const Detail detail = layout_->detail;
  if (detail != Detail::kMin) rows = {{Kind::kTitle, facts_.title, {}}, {Kind::kLine, {}, {}}};
  rows.push_back(labelled("time", "%.2f s%s", time_, paused ? "  paused" : ""));
  if (detail != Detail::kMin && rates.real_time > 0.0)
    rows.push_back(labelled("real time", "\xC3\x97 %.2f", rates.real_time));
  if (detail == Detail::kFull) {
    if (rates.step_rate > 0.0)
      rows.push_back(labelled("steps", "%.0f Hz  %.2f ms", rates.step_rate, rates.step_ms));
    if (rates.device_rate > 0.0) rows.push_back(labelled("devices", "%.0f Hz", rates.device_rate));
    rows.push_back(labelled("fluid", "%s", grouped(facts_.fluid_particles).c_str()));
    if (facts_.boundary_particles > 0)
      rows.push_back(labelled("bodies", "%s", grouped(facts_.boundary_particles).c_str()));
    rows.push_back(labelled("spacing", "%.1f mm", 1e3 * facts_.spacing));
  }
  if (detail != Detail::kMin) add_what_left(rates, rows);
  if (detail == Detail::kFull) {
    for (const std::string* lines : {&rates.people, &rates.connection}) {
      if (lines->empty()) continue;
      rows.push_back({Kind::kLine, {}, {}});
      rows.push_back({Kind::kText, *lines, {}});
    }
  }
  const std::string warning = warnings(rates);
  if (!warning.empty()) rows.push_back({Kind::kWarning, warning, {}});
  return rows;
}

void Hud::draw_hand(std::size_t device, float width) const {
  const Hand& hand = hands_[device];
  const ImVec4 color = bright(device_color(device));
  ImGui::TextColored(color, "%s", hand.grip.c_str());
  draw_strip(hand.force, width, color, "%7.2f N", glm::length(hand.now.force));
  draw_strip(hand.torque, width, color, "%7.3f Nm", glm::length(hand.now.torque));
}

void Hud::draw_short_hand(std::size_t device, float width) const {
  const Hand& hand = hands_[device];
  char numbers[48];
  std::snprintf(numbers, sizeof numbers, "%6.1f N %5.2f Nm", glm::length(hand.now.force),
                glm::length(hand.now.torque));
  const float before = width - ImGui::CalcTextSize(numbers).x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::PushClipRect(at, ImVec2(at.x + before, at.y + ImGui::GetTextLineHeight()), true);
  ImGui::TextColored(bright(device_color(device)), "%s", hand.grip.c_str());
  ImGui::PopClipRect();
  ImGui::SameLine(before);  // from where the hand's group begins
  ImGui::TextUnformatted(numbers);
}

// Once, not as the hands move: panels that change corners are worse than one that hides a hand for a moment.
void Hud::lay_out(const glm::vec2& picture) {
  const LetterSize letter = letter_size();
  if (layout_ && laid_out_for_ == picture && laid_out_in_ == letter) return;
  layout_ = make_hud_layout(picture, letter, hands_.size(), clear_of(keep_clear, picture));
  laid_out_for_ = picture;
  laid_out_in_ = letter;
}

void Hud::draw_run(const Rates& rates, const glm::vec2& picture) {
  std::vector<PanelRow> rows = run_rows(rates);
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  const float width = layout_->run_width - 2.0f * padding.x;
  cut_rows(rows, width, layout_->most_run_height - 2.0f * padding.y, layout_->letters);
  const float height = rows_height(rows, width, layout_->letters) + 2.0f * padding.y;
  run_panel_ = run_rect(*layout_, picture, height);
  if (begin_panel("run", run_panel_, layout_->letters)) draw_rows(rows, width);
  ImGui::End();
}

void Hud::draw_hands(const glm::vec2& picture) {
  hands_panel_ = hands_rect(*layout_, picture);
  const float inner = layout_->hands_size.x - 2.0f * ImGui::GetStyle().WindowPadding.x;
  const float width = layout_->in_a_row ? inner / static_cast<float>(hands_.size()) : inner;
  if (begin_panel("forces", hands_panel_, layout_->letters)) {
    const ImVec2 corner = ImGui::GetCursorPos();
    for (std::size_t i = 0; i < hands_.size(); ++i) {
      if (layout_->in_a_row) ImGui::SetCursorPos(ImVec2(corner.x + width * static_cast<float>(i), corner.y));
      ImGui::BeginGroup();
      if (layout_->detail == HudLayout::Detail::kFull) {
        draw_hand(i, width);
      } else {
        draw_short_hand(i, width);
      }
      ImGui::EndGroup();
    }
  }
  ImGui::End();
}

/// Along the top, in what the run's panel leaves of it; under the hands' where that is there, too. What there
/// is no room for is left out, the help first.
void Hud::draw_task(const TaskLines& task, const glm::vec2& picture) {
  using Kind = PanelRow::Kind;
  std::vector<PanelRow> rows = {
      {Kind::kText, task.title, {}}, {Kind::kLine, {}, {}}, {Kind::kText, task.say, {}}};
  if (!task.now.empty()) rows.push_back({Kind::kText, task.now, {}});
  if (!task.hint.empty()) rows.push_back({Kind::kWarning, task.hint, {}});
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  const float room = picture.x - layout_->run_width - 3.0f * kHudMargin;
  const float letter = layout_->letters * ImGui::CalcTextSize("0").x;
  const float width = std::min(room, kTaskLetters * letter + 2.0f * padding.x);
  const float inner = width - 2.0f * padding.x;
  const float most = kMaxTask * picture.y - 2.0f * padding.y;
  if (!task.hint.empty() && rows_height(rows, inner, layout_->letters) > most) rows.pop_back();
  cut_rows(rows, inner, most, layout_->letters);
  const float height = rows_height(rows, inner, layout_->letters) + 2.0f * padding.y;
  const float left = kHudMargin + (layout_->run_at_right ? 0.0f : layout_->run_width + kHudMargin);
  const float top = layout_->hands_on_top ? hands_panel_.high.y + kHudMargin : kHudMargin;
  const glm::vec2 low(left + 0.5f * (room - width), top);
  task_panel_ = {low, low + glm::vec2(width, height)};
  if (begin_panel("task", task_panel_, layout_->letters)) draw_rows(rows, inner);
  ImGui::End();
}

void Hud::draw(const Rates& rates) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 4.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(6.0f, 2.0f));
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const glm::vec2 picture(size.x, size.y);
  lay_out(picture);
  draw_run(rates, picture);
  hands_panel_ = {};
  if (layout_->hands_size.y > 0.0f) draw_hands(picture);
  task_panel_ = {};
  if (!rates.task.title.empty()) draw_task(rates.task, picture);
  ImGui::PopStyleVar(3);
}

}  // namespace slosh
