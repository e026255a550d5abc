#include "peer/replica/slosh_finder.h"

#include <numbers>

namespace slosh {
namespace {

constexpr double kSlowest = 0.6, kFastest = 5.0;  // Hz
constexpr std::array<double, 5> kDampingsOfBank{0.01, 0.03, 0.08, 0.16, 0.32};
constexpr double kMinKnown = 0.6;  // of the memory, s, before anything is followed
constexpr double kLowPass = 0.02;  // s, each of two
constexpr double kSweep = 0.05;    // s in which the whole bank is looked at, a few rows an update
constexpr double kTry = 0.0005;    // s a try of the search, a few an update
constexpr std::size_t kMaxTries = 5;
constexpr double kAdopted = 0.1;       // s over which what is found is taken over …
constexpr double kSoonAdopted = 0.02;  // … and where it explains nearly all
constexpr double kExpectedDamping = 0.03;
constexpr double kMinExpected = 1e-3;  // kg
constexpr double kMinObserved = 0.3;   // kg: of a lighter mode the force says less
constexpr double kObserved = 0.25;     // s over which the state is drawn to what the force says
/// N rms that neither rigid mass nor damper explains: less is not looked at, or, where nothing is expected,
/// followed only where a mode explains all but little of it: a spoon's fluid leaves as much as that, and is
/// none.
constexpr double kFaint = 0.05, kFaintGain = 0.97;
constexpr double kMinForce = 1e-3;  // the same below which nothing is
/// Of what neither rigid mass nor damper explains, the share that a mode explains from which on it is
/// followed, at which it is wholly, and from which on it is nearly all.
constexpr double kMinGain = 0.7, kWholeGain = 0.9, kNearlyAll = 0.99;
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

void SloshFinder::restart(double most) noexcept {
  *this = SloshFinder{};
  most_ = most;
  for (std::size_t i = 0; i < kPaces; ++i) paces_[i] = pace_of(static_cast<double>(i));
  search_.restart(paces_.front(), paces_.back());
}

void SloshFinder::expect(double rigid, double mass, double pace) noexcept {
  const bool before = prior_.vessel;
  prior_.vessel = true;
  prior_.rigid = rigid;
  prior_.mass = mass;
  prior_.pace = pace;
  if (before) return;
  mode_ = {mass, pace, kExpectedDamping};
  rigid_ = rigid;
  share_ = 1.0;
}

void SloshFinder::lighten(double share) noexcept {
  mode_.mass *= share;
  rigid_ *= share;
  drag_ *= share;
  constant_ *= share;
  sums_.lighten(share);
  for (auto& row : bank_)
    for (Candidate& c : row) c.sums.answer *= share;
  record_.lighten(share);
  f_.once *= share;
  f_.twice *= share;
}

void SloshFinder::add_sample(double dt, double before, double now, double force) noexcept {
  const double change = now - before, acceleration = change / dt;
  if (!(dt > 0.0) || !std::isfinite(acceleration) || !std::isfinite(force)) return restart(most_);
  if (!known_) {
    f_.once = f_.twice = force;
    v_.once = v_.twice = before;
    known_ = true;
  }
  if (std::abs(dt - bank_step_) > 1e-9) {
    bank_step_ = dt;
    for (std::size_t i = 0; i < kPaces; ++i)
      for (std::size_t j = 0; j < kDampings; ++j)
        bank_[i][j].step = SloshStep(paces_[i], kDampingsOfBank[j], dt);
  }
  const double low = 1.0 - std::exp(-dt / kLowPass), keep = std::exp(-dt / kSloshMemory);
  a_.to(acceleration, low);
  v_.to(0.5 * (before + now), low);
  f_.to(force, low);
  const SloshSums::Common x{1.0, -a_.twice, -v_.twice};
  sums_.add(dt, keep, x, f_.twice);
  if (!prior_.vessel) record_.add_sample(dt, a_.twice, v_.twice, f_.twice, search_.mode());
  for (std::size_t i = 0; i < kPaces; ++i) {
    for (std::size_t j = 0; j < kDampings; ++j) {
      Candidate& c = bank_[i][j];
      const SloshMode one{1.0, paces_[i], kDampingsOfBank[j]};
      const SloshState next = c.step(c.state, change);
      c.low.to(0.5 * (slosh_force(one, c.state) + slosh_force(one, next)), low);
      c.state = next;
      c.sums.add(dt, keep, c.low.twice, x, f_.twice);
    }
  }
  observe(dt, before, now, force);
  look_on(dt);
}

void SloshFinder::observe(double dt, double before, double now, double force) noexcept {
  const double change = now - before;
  const SloshState was = state_;
  state_ = SloshStep(mode_.pace, mode_.damping, dt)(state_, change);
  if (!(mode_.mass > 1e-6)) return;
  const double foreseen = constant_ - rigid_ * change / dt - drag_ * 0.5 * (before + now) +
                          0.5 * (slosh_force(mode_, was) + slosh_force(mode_, state_));
  const double off = (force - foreseen) / (std::max(mode_.mass, kMinObserved) * mode_.pace * mode_.pace);
  state_.place += std::min(2.0 * dt / kObserved, 0.5) * off;
}

/// A few rows of the bank and a few tries of the search an update, so that no tick has much to do.
void SloshFinder::look_on(double dt) noexcept {
  prior_.unexplained = search_.unexplained();
  const auto of = [](double each, std::size_t most) {
    return static_cast<std::size_t>(std::clamp(std::ceil(each), 1.0, static_cast<double>(most)));
  };
  if (!prior_.vessel)
    for (std::size_t left = of(dt / kTry, kMaxTries); left > 0; --left) search_.look_on(record_, prior_);
  swept_ += dt;
  for (std::size_t left = of(static_cast<double>(kPaces) * dt / kSweep, kPaces); left > 0; --left) {
    for (std::size_t j = 0; j < kDampings; ++j)
      fits_[row_][j] = fit_slosh(sums_, &bank_[row_][j].sums, paces_[row_], prior_);
    row_ += 1;
    if (row_ < kPaces) continue;
    row_ = 0;
    choose(swept_);
    swept_ = 0.0;
  }
}

SloshFinder::Cell SloshFinder::best_cell() const noexcept {
  Cell best;
  for (std::size_t i = 0; i < kPaces; ++i)
    for (std::size_t j = 0; j < kDampings; ++j)
      if (fits_[i][j].rest < fits_[best.pace][best.damping].rest) best = {i, j};
  return best;
}

/// By the parabola through three.
SloshFinder::Found SloshFinder::between_neighbours(Cell best) const noexcept {
  const auto [bi, bj] = best;
  Found found{{0.0, paces_[bi], kDampingsOfBank[bj]}, fits_[bi][bj], fit_slosh(sums_, nullptr, 0.0, prior_)};
  found.at_an_end = bi == 0 || bi + 1 == kPaces;
  if (found.at_an_end) return found;
  const auto between = [](double low, double at, double high) {
    const double bend = low - 2.0 * at + high;
    return bend > 0.0 ? std::clamp(0.5 * (low - high) / bend, -0.5, 0.5) : 0.0;
  };
  const double di = between(fits_[bi - 1][bj].rest, found.with.rest, fits_[bi + 1][bj].rest);
  double dj = 0.0;
  if (bj > 0 && bj + 1 < kDampings)
    dj = between(fits_[bi][bj - 1].rest, found.with.rest, fits_[bi][bj + 1].rest);
  const SloshFit& next = fits_[di > 0.0 ? bi + 1 : bi - 1][bj];
  const auto to = [&](double SloshFit::* field) {
    found.with.*field += std::abs(di) * (next.*field - found.with.*field);
  };
  to(&SloshFit::constant);
  to(&SloshFit::rigid);
  to(&SloshFit::drag);
  to(&SloshFit::mass);
  found.mode.pace = pace_of(static_cast<double>(bi) + di);
  found.mode.damping = damping_of(static_cast<double>(bj) + dj);
  return found;
}

void SloshFinder::choose(double seconds) noexcept {
  // Too little is known yet, or nothing swings: what was found holds on.
  if (sums_.weight < kMinKnown && !prior_.vessel) return;
  const double least = prior_.vessel ? kFaint : kMinForce;
  if (fit_slosh(sums_, nullptr, 0.0, prior_).rest < least * least * sums_.weight) return;
  const Cell best = best_cell();
  // Real water is no mode to the last digit: by a search its force, smooth and 50 to 400 ms late, was off by
  // 6.3, 9.1, 8.6, 9.7 % for 6.0, 8.6, 8.1, 9.3, and breaking by 60, 47, 62 for 58, 45, 60.
  if (prior_.vessel) return adopt(between_neighbours(best), best, seconds);
  search_.propose(paces_[best.pace], kDampingsOfBank[best.damping], record_, prior_);
  if (search_.found())
    adopt({search_.mode(), search_.fit(), search_.without(), search_.at_an_end()}, best, seconds);
}

void SloshFinder::adopt(const Found& f, Cell best, double seconds) noexcept {
  const double rigid = std::max(f.without.rest, 0.0);
  // In a vessel nothing swings up and down.
  const bool swings = !(prior_.vessel && prior_.mass < kMinExpected) && !f.at_an_end && f.with.mass > 0.0 &&
                      f.with.mass < most_ &&
                      f.with.rest < (1.0 - (prior_.vessel ? kGainOfExpected : kMinGain)) * rigid;
  const SloshFit& found = swings ? f.with : f.without;
  const double gain = swings ? 1.0 - std::max(f.with.rest, 0.0) / rigid : 0.0;
  if (!prior_.vessel && gain < kFaintGain && rigid < kFaint * kFaint * sums_.weight) return;
  const double trust =
      prior_.vessel ? 1.0 : std::clamp((gain - kMinGain) / (kWholeGain - kMinGain), 0.0, 1.0);
  const double sure =
      prior_.vessel ? 0.0 : std::clamp((gain - kWholeGain) / (kNearlyAll - kWholeGain), 0.0, 1.0);
  const double take = 1.0 - std::exp(-seconds / (kAdopted + sure * (kSoonAdopted - kAdopted)));
  if (swings && !(mode_.mass > 0.0)) {
    mode_ = {0.0, f.mode.pace, f.mode.damping};
    state_ = bank_[best.pace][best.damping].state;
  }
  if (swings) {
    mode_.pace *= std::pow(f.mode.pace / mode_.pace, take);
    mode_.damping *= std::pow(f.mode.damping / mode_.damping, take);
  }
  mode_.mass += take * ((swings ? f.with.mass : 0.0) - mode_.mass);
  constant_ += take * (found.constant - constant_);
  rigid_ += take * (found.rigid - rigid_);
  drag_ += take * (found.drag - drag_);
  share_ += take * (trust - share_);
}

}  // namespace slosh
