#include "peer/replica/slosh_fit.h"

#include <algorithm>
#include <cmath>

namespace slosh {
namespace {

// What is expected of a vessel, against a force that no model explains of this much over this long: N, s.
constexpr double kNoise = 0.5;
constexpr double kNoiseLasts = 0.1;
constexpr double kSureOfMass = 0.3;  // of what is expected, one σ
constexpr double kSureOfPace = 0.2;  // the same, of its logarithm
// Motion that weighs as much as what is taken to be so beforehand: no mass, no drag …
constexpr double kUsualAcceleration = 0.02;  // m/s²
constexpr double kUsualSpeed = 0.01;         // m/s
// … where this much and more is not explained, N; and its square's least share, where nearly all is.
constexpr double kUsuallyUnexplained = 0.02;
constexpr double kMinUncertainty = 1e-5;
// What the host's line says, by the same: N²·s a square of its own size.
constexpr double kTold = 0.1;

constexpr std::size_t kAll = SloshSums::kCommon + 1;
constexpr std::size_t kRigid = 1, kDrag = 2, kMass = 3;

struct Normal {
  double a[kAll][kAll] = {}, b[kAll] = {};
  double square = 0.0;  // of what is answered to

  /// Σ of x over `of` is taken to be `value`.
  void expect(std::initializer_list<std::size_t> of, double value, double weight) {
    for (const std::size_t p : of) {
      for (const std::size_t q : of) a[p][q] += weight;
      b[p] += weight * value;
    }
    square += weight * value * value;
  }
};

/// Gauss without pivots: positive definite. What is `out` is 0.
void solve(const Normal& n, const bool (&out)[kAll], double (&x)[kAll]) {
  double m[kAll][kAll + 1];
  for (std::size_t p = 0; p < kAll; ++p) {
    for (std::size_t q = 0; q < kAll; ++q) m[p][q] = out[p] || out[q] ? (p == q ? 1.0 : 0.0) : n.a[p][q];
    m[p][kAll] = out[p] ? 0.0 : n.b[p];
  }
  for (std::size_t p = 0; p < kAll; ++p)
    for (std::size_t r = p + 1; r < kAll; ++r) {
      const double factor = m[r][p] / m[p][p];
      for (std::size_t q = p; q <= kAll; ++q) m[r][q] -= factor * m[p][q];
    }
  for (std::size_t p = kAll; p-- > 0;) {
    x[p] = m[p][kAll];
    for (std::size_t q = p + 1; q < kAll; ++q) x[p] -= m[p][q] * x[q];
    x[p] /= m[p][p];
  }
}

void take_as_so(Normal& n, const SloshPrior& prior, bool mode, double pace, double window) {
  const double doubt =
      prior.vessel
          ? 1.0
          : std::clamp(prior.unexplained / (kUsuallyUnexplained * kUsuallyUnexplained), kMinUncertainty, 1.0);
  const double no_mass = doubt * window * kUsualAcceleration * kUsualAcceleration;
  n.expect({kRigid}, 0.0, no_mass);
  n.expect({kDrag}, 0.0, doubt * window * kUsualSpeed * kUsualSpeed);
  if (mode) n.expect({kMass}, 0.0, no_mass);
  if (!prior.vessel) {
    if (prior.told_drag > 0.0)
      n.expect({kDrag}, prior.told_drag, doubt * kTold / (prior.told_drag * prior.told_drag));
    if (prior.told_mass > 0.0) {
      const double weight = doubt * kTold / (prior.told_mass * prior.told_mass);
      if (mode)
        n.expect({kRigid, kMass}, prior.told_mass, weight);
      else
        n.expect({kRigid}, prior.told_mass, weight);
    }
    return;
  }
  const double sure = kSureOfMass * (prior.rigid + prior.mass), noise = kNoise * kNoise * kNoiseLasts;
  n.expect({kRigid}, prior.rigid, noise / (sure * sure));
  if (!mode) return;
  n.expect({kMass}, prior.mass, noise / (sure * sure));
  const double off = std::log(pace / prior.pace) / kSureOfPace;
  n.square += noise * off * off;
}

}  // namespace

/// Least squares with what comes out negative left out, the worst first.
SloshFit fit_slosh(const SloshSums& sums, const ModeSums* mode, double pace,
                   const SloshPrior& prior) noexcept {
  Normal n;
  for (std::size_t p = 0; p < SloshSums::kCommon; ++p) {
    for (std::size_t q = 0; q < SloshSums::kCommon; ++q) n.a[p][q] = sums.common[p][q];
    n.b[p] = sums.answer[p];
    if (mode) n.a[p][kMass] = n.a[kMass][p] = mode->with[p];
  }
  if (mode) {
    n.a[kMass][kMass] = mode->square;
    n.b[kMass] = mode->answer;
  }
  const Normal told = n;  // without what is taken to be so
  n.a[0][0] += 1e-9;
  n.square = sums.force_square;
  take_as_so(n, prior, mode != nullptr, pace, std::min(sums.weight, kSloshMemory));
  bool out[kAll] = {false, false, false, mode == nullptr};
  double x[kAll];
  while (true) {
    solve(n, out, x);
    std::size_t worst = 0;
    for (std::size_t p = 1; p < kAll; ++p)
      if (x[p] < -1e-9 && (worst == 0 || x[p] < x[worst])) worst = p;
    if (worst == 0) break;
    out[worst] = true;
  }
  SloshFit fit{x[0], x[kRigid], x[kDrag], x[kMass], n.square, sums.force_square};
  for (std::size_t p = 0; p < kAll; ++p) {
    fit.rest -= x[p] * n.b[p];
    fit.unexplained -= 2.0 * x[p] * told.b[p];
    for (std::size_t q = 0; q < kAll; ++q) fit.unexplained += x[p] * told.a[p][q] * x[q];
  }
  return fit;
}

}  // namespace slosh
