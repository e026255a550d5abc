// Pixels that a slow machine can draw: a window's 3-D picture is drawn smaller and stretched where it takes
// too long. What is written over it is not.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace slosh {

/// Shares of the window's sides, by measured times: the largest that keeps within the budget. It goes down
/// after kTurns pictures in a row that took too long, and up again only when the larger picture would clearly
/// fit, so that it does not go to and fro.
class PictureScale {
 public:
  /// budget_ms: of a picture, > 0.
  explicit PictureScale(double budget_ms) : budget_ms_(budget_ms) {}

  double scale() const { return kScales[at_]; }

  /// A picture at scale() took this long. Returns whether scale() is another now.
  bool took(double milliseconds) {
    const double share = at_ > 0 ? kScales[at_ - 1] / kScales[at_] : 1.0;
    const bool slow = milliseconds > budget_ms_;
    const bool fits_larger = at_ > 0 && milliseconds * share * share < 0.7 * budget_ms_;
    slow_ = slow ? slow_ + 1 : 0;
    fits_ = fits_larger ? fits_ + 1 : 0;
    if (slow_ >= kTurns && at_ + 1 < kScales.size()) return move(at_ + 1);
    if (fits_ >= 4 * kTurns) return move(at_ - 1);
    return false;
  }

 private:
  static constexpr std::array<double, 5> kScales{1.0, 0.85, 0.7, 0.6, 0.5};
  static constexpr int kTurns = 6;  // a shader is compiled at its first use: one slow picture says nothing

  bool move(std::size_t to) {
    at_ = to;
    slow_ = fits_ = 0;
    return true;
  }

  double budget_ms_;
  std::size_t at_ = 0;
  int slow_ = 0;
  int fits_ = 0;
};

}  // namespace slosh
