#include "peer/view/measures.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "peer/view/palette.h"

namespace slosh {
namespace {

// Four corners each, and Dear ImGui counts corners of a list in 16 bits: of more particles each so many-th.
constexpr std::size_t kMaxDots = 12'000;
constexpr std::size_t kMaxArrows = 3'000;
constexpr float kArrowSeconds = 0.05f;  // an arrow is the way of so much time
constexpr float kDot = 2.5f;            // px, half a side
constexpr float kMargin = 16.0f;        // px
constexpr float kTriad = 34.0f;         // px
constexpr double kScaleShare = 0.22;    // of the picture's height that the scale has at most

ImU32 color_of(const glm::vec3& srgb) {
  return ImGui::GetColorU32(ImVec4(srgb.r, srgb.g, srgb.b, 1.0f));
}

ImVec2 scaled(const glm::dvec2& pixel) {
  const ImVec2 by = ImGui::GetIO().DisplayFramebufferScale;
  return {static_cast<float>(pixel.x) / by.x, static_cast<float>(pixel.y) / by.y};
}

/// A text with a dark rim: it stands over any picture.
void label(ImDrawList* list, ImVec2 at, ImU32 color, const char* text) {
  for (const ImVec2 by : {ImVec2(1, 1), ImVec2(-1, 1), ImVec2(1, -1), ImVec2(-1, -1)})
    list->AddText(ImVec2(at.x + by.x, at.y + by.y), IM_COL32(0, 0, 0, 150), text);
  list->AddText(at, color, text);
}

void draw_axes(const OrbitCamera& camera, const glm::ivec2& picture) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const ImVec2 middle(size.x - kMargin - kTriad, size.y - kMargin - 1.6f * kTriad);
  constexpr const char* kNames[] = {"x", "y (up)", "z"};
  const ImU32 colors[] = {IM_COL32(235, 90, 80, 255), IM_COL32(110, 210, 90, 255),
                          IM_COL32(90, 150, 245, 255)};
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 along(0.0);
    along[axis] = 1.0;
    const ImVec2 end(middle.x + kTriad * static_cast<float>(glm::dot(along, camera.right())),
                     middle.y - kTriad * static_cast<float>(glm::dot(along, camera.up())));
    list->AddLine(middle, end, colors[axis], 2.5f);
    label(list, ImVec2(end.x - (axis == 1 ? 36.0f : 3.0f), end.y - 14.0f), colors[axis], kNames[axis]);
  }
  const double metres_a_pixel = camera.metres_per_pixel(camera.distance(), picture.y) *
                                static_cast<double>(ImGui::GetIO().DisplayFramebufferScale.y);
  const double length = round_length(kScaleShare * size.y * metres_a_pixel);
  const auto pixels = static_cast<float>(length / metres_a_pixel);
  const ImVec2 right(size.x - kMargin, size.y - kMargin);
  const ImVec2 left(right.x - pixels, right.y);
  const ImU32 white = IM_COL32(255, 255, 255, 255);
  list->AddLine(left, right, IM_COL32(0, 0, 0, 150), 4.0f);
  list->AddLine(left, right, white, 2.0f);
  for (const ImVec2 at : {left, right})
    list->AddLine(ImVec2(at.x, at.y - 5.0f), ImVec2(at.x, at.y + 5.0f), white, 2.0f);
  label(list, ImVec2(left.x, left.y - 20.0f), white, length_text(length).c_str());
}

}  // namespace

double round_length(double length) {
  const double ten = std::pow(10.0, std::floor(std::log10(length)));
  for (const double by : {5.0, 2.0})
    if (by * ten <= length * (1.0 + 1e-9)) return by * ten;
  return ten;
}

std::string length_text(double metres) {
  char text[32];
  if (metres < 1.0)
    std::snprintf(text, sizeof text, "%.4g mm", 1e3 * metres);
  else
    std::snprintf(text, sizeof text, "%.4g m", metres);
  return text;
}

glm::vec3 speed_color(float share) {
  // Viridis at five places.
  constexpr glm::vec3 kStops[] = {{0.267f, 0.005f, 0.329f},
                                  {0.230f, 0.322f, 0.546f},
                                  {0.128f, 0.567f, 0.551f},
                                  {0.369f, 0.789f, 0.383f},
                                  {0.993f, 0.906f, 0.144f}};
  const float at = 4.0f * std::clamp(share, 0.0f, 1.0f);
  const int low = std::min(static_cast<int>(at), 3);
  return glm::mix(kStops[low], kStops[low + 1], at - static_cast<float>(low));
}

const char* Measures::next_particles() {
  constexpr const char* kNames[] = {"the fluid's surface", "particles by speed", "particles by pressure",
                                    "particles by fluid", "particles' velocities: the way of 0.05 s"};
  particles =
      static_cast<ParticleView>((static_cast<int>(particles) + 1) % static_cast<int>(ParticleView::kCount));
  return kNames[static_cast<int>(particles)];
}

