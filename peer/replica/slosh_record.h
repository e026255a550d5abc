// What the host said lately of a held body's motion and of the fluid's force along one axis, to try any slosh
// mode on.
#pragma once

#include <array>
#include <cstddef>

#include "peer/replica/slosh_fit.h"
#include "peer/replica/slosh_mode.h"

namespace slosh {

/// Some 10 s, in means over kBlock. Allocates nothing, reads no clock; one thread.
class SloshRecord {
 public:
  void restart() noexcept { *this = SloshRecord{}; }
  /// m/s², m/s, N over `dt` s, all through one low-pass. What is forgotten was moving `mode`, or, where that
  /// has no mass, nothing.
  void add_sample(double dt, double acceleration, double velocity, double force,
                  const SloshMode& mode) noexcept;
  /// All forces were `share` times as large.
  void lighten(double share) noexcept;
  /// How many blocks have come; the last `kBlocks` are there.
  std::size_t count() const noexcept { return count_; }
  /// Of the blocks before `end`, ≤ count(), what `mode` (its mass does not count), rigid mass and drag
  /// explain; null: these alone. `sums`, if not null, is given them.
  SloshFit fit(const SloshMode* mode, const SloshPrior& prior, std::size_t end,
               SloshSums* sums = nullptr) const noexcept;

 private:
  static constexpr double kBlock = 0.02;  // s
  static constexpr std::size_t kBlocks = 512;

  struct Block {
    double dt = 0.0, keep = 1.0;
    double acceleration = 0.0, velocity = 0.0, force = 0.0;  // means
  };
  std::array<Block, kBlocks> blocks_{};
  std::size_t count_ = 0;
  Block open_;        // its last three are sums over the time
  SloshState begin_;  // of the mode, where the oldest block begins
};

}  // namespace slosh
