// A symmetric positive definite matrix of which each row begins late: what joints in chains make.
#pragma once

#include <cstddef>
#include <vector>

namespace slosh {

class Skyline {
 public:
  /// All zero, `size` rows.
  void clear(std::size_t size);
  std::size_t size() const { return first_.size(); }
  /// Adds to row and column, column <= row.
  void add(std::size_t row, std::size_t column, double value);
  /// By its Cholesky factor from here on. False where it is not positive definite.
  bool factor();
  /// Solves for `x` in place, after factor().
  void solve(std::vector<double>& x) const;

 private:
  double& at(std::size_t row, std::size_t column) { return values_[row * first_.size() + column]; }
  double at(std::size_t row, std::size_t column) const { return values_[row * first_.size() + column]; }

  std::vector<std::size_t> first_;  // of each row's entries that are not 0
  std::vector<double> values_;
};

}  // namespace slosh
