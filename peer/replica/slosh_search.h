// Between the modes of a bank: the pace and the damping that explain most of what is on record.
#pragma once

#include <cstddef>

#include "peer/replica/slosh_record.h"

namespace slosh {

/// Goes from where it is to the best of its neighbours by logarithms, of which one is on the way that it goes
/// (Hooke & Jeeves 1961: what swings differs little from what is dragged along a narrow valley), with steps
/// that grow while it goes and shrink while it stays. One try a call. One thread.
class SloshSearch {
 public:
  static constexpr double kMinDamping = 0.003, kMaxDamping = 0.5;

  /// Between these, rad/s.
  void restart(double slowest, double fastest) noexcept;
  /// Goes on from there, where that explains more of the record than what it has.
  void propose(double pace, double damping, const SloshRecord& record, const SloshPrior& prior) noexcept;
  void look_on(const SloshRecord& record, const SloshPrior& prior) noexcept;

  bool found() const noexcept { return rounds_ > 0; }
  /// Of 1 kg; before anything was proposed none that swings.
  const SloshMode& mode() const noexcept { return mode_; }
  const SloshFit& fit() const noexcept { return fit_; }          ///< of mode(), as of the last round
  const SloshFit& without() const noexcept { return without_; }  ///< the same of no mode
  /// N², what mode() does not explain, the mean.
  double unexplained() const noexcept { return unexplained_; }
  bool at_an_end() const noexcept;  ///< of the paces: it is something else that is so slow or so quick

 private:
  static constexpr std::size_t kNeighbours = 5;  // the first twice as far on as it went last
  SloshMode neighbour(std::size_t which) const noexcept;
  void end_round() noexcept;

  double slowest_ = 1.0, fastest_ = 1.0;
  SloshMode mode_;
  double pace_step_ = 0.0, damping_step_ = 0.0;  // of logarithms
  double gone_pace_ = 1.0, gone_damping_ = 1.0;  // in the last round, times what it was
  std::size_t tried_ = 0, end_ = 0;              // in this round; the record's blocks that it is of
  SloshMode best_;                               // of this round
  SloshFit best_fit_, fit_, without_;
  SloshFit looked_without_;
  double weight_ = 0.0;  // s
  double unexplained_ = 1.0;
  std::size_t rounds_ = 0;
};

}  // namespace slosh
