#include "sim/walls/mirror_planes.h"

#include <cmath>

#include "sim/walls/point_buckets.h"

namespace slosh {
namespace {

// Below this share of what an even layer has the neighbours lie on a line, or there is none.
constexpr double kTooFew = 1e-3;

// The normals around as a linear function of the place along the surface, by weighted least squares.
class Fit {
 public:
  Fit(const glm::vec3& normal) : normal_(normal) {
    const glm::vec3 beside = std::abs(normal.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    along_[0] = glm::normalize(glm::cross(normal, beside));
    along_[1] = glm::cross(normal, along_[0]);
  }

  /// A sample `off` away, in reaches, as far as it counts.
  void add(const glm::vec3& off, const glm::vec3& normal, double weight) {
    const double u = glm::dot(off, along_[0]), v = glm::dot(off, along_[1]);
    moments_.xx += weight;
    moments_.xy += weight * u;
    moments_.xz += weight * v;
    moments_.yy += weight * u * u;
    moments_.yz += weight * u * v;
    moments_.zz += weight * v * v;
    const double by[3] = {weight, weight * u, weight * v};
    for (int k = 0; k < 3; ++k) sums_[k] += by[k] * glm::dvec3(normal);
  }

  MirrorPlane plane(float reach) const {
    const double all = moments_.xx;
    if (determinant(moments_) < kTooFew * all * all * all) return {normal_, {}};
    const Symmetric<double> inverted = inverse(moments_);
    glm::dvec3 fitted[3];  // the normal here, and what it gains along both directions
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3<double> c = times(inverted, sums_[0][axis], sums_[1][axis], sums_[2][axis]);
      fitted[0][axis] = c.x;
      fitted[1][axis] = c.y;
      fitted[2][axis] = c.z;
    }
    const double length = glm::length(fitted[0]);
    const glm::dvec3 n = fitted[0] / length;
    glm::dmat3 gain(0.0);
    for (int k = 0; k < 2; ++k) {
      const glm::dvec3 across = fitted[k + 1] - glm::dot(fitted[k + 1], n) * n;
      gain += glm::outerProduct(across / (length * reach), glm::dvec3(along_[k]));
    }
    gain = 0.5 * (gain + glm::transpose(gain));  // a distance's second derivative
    const auto at = [&](int i, int j) { return static_cast<float>(gain[j][i]); };
    return {glm::vec3(n), {at(0, 0), at(0, 1), at(0, 2), at(1, 1), at(1, 2), at(2, 2)}};
  }

 private:
  glm::vec3 normal_;
  glm::vec3 along_[2];
  Symmetric<double> moments_{};
  glm::dvec3 sums_[3] = {glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)};
};

}  // namespace

std::vector<MirrorPlane> mirror_planes(std::span<const glm::vec3> positions,
                                       std::span<const glm::vec3> normals, float reach) {
  PointBuckets near(reach);
  for (const glm::vec3& p : positions) near.add(p);
  std::vector<MirrorPlane> planes;
  planes.reserve(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    Fit fit(normals[i]);
    near.around(positions[i], [&](const glm::vec3& q, std::uint32_t n) {
      const glm::vec3 off = (q - positions[i]) / reach;
      const float left = 1.0f - glm::length(off);
      if (left > 0.0f && glm::dot(normals[n], normals[i]) > kOneFace) fit.add(off, normals[n], left * left);
    });
    planes.push_back(fit.plane(reach));
  }
  return planes;
}

}  // namespace slosh
