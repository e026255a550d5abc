// A pose over time, through given keys: the motion of a scripted or replayed hand.
#pragma once

#include <cstddef>
#include <vector>

#include "scenes/scene.h"
#include "sim/math/pose.h"

namespace slosh {

/// A smooth motion through keys. Between keys each coordinate follows a monotone cubic (Fritsch and Carlson):
/// the velocity has no jumps, and nothing overshoots a key, so a hand that rests between two equal keys
/// rests. Orientations do the same with the rotation vector from one key to the next. Before the first and
/// after the last key the hand stands still.
class PoseTrack {
 public:
  /// Keys in rising time (a key that is not later than the one before is left out). No keys: `rest` for ever.
  PoseTrack(const std::vector<PoseKey>& keys, const Pose& rest);

  struct Sample {
    Pose pose;
    Twist twist;
  };
  /// Neither allocates nor throws. Not for several threads: it remembers where it last looked.
  Sample at(double time) noexcept;

  bool moves() const { return keys_.size() > 1; }
  double end() const { return keys_.empty() ? 0.0 : keys_.back().time; }  ///< s

 private:
  struct Segment {
    glm::dvec3 turn{0.0};  // rotation vector to the next key
  };
  std::vector<PoseKey> keys_;
  std::vector<Segment> segments_;
  std::vector<Twist> tangents_;  // at the keys
  Pose rest_;
  std::size_t last_ = 0;
};

}  // namespace slosh
