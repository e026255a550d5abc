#include "peer/haptics/replica/slosh_finder.h"

#include <numbers>

namespace slosh {
namespace {

constexpr double kSlowest = 0.6, kFastest = 5.0;  // Hz
constexpr std::array<double, 5> kDampingsOfBank{0.01, 0.03, 0.08, 0.16, 0.32};
constexpr double kMemory = 3.0;      // s, the forgetting's time constant
constexpr double kLeastKnown = 0.6;  // of it, s, before anything is followed
constexpr double kLowPass = 0.02;    // s, each of two
constexpr double kSweep = 0.05;      // s in which the whole bank is looked at, a few rows a word
constexpr double kAdopted = 0.1;     // s over which what is found is taken over
// What is expected, against a force that no model explains of this much over this long: N, s.
constexpr double kNoise = 0.5;
constexpr double kNoiseLasts = 0.1;
constexpr double kExpectedDamping = 0.03;
constexpr double kLeastExpected = 1e-3;  // kg
constexpr double kSureOfMass = 0.3;      // of what is expected, one σ
constexpr double kSureOfPace = 0.2;      // the same, of its logarithm
constexpr double kLeastObserved = 0.3;   // kg: of a lighter mode the force says less
constexpr double kObserved = 0.25;       // s over which the state is drawn to what the force says
// Motion that weighs as much as what is taken to be so beforehand: no mass, no drag.
constexpr double kUsualAcceleration = 0.02;  // m/s²
constexpr double kUsualSpeed = 0.01;         // m/s
constexpr double kLeastForce =
    0.05;  // N rms that neither rigid mass nor damper explains: less is not looked at
/// Of what neither rigid mass nor damper explains, the share that a mode explains from which on it is
/// followed, and at which it is wholly.
constexpr double kLeastGain = 0.7, kWholeGain = 0.9;
constexpr double kGainOfExpected = 0.1;  // the same where it is of what is carried in a vessel

}  // namespace

double SloshFinder::pace_of(double i) {
  return 2.0 * std::numbers::pi * kSlowest * std::pow(kFastest / kSlowest, i / (kPaces - 1.0));
}
double SloshFinder::damping_of(double j) {
  const auto low = static_cast<std::size_t>(std::clamp(std::floor(j), 0.0, kDampings - 2.0));
  const double share = j - static_cast<double>(low);
  return kDampingsOfBank[low] * std::pow(kDampingsOfBank[low + 1] / kDampingsOfBank[low], share);
}

void SloshFinder::expect(double rigid, double mass, double pace) noexcept {
  expected_rigid_ = rigid;
  expected_mass_ = mass;
  expected_pace_ = pace;
  if (expects_) return;
  expects_ = true;
  mode_ = {mass, pace, kExpectedDamping};
  rigid_ = rigid;
  share_ = 1.0;
}

void SloshFinder::lighten(double share) noexcept {
  mode_.mass *= share;
  rigid_ *= share;
  drag_ *= share;
  constant_ *= share;
  for (double& answer : common_answer_) answer *= share;
  for (auto& row : bank_)
    for (Candidate& c : row) c.answer *= share;
  force_square_ *= share * share;
  f_.once *= share;
  f_.twice *= share;
}

void SloshFinder::hear(double dt, double before, double now, double force) noexcept {
  const double change = now - before, acceleration = change / dt;
  if (!(dt > 0.0) || !std::isfinite(acceleration) || !std::isfinite(force)) return restart(most_);
  if (!known_) {
    for (std::size_t i = 0; i < kPaces; ++i) paces_[i] = pace_of(static_cast<double>(i));
    f_.once = f_.twice = force;
    v_.once = v_.twice = before;
    known_ = true;
  }
  if (std::abs(dt - bank_step_) > 1e-9) {
    bank_step_ = dt;
    for (std::size_t i = 0; i < kPaces; ++i)
      for (std::size_t j = 0; j < kDampings; ++j) {
        bank_[i][j].step = SloshStep(paces_[i], kDampingsOfBank[j], dt);
        bank_[i][j].pace = paces_[i];
      }
  }
  const double low = 1.0 - std::exp(-dt / kLowPass), keep = std::exp(-dt / kMemory);
  a_.to(acceleration, low);
  v_.to(0.5 * (before + now), low);
  f_.to(force, low);
  const std::array<double, kCommon> x{1.0, -a_.twice, -v_.twice};
  const double f = f_.twice;
  for (std::size_t p = 0; p < kCommon; ++p) {
    for (std::size_t q = 0; q < kCommon; ++q) common_[p][q] = keep * common_[p][q] + dt * x[p] * x[q];
    common_answer_[p] = keep * common_answer_[p] + dt * x[p] * f;
  }
  force_square_ = keep * force_square_ + dt * f * f;
  weight_ = keep * weight_ + dt;
  for (std::size_t i = 0; i < kPaces; ++i) {
    for (std::size_t j = 0; j < kDampings; ++j) {
      Candidate& c = bank_[i][j];
      const SloshMode one{1.0, paces_[i], kDampingsOfBank[j]};
      const SloshState next = c.step(c.state, change);
      c.low.to(0.5 * (slosh_force(one, c.state) + slosh_force(one, next)), low);
      c.state = next;
      const double phi = c.low.twice;
      for (std::size_t p = 0; p < kCommon; ++p) c.with[p] = keep * c.with[p] + dt * phi * x[p];
      c.square = keep * c.square + dt * phi * phi;
      c.answer = keep * c.answer + dt * phi * f;
    }
  }
  // The observer.
  const SloshState was = state_;
  state_ = SloshStep(mode_.pace, mode_.damping, dt)(state_, change);
  if (mode_.mass > 1e-6) {
    const double foreseen = constant_ - rigid_ * acceleration - drag_ * 0.5 * (before + now) +
                            0.5 * (slosh_force(mode_, was) + slosh_force(mode_, state_));
    const double off = (force - foreseen) / (std::max(mode_.mass, kLeastObserved) * mode_.pace * mode_.pace);
    state_.place += std::min(2.0 * dt / kObserved, 0.5) * off;
  }
  look_on(dt);
}

/// A few rows of the bank a word, so that no tick has much to do.
void SloshFinder::look_on(double dt) noexcept {
  swept_ += dt;
  const double rows = std::ceil(static_cast<double>(kPaces) * dt / kSweep);
  for (auto left = static_cast<std::size_t>(std::clamp(rows, 1.0, static_cast<double>(kPaces))); left > 0;
       --left) {
    for (std::size_t j = 0; j < kDampings; ++j) fits_[row_][j] = fit(&bank_[row_][j]);
    row_ += 1;
    if (row_ < kPaces) continue;
    row_ = 0;
    choose(swept_);
    swept_ = 0.0;
  }
}

/// Least squares with what comes out negative left out, the worst first.
SloshFinder::Fit SloshFinder::fit(const Candidate* candidate) const {
  constexpr std::size_t kAll = kCommon + 1;
  double a[kAll][kAll] = {}, b[kAll] = {};
  for (std::size_t p = 0; p < kCommon; ++p) {
    for (std::size_t q = 0; q < kCommon; ++q) a[p][q] = common_[p][q];
    b[p] = common_answer_[p];
    if (candidate) a[p][kCommon] = a[kCommon][p] = candidate->with[p];
  }
  const double window = std::min(weight_, kMemory);
  a[0][0] += 1e-9;
  a[1][1] += window * kUsualAcceleration * kUsualAcceleration;
  a[2][2] += window * kUsualSpeed * kUsualSpeed;
  bool out[kAll] = {false, false, false, candidate == nullptr};
  if (candidate) {
    a[kCommon][kCommon] = candidate->square + window * kUsualAcceleration * kUsualAcceleration;
    b[kCommon] = candidate->answer;
  }
  double base = 0.0;
  if (expects_) {
    const double sure = kSureOfMass * (expected_rigid_ + expected_mass_),
                 weight = kNoise * kNoise * kNoiseLasts / (sure * sure);
    a[1][1] += weight;
    b[1] += weight * expected_rigid_;
    base += weight * expected_rigid_ * expected_rigid_;
    if (candidate) {
      a[kCommon][kCommon] += weight;
      b[kCommon] += weight * expected_mass_;
      base += weight * expected_mass_ * expected_mass_;
      const double off = std::log(candidate->pace / expected_pace_) / kSureOfPace;
      base += kNoise * kNoise * kNoiseLasts * off * off;
    }
  }
  Fit best;
  while (true) {
    // Gauss without pivots: positive definite.
    double m[kAll][kAll + 1];
    for (std::size_t p = 0; p < kAll; ++p) {
      for (std::size_t q = 0; q < kAll; ++q) m[p][q] = out[p] || out[q] ? (p == q ? 1.0 : 0.0) : a[p][q];
      m[p][kAll] = out[p] ? 0.0 : b[p];
    }
    for (std::size_t p = 0; p < kAll; ++p)
      for (std::size_t r = p + 1; r < kAll; ++r) {
        const double factor = m[r][p] / m[p][p];
        for (std::size_t q = p; q <= kAll; ++q) m[r][q] -= factor * m[p][q];
      }
    for (std::size_t p = kAll; p-- > 0;) {
      best.x[p] = m[p][kAll];
      for (std::size_t q = p + 1; q < kAll; ++q) best.x[p] -= m[p][q] * best.x[q];
      best.x[p] /= m[p][p];
    }
    std::size_t worst = 0;
    for (std::size_t p = 1; p < kAll; ++p)
      if (best.x[p] < -1e-9 && (worst == 0 || best.x[p] < best.x[worst])) worst = p;
    if (worst == 0) break;
    out[worst] = true;
  }
  best.rest = force_square_ + base;
  for (std::size_t p = 0; p < kAll; ++p) best.rest -= best.x[p] * b[p];
  return best;
}

void SloshFinder::choose(double seconds) noexcept {
  const double take = 1.0 - std::exp(-seconds / kAdopted);
  std::size_t bi = 0, bj = 0;
  for (std::size_t i = 0; i < kPaces; ++i)
    for (std::size_t j = 0; j < kDampings; ++j)
      if (fits_[i][j].rest < fits_[bi][bj].rest) bi = i, bj = j;
  Fit found = fits_[bi][bj];
  const Fit without = fit(nullptr);
  const double rigid = std::max(without.rest, 0.0);
  // Nothing swings, or too little is known yet: what was found holds on.
  if ((weight_ < kLeastKnown && !expects_) || rigid < kLeastForce * kLeastForce * weight_) return;
  double pace = pace_of(static_cast<double>(bi)), damping = kDampingsOfBank[bj];
  // At an end of the bank it is something else that is so slow or so quick; in a vessel nothing swings up and
  // down.
  const bool swings = !(expects_ && expected_mass_ < kLeastExpected) && bi > 0 && bi + 1 < kPaces &&
                      found.x[3] > 0.0 && found.x[3] < most_ &&
                      found.rest < (1.0 - (expects_ ? kGainOfExpected : kLeastGain)) * rigid;
  if (swings) {
    // Between neighbours, by the parabola through three.
    const auto between = [](double low, double at, double high) {
      const double bend = low - 2.0 * at + high;
      return bend > 0.0 ? std::clamp(0.5 * (low - high) / bend, -0.5, 0.5) : 0.0;
    };
    const double di = between(fits_[bi - 1][bj].rest, found.rest, fits_[bi + 1][bj].rest);
    double dj = 0.0;
    if (bj > 0 && bj + 1 < kDampings)
      dj = between(fits_[bi][bj - 1].rest, found.rest, fits_[bi][bj + 1].rest);
    const Fit& next = fits_[di > 0.0 ? bi + 1 : bi - 1][bj];
    for (std::size_t p = 0; p < found.x.size(); ++p) found.x[p] += std::abs(di) * (next.x[p] - found.x[p]);
    pace = pace_of(static_cast<double>(bi) + di);
    damping = damping_of(static_cast<double>(bj) + dj);
  } else {
    found = without;
  }
  const double gain = swings ? 1.0 - std::max(found.rest, 0.0) / rigid : 0.0;
  const double trust = expects_ ? 1.0 : std::clamp((gain - kLeastGain) / (kWholeGain - kLeastGain), 0.0, 1.0);
  const bool first = swings && !(mode_.mass > 0.0);
  if (first) {
    mode_ = {0.0, pace, damping};
    state_ = bank_[bi][bj].state;
  }
  if (swings) {
    mode_.pace *= std::pow(pace / mode_.pace, take);
    mode_.damping *= std::pow(damping / mode_.damping, take);
  }
  mode_.mass += take * ((swings ? found.x[3] : 0.0) - mode_.mass);
  constant_ += take * (found.x[0] - constant_);
  rigid_ += take * (found.x[1] - rigid_);
  drag_ += take * (found.x[2] - drag_);
  share_ += take * (trust - share_);
}

}  // namespace slosh
