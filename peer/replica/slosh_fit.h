// What a slosh mode, rigid mass and drag explain of the fluid's force on a held body along one axis: least
// squares.
#pragma once

#include <array>
#include <cstddef>

namespace slosh {

constexpr double kSloshMemory = 3.0;  ///< s, the forgetting's time constant

/// Over the time, with forgetting: means times its length of what does not depend on a mode.
struct SloshSums {
  static constexpr std::size_t kCommon = 3;  // 1, −a, −v
  using Common = std::array<double, kCommon>;

  std::array<Common, kCommon> common{};
  Common answer{};            ///< with F
  double force_square = 0.0;  ///< N²·s
  double weight = 0.0;        ///< s

  /// `keep`: what is left of all before; a, v, F: m/s², m/s, N over `dt` s.
  void add(double dt, double keep, const Common& x, double force) noexcept {
    for (std::size_t p = 0; p < kCommon; ++p) {
      for (std::size_t q = 0; q < kCommon; ++q) common[p][q] = keep * common[p][q] + dt * x[p] * x[q];
      answer[p] = keep * answer[p] + dt * x[p] * force;
    }
    force_square = keep * force_square + dt * force * force;
    weight = keep * weight + dt;
  }
  /// All forces were `share` times as large.
  void lighten(double share) noexcept {
    for (double& each : answer) each *= share;
    force_square *= share * share;
  }
};

/// The same of the force φ of a mode of 1 kg.
struct ModeSums {
  SloshSums::Common with{};           ///< φ·(1, −a, −v)
  double square = 0.0, answer = 0.0;  ///< φ², φ·F

  void add(double dt, double keep, double phi, const SloshSums::Common& x, double force) noexcept {
    for (std::size_t p = 0; p < x.size(); ++p) with[p] = keep * with[p] + dt * phi * x[p];
    square = keep * square + dt * phi * phi;
    answer = keep * answer + dt * phi * force;
  }
};

/// What is taken to be so before anything has moved.
struct SloshPrior {
  bool vessel = false;                         ///< by what is carried:
  double rigid = 0.0, mass = 0.0, pace = 1.0;  ///< kg that go along, kg that swing, rad/s, > 0
  /// Elsewhere, where above 0: kg of both together, N·s/m, by the host's own line.
  double told_mass = 0.0, told_drag = 0.0;
  /// N², what no model explains, the mean: the less that is, the less counts what was not seen.
  double unexplained = 1.0;
};

/// F = F₀ − rigid·a − drag·v + mass·φ, rigid, drag, mass ≥ 0.
struct SloshFit {
  double constant = 0.0, rigid = 0.0, drag = 0.0, mass = 0.0;
  double rest = 0.0;         ///< N²·s: squares that are left, with what it is off what was taken to be so …
  double unexplained = 0.0;  ///< … and without
};

/// `mode` null: none; `pace`: its, rad/s.
SloshFit fit_slosh(const SloshSums& sums, const ModeSums* mode, double pace,
                   const SloshPrior& prior) noexcept;

}  // namespace slosh
