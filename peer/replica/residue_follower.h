// What no model explains of the fluid's force along one axis, as it will be by the time that it is felt.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace slosh {

/// s of a low-pass: what comes `horizon` s late is not to be followed quicker. Half of that; more where it is
/// as long as water takes to swing, as what is followed in the wrong phase drives who is moved by it.
constexpr double quickest_followed(double horizon) {
  return horizon * (horizon > 0.2 ? horizon / 0.4 : 0.5);
}

/// What lasts, and of what is quicker, in steps from a second to 0.03 s and on to how it goes on, as much as
/// would have foreseen best what was told lately: each step's share, 0–1, by least squares with forgetting.
/// So weight that is poured out is followed at once, and what goes to and fro as quick as the way here, where
/// late is worse than never, is not. Neither reads a clock nor allocates once made; one thread.
class ResidueFollower {
 public:
  ResidueFollower() : said_(kRemembered) {}

  void restart() noexcept {
    known_ = false;
    foreseen_ = 0.0;
  }
  /// `told`: N, the mean over the last `elapsed` s, > 0; `horizon`: s ≥ 0 from there to when it is felt;
  /// `most`: N, ≥ 0, by which it goes on beyond what was told.
  void update(double elapsed, double told, double horizon, double most) noexcept;
  bool known() const noexcept { return known_; }
  double foreseen() const noexcept { return foreseen_; }  ///< N, a horizon after the last update
  double lasting() const noexcept { return low_[0]; }     ///< N: over a second

 private:
  static constexpr std::size_t kRemembered = 1024;  // updates
  static constexpr std::size_t kLows = 4;
  static constexpr std::size_t kSteps = 4;  // from one to the next of them, and on
  using Steps = std::array<double, kSteps>;

  void begin(double told) noexcept;
  void learn(double elapsed, double told, double horizon) noexcept;

  struct Said {
    double time = 0.0;  // s
    double lasting = 0.0;
    Steps steps{};
  };
  std::vector<Said> said_;
  std::size_t newest_ = 0, count_ = 0;
  double time_ = 0.0, foreseen_ = 0.0;
  std::array<double, kLows> low_{};
  double going_ = 0.0, gone_ = 0.0;   // N: how it goes is by their difference
  std::array<Steps, kSteps> both_{};  // N²: means of products of steps …
  Steps answer_{}, shares_{};         // N²: … with what was told
  bool known_ = false;
};

}  // namespace slosh
