// What the tests of the input gate share: a scene, messages and a world's state made of numbers.
#pragma once

#include <limits>

#include "host/input_gate.h"

namespace slosh {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

inline Scene scene_with_grips(std::size_t count) {
  Scene scene;
  scene.domain_min = {-1, -1, -1};
  scene.domain_max = {1, 1, 1};
  scene.grips.resize(count);
  for (Grip& grip : scene.grips) grip.body = 0;
  return scene;
}

inline PoseMessage message(std::uint32_t device, double x = 0.0, std::int64_t stamp_ns = 0) {
  PoseMessage m;
  m.device = device;
  m.engaged = true;
  m.stamp_ns = stamp_ns;
  m.pose.position.x = x;
  return m;
}

/// What its device says now.
inline void tell(Channel& channel, const PoseMessage& m) {
  channel.pose(m.device).back() = m;
  channel.pose(m.device).publish();
}

inline BodySnapshot snapshot_with_grips(std::size_t count) {
  BodySnapshot snapshot;
  snapshot.grips.resize(count);
  return snapshot;
}

}  // namespace slosh
