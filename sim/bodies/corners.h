// Corners of a solid: what a flat body stands on, which samples of its surface miss.
#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <map>
#include <vector>

namespace slosh {

/// Where three faces and more meet, once for each of them, and that face's normal.
struct Corners {
  std::vector<glm::vec3> points, normals;
};

/// Told of each face's corners and its normal (unit); `Vec`: glm::vec3 or glm::dvec3.
template <class Vec>
class CornerFinder {
 public:
  void add(const Vec& corner, const Vec& normal) {
    constexpr auto kOtherFace = static_cast<typename Vec::value_type>(0.8);  // cosine
    std::vector<Vec>& normals = faces_at_[{corner.x, corner.y, corner.z}];
    if (std::ranges::none_of(normals, [&](const Vec& n) { return glm::dot(n, normal) > kOtherFace; }))
      normals.push_back(normal);
  }
  Corners found() const {
    Corners corners;
    for (const auto& [at, normals] : faces_at_) {
      if (normals.size() < 3) continue;
      for (const Vec& normal : normals) {
        corners.points.emplace_back(at[0], at[1], at[2]);
        corners.normals.emplace_back(normal);
      }
    }
    return corners;
  }

 private:
  std::map<std::array<typename Vec::value_type, 3>, std::vector<Vec>> faces_at_;
};

}  // namespace slosh
