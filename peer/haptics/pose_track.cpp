#include "peer/haptics/pose_track.h"

#include <algorithm>
#include <cmath>

namespace slosh {
namespace {

/// Fritsch–Carlson: the weighted harmonic mean of the slopes on both sides, 0 where they change sign.
glm::dvec3 monotone_slope(const glm::dvec3& before, double h0, const glm::dvec3& after, double h1) {
  glm::dvec3 slope{0.0};
  for (int axis = 0; axis < 3; ++axis) {
    if (before[axis] * after[axis] <= 0.0) continue;
    const double w0 = 2.0 * h1 + h0;
    const double w1 = h1 + 2.0 * h0;
    slope[axis] = (w0 + w1) / (w0 / before[axis] + w1 / after[axis]);
  }
  return slope;
}

struct Hermite {
  double value, d0, d1;                 // weights of the end value and of the two tangents (times h)
  double rate_value, rate_d0, rate_d1;  // the same for the derivative (value: over h)
};

Hermite hermite(double u) {
  const double u2 = u * u;
  const double u3 = u2 * u;
  return {3 * u2 - 2 * u3, u3 - 2 * u2 + u, u3 - u2, 6 * u - 6 * u2, 3 * u2 - 4 * u + 1, 3 * u2 - 2 * u};
}

}  // namespace

PoseTrack::PoseTrack(const std::vector<PoseKey>& keys, const Pose& rest) : rest_(rest) {
  for (const PoseKey& key : keys) {
    if (keys_.empty() || key.time > keys_.back().time) keys_.push_back(key);
  }
  for (PoseKey& key : keys_) key.pose.orientation = glm::normalize(key.pose.orientation);
  if (keys_.empty()) return;

  const std::size_t n = keys_.size();
  segments_.resize(n - 1);
  tangents_.resize(n);
  std::vector<Twist> slopes(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    const double h = keys_[i + 1].time - keys_[i].time;
    segments_[i].turn = rotation_between(keys_[i].pose.orientation, keys_[i + 1].pose.orientation);
    slopes[i].linear = (keys_[i + 1].pose.position - keys_[i].pose.position) / h;
    slopes[i].angular = segments_[i].turn / h;
  }
  // The tangents of the first and last key stay 0: the hand starts and ends at rest.
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double h0 = keys_[i].time - keys_[i - 1].time;
    const double h1 = keys_[i + 1].time - keys_[i].time;
    tangents_[i].linear = monotone_slope(slopes[i - 1].linear, h0, slopes[i].linear, h1);
    tangents_[i].angular = monotone_slope(slopes[i - 1].angular, h0, slopes[i].angular, h1);
  }
}

PoseTrack::Sample PoseTrack::at(double time) noexcept {
  if (keys_.empty()) return {rest_, Twist{}};
  if (!(time > keys_.front().time)) return {keys_.front().pose, Twist{}};
  if (time >= keys_.back().time) return {keys_.back().pose, Twist{}};
  // Time mostly moves on by a little: look on from where the last answer was.
  if (last_ + 1 >= keys_.size() || keys_[last_].time > time) last_ = 0;
  while (keys_[last_ + 1].time <= time) ++last_;

  const PoseKey& from = keys_[last_];
  const PoseKey& to = keys_[last_ + 1];
  const Twist& t0 = tangents_[last_];
  const Twist& t1 = tangents_[last_ + 1];
  const double h = to.time - from.time;
  const Hermite w = hermite((time - from.time) / h);
  const glm::dvec3 way = to.pose.position - from.pose.position;
  const glm::dvec3 turn = segments_[last_].turn;

  Sample sample;
  sample.pose.position = from.pose.position + w.value * way + h * (w.d0 * t0.linear + w.d1 * t1.linear);
  sample.twist.linear = (w.rate_value / h) * way + w.rate_d0 * t0.linear + w.rate_d1 * t1.linear;
  const glm::dvec3 turned = w.value * turn + h * (w.d0 * t0.angular + w.d1 * t1.angular);
  sample.pose.orientation = rotate_by(from.pose.orientation, turned);
  // Exact while the axis keeps its direction; between keys that turn about different axes it is off by the
  // angle between them, which a damper does not mind.
  sample.twist.angular = (w.rate_value / h) * turn + w.rate_d0 * t0.angular + w.rate_d1 * t1.angular;
  return sample;
}

}  // namespace slosh
