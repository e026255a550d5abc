// Which slosh mode of a held body's fluid explains what the host said of its motion and forces, along one
// axis.
#pragma once

#include <array>
#include <cstddef>

#include "peer/haptics/replica/slosh_mode.h"

namespace slosh {

/// The fluid's force on the body is taken for
///   F = F₀ − rigid·a − drag·v + (the mode's force),
/// rigid, drag and the mode's mass ≥ 0: passive whatever is found. A bank of modes over pace and damping is
/// moved by the body's motion; for each the other numbers are least squares with forgetting, of both sides
/// through one low-pass; the best of the bank, between its neighbours, is the mode. Its state is an
/// observer's: drawn to what the force says. Neither allocates nor reads a clock; one thread.
class SloshFinder {
 public:
  /// `most`: kg that a mode may have.
  void restart(double most) noexcept {
    *this = SloshFinder{};
    most_ = most;
  }
  /// What is taken to be so before anything has moved: kg that go with the body, kg that swing, rad/s.
  /// Followed at once.
  void expect(double rigid, double mass, double pace) noexcept;
  /// What is carried is `share` times what it was, > 0: so are all masses, and what was told is taken to have
  /// been of that.
  void lighten(double share) noexcept;
  /// Over the last `dt` s the body went from velocity `before` to `now`, and the fluid put the mean force
  /// `force` on it.
  void hear(double dt, double before, double now, double force) noexcept;

  const SloshMode& mode() const noexcept { return mode_; }
  const SloshState& state() const noexcept { return state_; }  ///< at the newest word
  double rigid() const noexcept { return rigid_; }             ///< kg
  double drag() const noexcept { return drag_; }               ///< N·s/m
  /// How far all that is to be followed, 0–1: by how much the mode explains of what neither rigid mass nor
  /// damper does.
  double share() const noexcept { return share_; }

 private:
  static constexpr std::size_t kPaces = 32;
  static constexpr std::size_t kDampings = 5;
  static constexpr std::size_t kCommon = 3;  // 1, −a, −v

  struct LowPass {
    double once = 0.0, twice = 0.0;
    void to(double x, double share) {
      once += share * (x - once);
      twice += share * (once - twice);
    }
  };
  struct Candidate {
    SloshStep step;
    double pace = 1.0;  // rad/s
    SloshState state;
    LowPass low;
    std::array<double, kCommon> with{};  // Σ φ·(1, −a, −v)
    double square = 0.0, answer = 0.0;   // Σ φ², Σ φ·F
  };
  struct Fit {
    std::array<double, kCommon + 1> x{};  // F₀, rigid, drag, mass
    double rest = 0.0;                    // Σ of squares that is left
  };
  static double pace_of(double i);
  static double damping_of(double j);
  /// Null: no mode, the rest alone.
  Fit fit(const Candidate* candidate) const;
  void look_on(double dt) noexcept;
  void choose(double seconds) noexcept;

  std::array<double, kPaces> paces_{};  // rad/s
  std::array<std::array<Candidate, kDampings>, kPaces> bank_{};
  std::array<std::array<double, kCommon>, kCommon> common_{};
  std::array<double, kCommon> common_answer_{};
  double force_square_ = 0.0;
  double weight_ = 0.0;
  LowPass a_, f_, v_;
  double bank_step_ = 0.0;  // s that the bank's steps are for
  bool known_ = false;
  std::array<std::array<Fit, kDampings>, kPaces> fits_{};  // each sweep's, row by row
  std::size_t row_ = 0;
  double swept_ = 0.0;  // s that this sweep has taken

  double most_ = 0.0;
  bool expects_ = false;
  double expected_rigid_ = 0.0, expected_mass_ = 0.0, expected_pace_ = 0.0;
  SloshMode mode_;
  SloshState state_;
  double rigid_ = 0.0, drag_ = 0.0, constant_ = 0.0, share_ = 0.0;
};

}  // namespace slosh
