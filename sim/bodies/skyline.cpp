#include "sim/bodies/skyline.h"

#include <algorithm>
#include <cmath>

namespace slosh {

void Skyline::clear(std::size_t size) {
  first_.resize(size);
  for (std::size_t i = 0; i < size; ++i) first_[i] = i;
  values_.assign(size * size, 0.0);
}

void Skyline::add(std::size_t row, std::size_t column, double value) {
  first_[row] = std::min(first_[row], column);
  at(row, column) += value;
}

bool Skyline::factor() {
  for (std::size_t i = 0; i < size(); ++i) {
    for (std::size_t j = first_[i]; j <= i; ++j) {
      double sum = at(i, j);
      for (std::size_t k = std::max(first_[i], first_[j]); k < j; ++k) sum -= at(i, k) * at(j, k);
      if (j < i) {
        at(i, j) = sum / at(j, j);
      } else {
        if (!(sum > 0.0) || !std::isfinite(sum)) return false;
        at(i, i) = std::sqrt(sum);
      }
    }
  }
  return true;
}

void Skyline::solve(std::vector<double>& x) const {
  for (std::size_t i = 0; i < size(); ++i) {
    for (std::size_t k = first_[i]; k < i; ++k) x[i] -= at(i, k) * x[k];
    x[i] /= at(i, i);
  }
  for (std::size_t i = size(); i-- > 0;) {
    x[i] /= at(i, i);
    for (std::size_t k = first_[i]; k < i; ++k) x[k] -= at(i, k) * x[i];
  }
}

}  // namespace slosh
