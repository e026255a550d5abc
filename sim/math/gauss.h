// Small dense systems that are not symmetric, solved once.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>

namespace slosh {

/// Solves A·x = b by Gauss' elimination with partial pivoting: `rows` is A, n × n row by row, and is used up;
/// `b` becomes x. False, with both spoilt, when a pivot is smaller than `least` or not finite.
inline bool solve_dense(std::span<double> rows, std::span<double> b, double least = 0.0) {
  const std::size_t n = b.size();
  const auto row = [&](std::size_t i) { return rows.data() + i * n; };
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(row(i)[k]) > std::abs(row(pivot)[k])) pivot = i;
    if (const double most = std::abs(row(pivot)[k]); !(most > 0.0) || most < least || !std::isfinite(most))
      return false;
    if (pivot != k) {
      std::swap_ranges(row(k), row(k) + n, row(pivot));
      std::swap(b[k], b[pivot]);
    }
    for (std::size_t i = k + 1; i < n; ++i) {
      const double w = row(i)[k] / row(k)[k];
      for (std::size_t j = k + 1; j < n; ++j) row(i)[j] -= w * row(k)[j];
      b[i] -= w * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] -= row(k)[j] * b[j];
    b[k] /= row(k)[k];
  }
  return true;
}

}  // namespace slosh
