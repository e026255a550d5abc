// Which slosh mode of a held body's fluid explains what the host said of its motion and forces, along one
// axis.
#pragma once

#include <array>
#include <cstddef>

#include "peer/replica/slosh_mode.h"
#include "peer/replica/slosh_record.h"
#include "peer/replica/slosh_search.h"

namespace slosh {

/// The fluid's force on the body is taken for
///   F = F₀ − rigid·a − drag·v + (the mode's force),
/// rigid, drag and the mode's mass ≥ 0: passive whatever is found. A bank of modes over pace and damping is
/// moved by the body's motion; for each the other numbers are least squares with forgetting, of both sides
/// through one low-pass. From the best of the bank a search goes on between its modes; in a vessel it is
/// between the best and its neighbours by a parabola. The mode's state is an observer's: drawn to what the
/// force says. Neither allocates nor reads a clock; one thread.
class SloshFinder {
 public:
  /// `most`: kg that a mode may have.
  void restart(double most) noexcept;
  /// What is taken to be so before anything has moved: kg that go with the body, kg that swing, rad/s.
  /// Followed at once.
  void expect(double rigid, double mass, double pace) noexcept;
  /// What the host's own line says: kg that go along, slowly moved, and N·s/m; 0: nothing. It is what is
  /// taken to be so where nothing else is expected.
  void tell(double mass, double drag) noexcept {
    prior_.told_mass = mass;
    prior_.told_drag = drag;
  }
  /// What is carried is `share` times what it was, > 0: so are all masses, and what was told is taken to have
  /// been of that.
  void lighten(double share) noexcept;
  /// Over the last `dt` s the body went from velocity `before` to `now`, and the fluid put the mean force
  /// `force` on it.
  void add_sample(double dt, double before, double now, double force) noexcept;

  const SloshMode& mode() const noexcept { return mode_; }
  const SloshState& state() const noexcept { return state_; }  ///< at the newest update
  double rigid() const noexcept { return rigid_; }             ///< kg
  double drag() const noexcept { return drag_; }               ///< N·s/m
  /// How far all that is to be followed, 0–1: by how much the mode explains of what neither rigid mass nor
  /// damper does.
  double share() const noexcept { return share_; }

 private:
  static constexpr std::size_t kPaces = 32;
  static constexpr std::size_t kDampings = 5;

  struct LowPass {
    double once = 0.0, twice = 0.0;
    void to(double x, double share) {
      once += share * (x - once);
      twice += share * (once - twice);
    }
  };
  struct Candidate {
    SloshStep step;
    SloshState state;
    LowPass low;
    ModeSums sums;
  };
  struct Cell {
    std::size_t pace = 0, damping = 0;
  };
  struct Found {
    SloshMode mode;  // its mass is the fit's
    SloshFit with, without;
    bool at_an_end = false;  // of the paces: it is something else that is so slow or so quick
  };
  static double pace_of(double i);
  static double damping_of(double j);
  void observe(double dt, double before, double now, double force) noexcept;
  void look_on(double dt) noexcept;
  Cell best_cell() const noexcept;
  Found between_neighbours(Cell best) const noexcept;
  void choose(double seconds) noexcept;
  void adopt(const Found& found, Cell best, double seconds) noexcept;

  std::array<double, kPaces> paces_{};  // rad/s
  std::array<std::array<Candidate, kDampings>, kPaces> bank_{};
  SloshSums sums_;
  LowPass a_, f_, v_;
  double bank_step_ = 0.0;  // s that the bank's steps are for
  bool known_ = false;
  std::array<std::array<SloshFit, kDampings>, kPaces> fits_{};  // each sweep's, row by row
  std::size_t row_ = 0;
  double swept_ = 0.0;  // s that this sweep has taken
  SloshRecord record_;
  SloshSearch search_;

  double most_ = 0.0;
  SloshPrior prior_;
  SloshMode mode_;
  SloshState state_;
  double rigid_ = 0.0, drag_ = 0.0, constant_ = 0.0, share_ = 0.0;
};

}  // namespace slosh
