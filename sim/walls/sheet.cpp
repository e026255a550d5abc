#include "sim/walls/sheet.h"

#include <cmath>

#include "sim/math/kernels.h"
#include "sim/pressure/pair_pressure.h"
#include "sim/walls/point_buckets.h"

namespace slosh {

SheetParticle moved(const Pose& pose, const SheetParticle& p) {
  const auto place = [&](const glm::vec3& at) { return glm::vec3(transform_point(pose, glm::dvec3(at))); };
  return {place(p.position), place(p.surface), glm::vec3(pose.orientation * glm::dvec3(p.normal)), p.depth};
}

// Akinci 2012's volume correction: kWallShare on a flat sheet at the spacing; where sheets crowd or cross
// (corners, thin walls) the particles share what one sheet would be.
std::vector<float> sheet_shares(std::span<const SheetParticle> sheet, const Plan& plan) {
  const float h = static_cast<float>(plan.support_radius);
  double flat = 0.0;
  const int reach = static_cast<int>(std::ceil(plan.support_radius / plan.spacing));
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      flat += spiky_shape<double>(plan.spacing * plan.spacing * (x * x + y * y), h);
    }
  }
  PointBuckets near(h);
  for (const SheetParticle& p : sheet) near.add(p.position);
  std::vector<float> shares;
  shares.reserve(sheet.size());
  for (const SheetParticle& particle : sheet) {
    const glm::vec3& p = particle.position;
    double sum = 0.0;
    near.around(
        p, [&](const glm::vec3& q, std::uint32_t) { sum += spiky_shape<double>(glm::dot(p - q, p - q), h); });
    shares.push_back(static_cast<float>(kWallShare * flat / sum));
  }
  return shares;
}

}  // namespace slosh
