#include "peer/view/hud/hud_layout.h"

#include <algorithm>
#include <array>
#include <optional>

namespace slosh {
namespace {

using Detail = HudLayout::Detail;

// In letters.
constexpr float kPanelWidth = 27.0f;   // leaves 640 × 480 mostly to the picture
constexpr float kNarrowWidth = 18.5f;  // a hand's, where they stand beside each other; the time alone
constexpr float kWarningRows = 3.0f;
constexpr std::array kSmaller{1.0f, 0.85f, 0.7f, 0.6f, 0.5f, 0.4f};

float area(const glm::vec2& size) {
  return size.x * size.y;
}

/// A layout's sizes, without places.
HudLayout sized(Detail detail, bool in_a_row, float letters, const LetterSize& full, std::size_t hands) {
  HudLayout layout;
  layout.detail = detail;
  layout.letters = letters;
  layout.in_a_row = in_a_row;
  const glm::vec2 around = 2.0f * full.padding;
  const float letter = letters * full.width;
  layout.run_width = (detail == Detail::kMin ? kNarrowWidth : kPanelWidth) * letter + around.x;
  if (detail == Detail::kMin || hands == 0) return layout;
  const auto count = static_cast<float>(hands);
  const float hand = detail == Detail::kFull ? 1.0f + 2.0f * kChartLines : 1.0f;  // lines
  const float columns = in_a_row ? count : 1.0f;
  layout.hands_size = glm::vec2(in_a_row ? columns * kNarrowWidth * letter : kPanelWidth * letter,
                                hand * count / columns * letters * full.line) +
                      around;
  return layout;
}

/// Lays it in its corners: of all pairs that do not touch each other the first, unless another hides less
/// than half as much. None where no pair leaves the run's panel room for a warning.
std::optional<HudLayout> placed(HudLayout layout, const glm::vec2& picture, const LetterSize& full,
                                std::span<const Rect> clear, float* covered) {
  const float line = layout.letters * full.line;
  const int rows = layout.detail == Detail::kFull    ? kFullRows
                   : layout.detail == Detail::kShort ? kShortRows
                                                     : kMinRows;
  const float height = static_cast<float>(rows) * line + 2.0f * full.padding.y;
  const float wanted = height + kWarningRows * line;
  const float left = kMaxCovered * area(picture) - area(layout.hands_size);
  const glm::vec2 inner = picture - 2.0f * kHudMargin;
  if (layout.run_width > inner.x || layout.hands_size.x > inner.x || layout.hands_size.y > inner.y)
    return std::nullopt;
  std::optional<HudLayout> best;
  for (const bool run_right : {false, true}) {
    for (const auto& [right, top] : {std::pair{false, false}, {true, false}, {true, true}, {false, true}}) {
      HudLayout tried = layout;
      tried.run_at_right = run_right;
      tried.hands_at_right = right;
      tried.hands_on_top = top;
      tried.most_run_height = std::min(left / layout.run_width, inner.y);
      const Rect hands = hands_rect(tried, picture);
      const Rect column = run_rect(tried, picture, inner.y);
      if (layout.hands_size.y > 0.0f && column.shared_area(hands) > 0.0f)
        tried.most_run_height =
            top ? 0.0f : std::min(tried.most_run_height, inner.y - layout.hands_size.y - kHudMargin);
      if (tried.most_run_height < wanted) continue;
      const Rect run = run_rect(tried, picture, height);
      const float hidden = covered_area(run.low, run.high - run.low, clear) +
                           covered_area(hands.low, layout.hands_size, clear);
      if (best && !(hidden < 0.5f * *covered)) continue;
      best = tried;
      *covered = hidden;
    }
  }
  return best;
}

}  // namespace

Rect hands_rect(const HudLayout& layout, const glm::vec2& picture) {
  const glm::vec2 far = picture - layout.hands_size - kHudMargin;
  const glm::vec2 low(layout.hands_at_right ? far.x : kHudMargin, layout.hands_on_top ? kHudMargin : far.y);
  return {low, low + layout.hands_size};
}

Rect run_rect(const HudLayout& layout, const glm::vec2& picture, float height) {
  const glm::vec2 low(layout.run_at_right ? picture.x - layout.run_width - kHudMargin : kHudMargin,
                      kHudMargin);
  return {low, low + glm::vec2(layout.run_width, height)};
}

HudLayout make_hud_layout(const glm::vec2& picture, const LetterSize& letter, std::size_t hands,
                          std::span<const Rect> clear) {
  for (const Detail detail : {Detail::kFull, Detail::kShort}) {
    // Many hands below each other may hide one: then beside each other, if that hides less.
    float by_column = 0.0f, by_row = 0.0f;
    const auto column = placed(sized(detail, false, 1.0f, letter, hands), picture, letter, clear, &by_column);
    const bool may_row = detail == Detail::kFull && hands > 1;
    const auto row = may_row
                         ? placed(sized(detail, true, 1.0f, letter, hands), picture, letter, clear, &by_row)
                         : std::nullopt;
    if (row && (!column || by_row < 0.5f * by_column)) return *row;
    if (column) return *column;
  }
  float covered = 0.0f;
  for (const float smaller : kSmaller) {
    const HudLayout least = sized(Detail::kMin, false, smaller, letter, hands);
    if (const auto fits = placed(least, picture, letter, clear, &covered)) return *fits;
  }
  HudLayout tiny = sized(Detail::kMin, false, kSmaller.back(), letter, hands);
  tiny.run_width = std::min(tiny.run_width, picture.x - 2.0f * kHudMargin);
  tiny.most_run_height = kMaxCovered * area(picture) / std::max(tiny.run_width, 1.0f);
  return tiny;
}

}  // namespace slosh
