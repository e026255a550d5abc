#include "host/report/surface.h"

#include <algorithm>
#include <cmath>

namespace slosh::report {

double top_at(const Snapshot& picture, const glm::dvec2& place, double spacing) {
  double top = -1.0;
  for (std::size_t n = 0; n < picture.positions.size(); ++n) {
    const glm::vec3& p = picture.positions[n];
    if (picture.fluid_index[n] != 255 && std::abs(p.x - place.x) < 1.5 * spacing &&
        std::abs(p.z - place.y) < 1.5 * spacing)
      top = std::max<double>(top, p.y);
  }
  return top + 0.5 * spacing;
}

double surface_level(const Snapshot& picture, const glm::dvec2& low, const glm::dvec2& high, double spacing) {
  constexpr int kPlaces = 4;
  double sum = 0.0;
  for (int i = 0; i < kPlaces * kPlaces; ++i) {
    const glm::dvec2 at((i / kPlaces + 0.5) / kPlaces, (i % kPlaces + 0.5) / kPlaces);
    sum += top_at(picture, glm::mix(low, high, at), spacing);
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

}  // namespace slosh::report
