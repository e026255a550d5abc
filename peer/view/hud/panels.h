// Panels of the HUD: how large one is, and where it lies. The height is known before it is drawn, so that a
// line that comes and goes is never cut off.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

namespace slosh {

/// A rectangle of the picture, y down.
struct Rect {
  glm::vec2 low{0.0f};
  glm::vec2 high{0.0f};

  float shared_area(const Rect& other) const {
    const glm::vec2 size = glm::max(glm::min(high, other.high) - glm::max(low, other.low), glm::vec2(0.0f));
    return size.x * size.y;
  }
};

struct PanelRow {
  enum class Kind { kTitle, kLabelled, kText, kWarning, kLine };
  Kind kind = Kind::kText;
  std::string text;   ///< the label of kLabelled
  std::string value;  ///< of kLabelled
};

/// Height of the rows, wrapped at `width`, without the panel's padding, with letters of `letters` times their
/// size. Inside a frame of Dear ImGui.
float rows_height(std::span<const PanelRow> rows, float width, float letters = 1.0f);
/// In a window whose font scale is what the height was asked for with.
void draw_rows(std::span<const PanelRow> rows, float width);
/// Takes from the text of the rows, the last warning last, what makes them higher than `height`; "..." stands
/// where text is missing.
void cut_rows(std::vector<PanelRow>& rows, float width, float height, float letters = 1.0f);

/// What letters have to be multiplied by, at most 1, for a panel of `size` without padding to fit into
/// `room`.
float letters_that_fit(const glm::vec2& size, const glm::vec2& room);

/// What a panel there covers of `clear`, pixels².
float covered_area(const glm::vec2& at, const glm::vec2& size, std::span<const Rect> clear);

/// Where a panel of `size` lies: of `places` (its upper left corners, best first) the one that covers least
/// of `clear`. Stays at `now` unless another covers less than half as much.
glm::vec2 place_panel(const glm::vec2& size, std::span<const glm::vec2> places, std::span<const Rect> clear,
                      const glm::vec2& now);

}  // namespace slosh
