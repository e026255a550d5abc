// How much of the HUD a picture has room for, and where its two panels lie: decided once, so that nothing
// jumps while a film runs. Plain maths, no Dear ImGui here.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>

#include "peer/view/hud/panels.h"

namespace slosh {

/// What panels are measured by, in pixels.
struct LetterSize {
  float width = 0.0f;       ///< of "0"
  float line = 0.0f;        ///< from one row to the next
  glm::vec2 padding{0.0f};  ///< of a panel, on either side
  bool operator==(const LetterSize&) const = default;
};

struct HudLayout {
  enum class Detail {
    kFull,   ///< all rows, a chart a hand and quantity
    kShort,  ///< time, pace, what left the world and what is wrong; hands as a line of numbers each
    kMin,    ///< the time and what is wrong
  };
  Detail detail = Detail::kFull;
  float letters = 1.0f;       ///< times the size that the letters have
  bool in_a_row = false;      ///< the hands beside each other
  bool run_at_right = false;  ///< the run's panel is in the upper left corner, or in the upper right one
  bool hands_at_right = false, hands_on_top = false;
  float run_width = 0.0f;        ///< px, padding included
  float most_run_height = 0.0f;  ///< px, that warnings may let it grow to
  glm::vec2 hands_size{0.0f};    ///< px; 0 without a panel
};

/// Of all panels together, of the picture.
inline constexpr float kMaxCovered = 1.0f / 3.0f;
inline constexpr float kHudMargin = 8.0f;   ///< px, of panels from the picture's edges and from each other
inline constexpr float kChartLines = 1.7f;  ///< height of a hand's chart
inline constexpr int kFullRows = 10, kShortRows = 5, kMinRows = 1;  ///< of the run's panel, unwarned

/// The most detail at which both panels cover no more than kMaxCovered, with room for a warning. `clear`:
/// what they hide as little of as they can, px.
HudLayout make_hud_layout(const glm::vec2& picture, const LetterSize& letter, std::size_t hands,
                          std::span<const Rect> clear);

/// The hands' panel, and the upper left corner of a run's panel of `height`.
Rect hands_rect(const HudLayout& layout, const glm::vec2& picture);
Rect run_rect(const HudLayout& layout, const glm::vec2& picture, float height);

}  // namespace slosh
