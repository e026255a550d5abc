// Small dense symmetric systems: the 6×6 of a rigid body with implicit couplings.
#pragma once

#include <array>
#include <cmath>

#include "sim/math/host_device.h"

namespace slosh {

using Vector6 = std::array<double, 6>;
using Matrix6 = std::array<Vector6, 6>;

/// Lower Cholesky factor of a symmetric positive definite matrix. False when a pivot is not positive and
/// finite.
SLOSH_HD inline bool cholesky(const Matrix6& a, Matrix6& lower) {
  lower = {};
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (int k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
      if (i == j) {
        if (!(sum > 0.0) || !std::isfinite(sum)) return false;
        lower[i][i] = std::sqrt(sum);
      } else {
        lower[i][j] = sum / lower[j][j];
      }
    }
  }
  return true;
}

/// Solves L·Lᵀ·x = b.
SLOSH_HD inline Vector6 cholesky_solve(const Matrix6& lower, Vector6 b) {
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < i; ++k) b[i] -= lower[i][k] * b[k];
    b[i] /= lower[i][i];
  }
  for (int i = 5; i >= 0; --i) {
    for (int k = i + 1; k < 6; ++k) b[i] -= lower[k][i] * b[k];
    b[i] /= lower[i][i];
  }
  return b;
}

}  // namespace slosh
