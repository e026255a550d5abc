#include "peer/view/force_panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "peer/view/palette.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr std::size_t kMaxRows = 36'000;  // ten minutes at 60 pictures a second
constexpr double kMinSpan = 0.1;          // s
constexpr double kMaxSpan = 600.0;
constexpr double kZoom = 1.25;              // a notch
constexpr float kMinTop[] = {0.5f, 0.02f};  // N, N·m: noise is not drawn large

}  // namespace

ForcePanel::ForcePanel(const Scene& scene) {
  for (const Grip& grip : scene.grips) names_.push_back(grip.name);
}

void ForcePanel::record(const BodySnapshot& bodies) {
  if (!rows_.empty() && bodies.time <= rows_.back().time) {
    if (bodies.time == rows_.back().time) return;
    rows_.clear();  // the world started again
    held_.reset();
  }
  Row row{bodies.time, {}};
  for (const GripState& grip : bodies.grips) row.hands.push_back(grip.on_hand);
  row.hands.resize(names_.size());
  rows_.push_back(std::move(row));
  if (rows_.size() > kMaxRows) rows_.erase(rows_.begin(), rows_.begin() + kMaxRows / 10);
}

void ForcePanel::zoom(double notches) {
  span_ = std::clamp(span_ * std::pow(kZoom, -notches), kMinSpan, kMaxSpan);
}

std::string ForcePanel::table() const {
  std::string out = "time_s";
  for (const std::string& name : names_) {
    std::string word;
    for (const char c : name) word += c == ',' || c == '"' || c == '\n' ? '_' : c;
    for (const char* column : {"fx_n", "fy_n", "fz_n", "tx_nm", "ty_nm", "tz_nm"})
      out += "," + word + "_" + column;
  }
  out += "\n";
  for (const Row& row : rows_) {
    out += format("%.6f", row.time);
    for (const Wrench& hand : row.hands) {
      for (const glm::dvec3& v : {hand.force, hand.torque}) out += format(",%.6g,%.6g,%.6g", v.x, v.y, v.z);
    }
    out += "\n";
  }
  return out;
}

std::optional<std::string> ForcePanel::take_table() {
  if (!wanted_) return std::nullopt;
  wanted_ = false;
  return table();
}

void ForcePanel::plot(const char* title, const char* unit, bool torque, float height) {
  const double end = held_.value_or(rows_.empty() ? 0.0 : rows_.back().time);
  const auto first = std::lower_bound(rows_.begin(), rows_.end(), end - span_,
                                      [](const Row& row, double time) { return row.time < time; });
  const auto last =
      std::upper_bound(first, rows_.end(), end, [](double time, const Row& row) { return time < row.time; });
  const auto value = [&](const Row& row, std::size_t hand) {
    return static_cast<float>(glm::length(torque ? row.hands[hand].torque : row.hands[hand].force));
  };
  float top = kMinTop[torque ? 1 : 0];
  for (auto row = first; row != last; ++row)
    for (std::size_t hand = 0; hand < names_.size(); ++hand) top = std::max(top, value(*row, hand));
  ImGui::Text("%s, 0 to %.3g %s", title, static_cast<double>(top), unit);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(std::max(ImGui::GetContentRegionAvail().x, 60.0f), height);
  const ImVec2 low(at.x, at.y + size.y);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(at, ImVec2(at.x + size.x, low.y), IM_COL32(255, 255, 255, 16));
  const auto x_of = [&](double time) {
    return at.x + size.x * static_cast<float>(1.0 - (end - time) / span_);
  };
  // Of what falls onto one pixel the least and the largest: no peak is lost.
  for (std::size_t hand = 0; hand < names_.size(); ++hand) {
    const glm::vec3 c = glm::mix(device_color(hand).srgb, glm::vec3(1.0f), 0.35f);
    const ImU32 color = ImGui::GetColorU32(ImVec4(c.r, c.g, c.b, 1.0f));
    std::vector<ImVec2> points;
    for (auto row = first; row != last;) {
      const float x = std::floor(x_of(row->time));
      float least = value(*row, hand);
      float largest = least;
      for (++row; row != last && std::floor(x_of(row->time)) == x; ++row) {
        least = std::min(least, value(*row, hand));
        largest = std::max(largest, value(*row, hand));
      }
      points.emplace_back(x, low.y - size.y * least / (1.05f * top));
      if (largest > least) points.emplace_back(x, low.y - size.y * largest / (1.05f * top));
    }
    list->AddPolyline(points.data(), static_cast<int>(points.size()), color, 0, 1.5f);
  }
  // A thing of its own, so that a drag in it does not move the panel.
  ImGui::InvisibleButton(title, size);
  if (rows_.empty()) return;
  const ImGuiIO& io = ImGui::GetIO();
  if (ImGui::IsItemActive() && io.MouseDelta.x != 0.0f) {
    const double back = end - span_ * static_cast<double>(io.MouseDelta.x / size.x);
    held_ = std::clamp(back, std::min(rows_.front().time + span_, rows_.back().time), rows_.back().time);
  }
  if (!ImGui::IsItemHovered()) return;
  if (io.MouseWheel != 0.0f) zoom(io.MouseWheel);
  // What the values were where the pointer is.
  const ImVec2 mouse = io.MousePos;
  const double time = end - span_ * (1.0 - static_cast<double>((mouse.x - at.x) / size.x));
  const auto row = std::lower_bound(first, last, time, [](const Row& r, double t) { return r.time < t; });
  if (row == last) return;
  list->AddLine(ImVec2(mouse.x, at.y), ImVec2(mouse.x, low.y), IM_COL32(255, 255, 255, 90));
  std::string text = format("%.3f s", row->time);
  for (std::size_t hand = 0; hand < names_.size(); ++hand)
    text += "\n" + names_[hand] + format(": %.4g ", static_cast<double>(value(*row, hand))) + unit;
  ImGui::SetTooltip("%s", text.c_str());
}

void ForcePanel::draw() {
  if (!shown) return;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowSize(ImVec2(0.55f * screen.x, 0.4f * screen.y), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowPos(ImVec2(0.44f * screen.x, 0.42f * screen.y), ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowBgAlpha(0.8f);
  if (ImGui::Begin("what the hands feel", &shown,
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoCollapse |
                       ImGuiWindowFlags_NoScrollWithMouse)) {
    bool held = held_.has_value();
    if (ImGui::Checkbox("hold", &held)) {
      if (held && !rows_.empty())
        held_ = rows_.back().time;
      else
        held_.reset();
    }
    ImGui::SameLine();
    if (ImGui::Button("save")) wanted_ = true;
    ImGui::SameLine();
    ImGui::Text("%.3g s; wheel: zoom; drag: back in time", span_);
    const float height = std::max(
        0.5f * ImGui::GetContentRegionAvail().y - ImGui::GetTextLineHeightWithSpacing() - 6.0f, 30.0f);
    plot("force", "N", false, height);
    plot("torque", "Nm", true, height);
  }
  ImGui::End();
}

}  // namespace slosh
