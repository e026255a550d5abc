#include "tests/lab/report/surface.h"

#include <algorithm>
#include <cmath>

#include "sim/instruments.h"

namespace slosh::report {

double surface_level(const Snapshot& picture, const glm::dvec2& low, const glm::dvec2& high, double spacing) {
  constexpr int kPlaces = 4;
  double sum = 0.0;
  for (int i = 0; i < kPlaces * kPlaces; ++i) {
    const glm::dvec2 at((i / kPlaces + 0.5) / kPlaces, (i % kPlaces + 0.5) / kPlaces);
    const glm::dvec2 place = glm::mix(low, high, at);
    sum += fluid_level(picture, {place.x, 0.0, place.y}, {0.0, 1.0, 0.0}, spacing);
  }
  return sum / (kPlaces * kPlaces);
}

double slope_of(const std::vector<glm::dvec2>& points) {
  glm::dvec2 mean(0.0);
  for (const glm::dvec2& p : points) mean += p / static_cast<double>(points.size());
  double xx = 0.0, xy = 0.0;
  for (const glm::dvec2& p : points) {
    xx += (p.x - mean.x) * (p.x - mean.x);
    xy += (p.x - mean.x) * (p.y - mean.y);
  }
  return xy / xx;
}

std::size_t count_outside(const Snapshot& picture, const Pose& vessel, const Room& room) {
  const Pose to_vessel = inverse(vessel);
  std::size_t outside = 0;
  for (std::size_t i = 0; i < picture.positions.size(); ++i) {
    if (picture.fluid_index[i] == kRetired) {
      ++outside;
      continue;
    }
    const glm::dvec3 p = transform_point(to_vessel, glm::dvec3(picture.positions[i]));
    const bool beyond = glm::any(glm::lessThan(p, room.low)) || glm::any(glm::greaterThan(p, room.high));
    outside += beyond && !(room.open && p.y > room.high.y);
  }
  return outside;
}

double share_outside(const Snapshot& picture, const Pose& vessel, const Room& room) {
  return static_cast<double>(count_outside(picture, vessel, room)) /
         static_cast<double>(std::max<std::size_t>(picture.positions.size(), 1));
}

}  // namespace slosh::report
