#include "net/wire/fluid_wrench.h"

#include <algorithm>
#include <cmath>

namespace slosh::wire {
namespace {

constexpr double kWhole = 32767.0;
constexpr int kPairs = 15;

using Correlations = std::array<std::int16_t, kPairs>;

Correlations correlations_of(const SemidefiniteCode& code) {
  Correlations c{};
  for (std::size_t k = 0; k < c.size(); ++k) {
    const auto low = static_cast<std::uint16_t>(code.correlations[2 * k]);
    const auto high = static_cast<std::uint16_t>(code.correlations[2 * k + 1]);
    c[k] = static_cast<std::int16_t>(static_cast<std::uint16_t>(high << 8 | low));
  }
  return c;
}

void put(const Correlations& c, SemidefiniteCode& code) {
  for (std::size_t k = 0; k < c.size(); ++k) {
    const auto raw = static_cast<std::uint16_t>(c[k]);
    code.correlations[2 * k] = static_cast<std::uint8_t>(raw & 0xff);
    code.correlations[2 * k + 1] = static_cast<std::uint8_t>(raw >> 8);
  }
}

// Calls f(i, j, k) for each pair of rows, k counting up.
template <class F>
void for_each_pair(F&& f) {
  std::size_t k = 0;
  for (int i = 0; i < 6; ++i) {
    for (int j = i + 1; j < 6; ++j) f(i, j, k++);
  }
}

double diagonal(const SemidefiniteCode& code, int i) {
  return static_cast<double>(i < 3 ? code.linear[i] : code.angular[i - 3]);
}

// Writers keep a margin, so that another compiler's rounding cannot refuse what they wrote.
constexpr double kMargin = 1e-6;

bool positive_definite(const Correlations& c, double margin) {
  Matrix6 matrix{};
  for (int i = 0; i < 6; ++i) matrix[i][i] = 1.0 - margin;
  for_each_pair([&](int i, int j, std::size_t k) { matrix[i][j] = matrix[j][i] = c[k] / kWhole; });
  Matrix6 factor;
  return cholesky(matrix, factor);
}

Matrix6 negative(Matrix6 matrix) {
  for (Vector6& row : matrix) {
    for (double& each : row) each = -each;
  }
  return matrix;
}

}  // namespace

bool is_semidefinite(const SemidefiniteCode& code) {
  const Correlations c = correlations_of(code);
  bool fine = true;
  for (int i = 0; i < 6; ++i) fine = fine && diagonal(code, i) >= 0.0;
  for_each_pair([&](int i, int j, std::size_t k) {
    fine = fine && (c[k] == 0 || (diagonal(code, i) > 0.0 && diagonal(code, j) > 0.0));
  });
  return fine && positive_definite(c, 0.0);
}

SemidefiniteCode to_code(const Matrix6& matrix) {
  SemidefiniteCode code;
  std::array<double, 6> root{};
  for (int i = 0; i < 6; ++i) {
    const double given = matrix[i][i];
    const auto rounded = static_cast<float>(given > 0.0 ? std::min(given, kMaxDerivative) : 0.0);
    (i < 3 ? code.linear[i] : code.angular[i - 3]) = rounded;
    root[i] = std::sqrt(static_cast<double>(rounded));
  }
  std::array<double, kPairs> exact{};
  for_each_pair([&](int i, int j, std::size_t k) {
    const double size = root[i] * root[j];
    const double c = size > 0.0 ? 0.5 * (matrix[i][j] + matrix[j][i]) / size : 0.0;
    exact[k] = std::isfinite(c) ? std::clamp(c, -1.0, 1.0) : 0.0;
  });
  // Rounding may take a matrix that is nearly singular over the edge; drawn in by what rounding can do and
  // then by more and more, every matrix gets there.
  Correlations c{};
  double keep = 1.0;
  for (double give = 2e-4;; give = std::min(2.0 * give, 1.0)) {
    for (std::size_t k = 0; k < c.size(); ++k)
      c[k] = static_cast<std::int16_t>(std::lround(keep * exact[k] * kWhole));
    if (positive_definite(c, kMargin)) break;
    keep = 1.0 - give;
  }
  put(c, code);
  return code;
}

Matrix6 to_matrix(const SemidefiniteCode& code) {
  const Correlations c = correlations_of(code);
  Matrix6 matrix{};
  for (int i = 0; i < 6; ++i) matrix[i][i] = diagonal(code, i);
  for_each_pair([&](int i, int j, std::size_t k) {
    matrix[i][j] = matrix[j][i] = std::sqrt(matrix[i][i]) * std::sqrt(matrix[j][j]) * (c[k] / kWhole);
  });
  return matrix;
}

FluidWrench to_message(const FluidWrenchModel& model, std::uint32_t run) {
  FluidWrench m;
  m.run = run;
  m.body = model.body;
  m.tick = model.tick;
  m.time = model.time;
  m.reference = model.reference;
  m.twist = model.twist;
  m.wrench = model.wrench;
  m.rate = model.rate;
  m.rate_span = model.rate_span;
  m.stiffness = to_code(negative(model.d_pose));
  m.damping = to_code(negative(model.d_velocity));
  m.added_mass = to_code(model.added_mass);
  m.trust_radius = model.trust_radius;
  m.trust_angle = model.trust_angle;
  return m;
}

FluidWrenchModel to_model(const FluidWrench& m) {
  FluidWrenchModel model;
  model.body = m.body;
  model.tick = m.tick;
  model.time = m.time;
  model.reference = m.reference;
  model.twist = m.twist;
  model.wrench = m.wrench;
  model.rate = m.rate;
  model.rate_span = m.rate_span;
  model.d_pose = negative(to_matrix(m.stiffness));
  model.d_velocity = negative(to_matrix(m.damping));
  model.added_mass = to_matrix(m.added_mass);
  model.trust_radius = m.trust_radius;
  model.trust_angle = m.trust_angle;
  return model;
}

}  // namespace slosh::wire
