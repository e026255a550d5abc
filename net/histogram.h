// Counts of durations in logarithmic bins: percentiles of millions of samples without keeping them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace slosh {

/// Durations from 100 ns to 100 s in bins 0.2 % wide. add() neither allocates nor locks; one thread owns it.
class Histogram {
 public:
  void add(double seconds) {
    if (!(seconds >= 0.0)) return;
    counts_[bin_of(seconds)] += 1;
    count_ += 1;
    sum_ += seconds;
    max_ = std::max(max_, seconds);
  }

  std::uint64_t count() const { return count_; }
  double max() const { return max_; }                                                     ///< s
  double mean() const { return count_ == 0 ? 0.0 : sum_ / static_cast<double>(count_); }  ///< s

  /// The duration that `share` (0–1) of the samples do not exceed, s, within 0.2 %; 0 without samples.
  double percentile(double share) const {
    if (count_ == 0) return 0.0;
    const auto wanted = static_cast<std::uint64_t>(std::ceil(share * static_cast<double>(count_)));
    std::uint64_t seen = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      seen += counts_[bin];
      if (seen >= std::max<std::uint64_t>(wanted, 1)) return std::min(middle(bin), max_);
    }
    return max_;
  }

 private:
  static constexpr double kSmallest = 1e-7;
  static constexpr double kBinsPerE = 500.0;   // bins a factor of e: 0.2 % each
  static constexpr std::size_t kBins = 10362;  // ln(1e9) · 500, rounded up

  static std::size_t bin_of(double seconds) {
    if (seconds <= kSmallest) return 0;
    const double place = std::log(seconds / kSmallest) * kBinsPerE;
    return std::min(static_cast<std::size_t>(place), kBins - 1);
  }
  static double middle(std::size_t bin) {
    return kSmallest * std::exp((static_cast<double>(bin) + 0.5) / kBinsPerE);
  }

  std::array<std::uint64_t, kBins> counts_{};
  std::uint64_t count_ = 0;
  double sum_ = 0.0;
  double max_ = 0.0;
};

}  // namespace slosh
