// How far what is drawn of a fluid is from what should be seen of it, where its shape is the question:
// streams, sheets, drops, puddles. Plain maths.
#pragma once

#include "tests/lab/picture/score/pool.h"

namespace slosh::score {

struct ShapeScore {
  double overlap = 0.0;  ///< pixels that show fluid in both over those that show it in either; 1 = the same
  int pieces = 0;        ///< that are drawn: connected over sides and corners, of kMinPiece pixels at least
  int right_pieces = 0;
  double area = 0.0;         ///< pixels of fluid over those that should be
  double normal_mean = 0.0;  ///< degrees between drawn and right normal, where both show fluid
};
inline constexpr int kMinPiece = 6;

/// Both of one size.
ShapeScore score_shape(const Exact& drawn, const Exact& right);

}  // namespace slosh::score
