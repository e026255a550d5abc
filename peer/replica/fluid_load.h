// What acts on a held body besides its couplings, as a local linear model that is safe to integrate.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <utility>

#include "peer/replica/slosh_mode.h"
#include "sim/math/dense.h"
#include "sim/math/pose.h"

namespace slosh {

constexpr double kGoesOnTaken = 0.01;  ///< s over which a change of LoadField::kGoesOn is taken over

/// W = wrench + d_pose·δx + d_velocity·δv about a reference state: what acts on a body besides its couplings.
/// Order of the six: linear x, y, z, angular x, y, z; world axes; torque about the centre of mass. All zero:
/// nothing acts.
struct FluidLoad {
  Pose reference;                   ///< of the centre of mass and the body's axes
  Twist twist;                      ///< there
  Vector6 wrench{};                 ///< N, N·m
  glm::dvec3 late{0.0};             ///< N: of `wrench`, what is foreseen …
  glm::dvec3 goes_on{0.0};          ///< N: … which is this by now: followed at once
  double foreseen = 0.0;            ///< 0–1: how far it takes the place of `late`
  Matrix6 d_pose{};                 ///< N/m, N/rad, N·m/m, N·m/rad
  Matrix6 d_velocity{};             ///< N·s/m …
  Matrix6 added_mass{};             ///< kg, kg·m, kg·m²: symmetric, positive semidefinite
  double trust_distance = 0.01;     ///< m of δx beyond which the model goes on as at that distance
  double trust_angle = 0.1;         ///< rad, the same
  std::array<SloshMode, 3> swings;  ///< along x, y, z: what swings besides, whose force `wrench` is without
  glm::dvec3 bowl{0.0};  ///< s²/m, down, 1/g long: what swings rises by it (bowl_force); 0: it does not
};

/// How the replica takes over what the host says anew.
enum class LoadField {
  kAtOnce,
  kLate,      ///< over round trips, as what it answers to: fed back at once it would drive a swing as slow
  kForeseen,  ///< at once as far as the load is foreseen, the rest kLate
  kGoesOn,    ///< over kGoesOnTaken
};
template <class T>
struct LoadRow {
  T FluidLoad::* field;
  LoadField taken;
};
template <class T>
LoadRow(T FluidLoad::*, LoadField) -> LoadRow<T>;

/// All of FluidLoad.
inline constexpr std::tuple kLoadFields{
    LoadRow{&FluidLoad::reference, LoadField::kLate},
    LoadRow{&FluidLoad::twist, LoadField::kLate},
    LoadRow{&FluidLoad::wrench, LoadField::kLate},
    LoadRow{&FluidLoad::late, LoadField::kLate},
    LoadRow{&FluidLoad::goes_on, LoadField::kGoesOn},
    LoadRow{&FluidLoad::foreseen, LoadField::kAtOnce},
    LoadRow{&FluidLoad::d_pose, LoadField::kLate},
    LoadRow{&FluidLoad::d_velocity, LoadField::kLate},
    LoadRow{&FluidLoad::added_mass, LoadField::kForeseen},
    LoadRow{&FluidLoad::trust_distance, LoadField::kAtOnce},
    LoadRow{&FluidLoad::trust_angle, LoadField::kAtOnce},
    LoadRow{&FluidLoad::swings, LoadField::kAtOnce},
    LoadRow{&FluidLoad::bowl, LoadField::kAtOnce},
};
/// Calls `visit` with each row.
template <class Visit>
constexpr void for_each_load_field(Visit&& visit) {
  std::apply([&](const auto&... row) { (visit(row), ...); }, kLoadFields);
}
template <class... Rows>
constexpr std::size_t bytes_of(const std::tuple<Rows...>&) {
  return (sizeof(std::declval<FluidLoad&>().*std::declval<Rows>().field) + ...);
}
static_assert(bytes_of(kLoadFields) == sizeof(FluidLoad), "a field of FluidLoad is not in the table");

/// `at` goes `share` (0–1) of the way to `to`.
inline void ease(double& at, double to, double share) noexcept {
  at += share * (to - at);
}
inline void ease(glm::dvec3& at, const glm::dvec3& to, double share) noexcept {
  at += share * (to - at);
}
inline void ease(Pose& at, const Pose& to, double share) noexcept {
  ease(at.position, to.position, share);
  at.orientation = rotate_by(at.orientation, share * rotation_between(at.orientation, to.orientation));
}
inline void ease(Twist& at, const Twist& to, double share) noexcept {
  ease(at.linear, to.linear, share);
  ease(at.angular, to.angular, share);
}
inline void ease(SloshMode& at, const SloshMode& to, double share) noexcept {
  ease(at.mass, to.mass, share);
  ease(at.pace, to.pace, share);
  ease(at.damping, to.damping, share);
}
template <class T, std::size_t N>
void ease(std::array<T, N>& at, const std::array<T, N>& to, double share) noexcept {
  for (std::size_t i = 0; i < N; ++i) ease(at[i], to[i], share);
}

/// Not finite where one of its numbers is not.
inline double sum_of(double x) noexcept {
  return x;
}
inline double sum_of(const glm::dvec3& v) noexcept {
  return v.x + v.y + v.z;
}
inline double sum_of(const Pose& p) noexcept {
  return sum_of(p.position) + glm::dot(p.orientation, p.orientation);
}
inline double sum_of(const Twist& t) noexcept {
  return sum_of(t.linear) + sum_of(t.angular);
}
inline double sum_of(const SloshMode& m) noexcept {
  return m.mass + m.pace + m.damping;
}
template <class T, std::size_t N>
double sum_of(const std::array<T, N>& all) noexcept {
  double sum = 0.0;
  for (const T& each : all) sum += sum_of(each);
  return sum;
}

/// 0.5·(a + aᵀ)·sign.
inline Matrix6 symmetric_part(const Matrix6& a, double sign) {
  Matrix6 s{};
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j) s[i][j] = sign * 0.5 * (a[i][j] + a[j][i]);
  return s;
}

/// Whether `a` (symmetric) gives no energy: all eigenvalues ≥ −slack, in units of its own.
inline bool is_positive(Matrix6 a, double slack) {
  for (std::size_t i = 0; i < 6; ++i) a[i][i] += slack;
  Matrix6 factor;
  return cholesky(a, factor);
}

/// What a host says may be anything. Not finite: nothing is left of it. A damper that would drive, a spring
/// that would push away, or a mass that would pull is left out; the rest stays.
inline FluidLoad made_safe(FluidLoad load) noexcept {
  double sum = 0.0;
  for_each_load_field([&](const auto& row) { sum += sum_of(load.*row.field); });
  if (!std::isfinite(sum)) return FluidLoad{};
  constexpr double kSlack = 1e-6;
  if (!is_positive(symmetric_part(load.d_velocity, -1.0), kSlack)) load.d_velocity = Matrix6{};
  if (!is_positive(symmetric_part(load.d_pose, -1.0), kSlack)) load.d_pose = Matrix6{};
  if (!is_positive(symmetric_part(load.added_mass, 1.0), kSlack)) load.added_mass = Matrix6{};
  return load;
}

}  // namespace slosh
