// Wrenches, twists and inertias in vector6, for the replica's solve: linear x, y, z first, then angular.
#pragma once

#include "sim/math/dense.h"
#include "sim/math/pose.h"

namespace slosh::vector6 {

inline glm::dvec3 linear(const Vector6& v) {
  return {v[0], v[1], v[2]};
}
inline glm::dvec3 angular(const Vector6& v) {
  return {v[3], v[4], v[5]};
}
inline Vector6 six(const glm::dvec3& a, const glm::dvec3& b) {
  return {a.x, a.y, a.z, b.x, b.y, b.z};
}
inline Vector6 product(const Matrix6& m, const Vector6& v) {
  Vector6 out{};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) out[i] += m[i][j] * v[j];
  return out;
}
inline void add(Vector6& to, const Vector6& v, double factor = 1.0) {
  for (std::size_t i = 0; i < 6; ++i) to[i] += factor * v[i];
}
inline void add(Matrix6& to, const Matrix6& m, double factor) {
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) to[i][j] += factor * m[i][j];
}
/// What a gain k at arm r on a velocity is for the twist of the centre of mass: k·[1, −r×; r×, −r×r×].
inline void add_gain(Matrix6& to, double k, const glm::dvec3& r) {
  const double x[3][3] = {{0.0, -r.z, r.y}, {r.z, 0.0, -r.x}, {-r.y, r.x, 0.0}};
  for (std::size_t i = 0; i < 3; ++i) {
    to[i][i] += k;
    for (std::size_t j = 0; j < 3; ++j) {
      to[i][3 + j] -= k * x[i][j];
      to[3 + i][j] += k * x[i][j];
      for (std::size_t l = 0; l < 3; ++l) to[3 + i][3 + j] -= k * x[i][l] * x[l][j];
    }
  }
}
inline glm::dvec3 clipped(const glm::dvec3& v, double most) {
  const double length = glm::length(v);
  return length > most ? v * (most / length) : v;
}
inline glm::dmat3 turned(const glm::dmat3& inertia, const glm::dquat& orientation) {
  const glm::dmat3 r = glm::mat3_cast(orientation);
  return r * inertia * glm::transpose(r);
}

}  // namespace slosh::vector6