void Measures::record(const Snapshot& snapshot) {
  const double passed = snapshot.rigid.time - time_;
  velocities_.clear();
  if (time_ >= 0.0 && passed > 0.0 && before_.size() == snapshot.positions.size()) {
    for (std::size_t i = 0; i < before_.size(); ++i)
      velocities_.push_back((snapshot.positions[i] - before_[i]) / static_cast<float>(passed));
  }
  before_ = snapshot.positions;
  time_ = snapshot.rigid.time;
}

std::vector<float> Measures::values_of(const Snapshot& newest, const std::vector<float>* pressures) const {
  std::vector<float> values;
  const std::size_t count = newest.positions.size();
  if (particles == ParticleView::kPressure) {
    if (pressures && pressures->size() == count) values = *pressures;
    // Pressing apart shows; what little is drawn together stands at 0.
    for (float& value : values) value = std::isfinite(value) ? std::max(value, 0.0f) : 0.0f;
  } else if (velocities_.size() == count) {
    for (const glm::vec3& velocity : velocities_) values.push_back(glm::length(velocity));
  }
  return values;
}

void Measures::draw(const Snapshot& newest, const std::vector<float>* pressures, const OrbitCamera& camera,
                    const glm::ivec2& picture) {
  if (particles != ParticleView::kSurface) {
    values_ = values_of(newest, pressures);
    draw_particles(newest, camera, picture);
  }
  if (axes) draw_axes(camera, picture);
}

void Measures::draw_particles(const Snapshot& newest, const OrbitCamera& camera, const glm::ivec2& picture) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const bool arrows = particles == ParticleView::kVelocity;
  const bool pressure = particles == ParticleView::kPressure;
  const bool by_fluid = particles == ParticleView::kFluid;
  const std::size_t count = newest.positions.size();
  const std::size_t each = count / (arrows ? kMaxArrows : kMaxDots) + 1;
  const bool known = values_.size() == count;
  float top = 0.0f;
  for (std::size_t i = 0; known && i < count; i += each) {
    // What left the world was put away: its last way is none that it went.
    if (newest.fluid_index[i] != 255) top = std::max(top, values_[i]);
  }
  // The scale's end follows slowly downward, so that colours compare from picture to picture.
  top_ = std::max({top, 0.98f * top_, pressure ? 1.0f : 0.02f});
  for (std::size_t i = 0; i < count; i += each) {
    if (newest.fluid_index[i] == 255 || !std::isfinite(newest.positions[i].x)) continue;
    const glm::dvec3 at(newest.positions[i]);
    if (camera.depth_of(at) <= 0.01) continue;
    const ImU32 color = color_of(by_fluid ? device_color(newest.fluid_index[i]).srgb
                                          : speed_color(known ? values_[i] / top_ : 0.0f));
    const ImVec2 pixel = scaled(camera.pixel_of(at, picture));
    if (!arrows) {
      list->AddRectFilled(ImVec2(pixel.x - kDot, pixel.y - kDot), ImVec2(pixel.x + kDot, pixel.y + kDot),
                          color);
    } else if (known) {
      const glm::dvec3 end = at + glm::dvec3(kArrowSeconds * velocities_[i]);
      if (camera.depth_of(end) > 0.01)
        list->AddLine(pixel, scaled(camera.pixel_of(end, picture)), color, 1.5f);
    }
  }
  if (by_fluid) return;
  // What the colours mean.
  constexpr float kWidth = 120.0f;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const ImVec2 corner(0.5f * size.x - 0.5f * kWidth, kMargin);
  for (int i = 0; i < 24; ++i) {
    const float from = static_cast<float>(i) / 24.0f;
    list->AddRectFilled(ImVec2(corner.x + kWidth * from, corner.y),
                        ImVec2(corner.x + kWidth * (from + 1.0f / 24.0f), corner.y + 8.0f),
                        color_of(speed_color(from)));
  }
  char text[64];
  if (!known)
    std::snprintf(text, sizeof text,
                  pressure ? "no pressures here: the world is elsewhere" : "not known yet");
  else if (pressure)
    std::snprintf(text, sizeof text, "0 to %.3g Pa", static_cast<double>(top_));
  else
    std::snprintf(text, sizeof text, "0 to %.2f m/s", static_cast<double>(top_));
  label(list, ImVec2(corner.x, corner.y + 10.0f), IM_COL32(255, 255, 255, 255), text);
  if (each > 1) {
    std::snprintf(text, sizeof text, "one of %zu is drawn", each);
    label(list, ImVec2(corner.x, corner.y + 26.0f), IM_COL32(255, 255, 255, 255), text);
  }
}

}  // namespace slosh
