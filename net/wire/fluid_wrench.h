// FluidWrenchModel as a datagram.
#pragma once

#include <array>
#include <cstdint>

#include "net/wire/datagram_messages.h"
#include "sim/math/fluid_wrench.h"

namespace slosh::wire {

constexpr double kMaxDerivative = 1e9;  ///< of a 6×6 matrix's diagonal, SI
constexpr double kMaxTrust = 100.0;     ///< m, rad
constexpr double kMaxWrenchRate = 1e9;  ///< N/s, N·m/s

/// A symmetric positive semidefinite 6×6 matrix, as its diagonal and the correlations of its rows:
/// M_ij = √(M_ii · M_jj) · c_ij / 32767, c_ij an int16, little-endian, i < j row by row.
struct SemidefiniteCode {
  glm::vec3 linear{0.0f};   ///< diagonal, rows 0–2
  glm::vec3 angular{0.0f};  ///< rows 3–5
  std::array<std::uint8_t, 30> correlations{};
};
/// The nearest that can be written: what is not finite or negative on the diagonal becomes 0, what is no
/// correlation is drawn towards 0 until the whole is semidefinite.
SemidefiniteCode to_code(const Matrix6& matrix);
/// Only of a code that is_semidefinite().
Matrix6 to_matrix(const SemidefiniteCode& code);
/// Diagonal not negative, correlations those of a positive definite matrix, none with a row that is nothing.
bool is_semidefinite(const SemidefiniteCode& code);

/// Behind kFluidWrenches: the model of a body that the peer holds, as of the end of one step.
struct FluidWrench {
  static constexpr DatagramType kType = DatagramType::kFluidWrench;
  std::uint32_t run = 0;  ///< WorldInfo::run
  std::uint32_t body = 0;
  std::uint64_t tick = 0;
  double time = 0.0;  ///< simulated s
  Pose reference;     ///< of the centre of mass
  Twist twist;
  Wrench wrench;
  Wrench rate;
  double rate_span = 0.0;      ///< s
  SemidefiniteCode stiffness;  ///< −d_pose
  SemidefiniteCode damping;    ///< −d_velocity
  SemidefiniteCode added_mass;
  double trust_radius = 0.0;  ///< m
  double trust_angle = 0.0;   ///< rad
};

FluidWrench to_message(const FluidWrenchModel& model, std::uint32_t run);
/// Of a message that was decoded.
FluidWrenchModel to_model(const FluidWrench& message);

template <class V>
void visit(V& v, FluidWrench& m) {
  v.natural("run", m.run, 0, 0xffffffff);
  v.natural("body", m.body, 0, kMaxBodies - 1);
  v.natural("tick", m.tick, 0, kMaxTick);
  v.real64("time", m.time, -1.0, kMaxTime);
  visit(v, m.reference);
  visit(v, m.twist);
  visit(v, m.wrench);
  v.vec3("force_rate", m.rate.force, kMaxWrenchRate);
  v.vec3("torque_rate", m.rate.torque, kMaxWrenchRate);
  v.real32("rate_span", m.rate_span, 0.0, 10.0);
  v.vec3("stiffness_linear", m.stiffness.linear, kMaxDerivative);
  v.vec3("stiffness_angular", m.stiffness.angular, kMaxDerivative);
  v.array("stiffness_correlations", m.stiffness.correlations);
  v.rule("stiffness", is_semidefinite(m.stiffness), "is not positive semidefinite");
  v.vec3("damping_linear", m.damping.linear, kMaxDerivative);
  v.vec3("damping_angular", m.damping.angular, kMaxDerivative);
  v.array("damping_correlations", m.damping.correlations);
  v.rule("damping", is_semidefinite(m.damping), "is not positive semidefinite");
  v.vec3("added_mass_linear", m.added_mass.linear, kMaxDerivative);
  v.vec3("added_mass_angular", m.added_mass.angular, kMaxDerivative);
  v.array("added_mass_correlations", m.added_mass.correlations);
  v.rule("added_mass", is_semidefinite(m.added_mass), "is not positive semidefinite");
  v.real32("trust_radius", m.trust_radius, 0.0, kMaxTrust);
  v.real32("trust_angle", m.trust_angle, 0.0, kMaxTrust);
}

}  // namespace slosh::wire
