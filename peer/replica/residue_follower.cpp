#include "peer/replica/residue_follower.h"

#include <algorithm>
#include <cmath>

namespace slosh {
namespace {

constexpr std::array<double, 4> kLags{1.0, 0.3, 0.1, 0.03};  // s, of low-passes
constexpr double kGoes = 0.1;              // s, of each of two by which is known how it goes
constexpr double kResidueCarriedOn = 0.2;  // s for which it goes on so at most
constexpr double kMemory = 0.7;            // s of what was foreseen and told
constexpr double kUsual = 0.1;             // N: a step that was smaller says nothing
constexpr int kSweeps = 3;

double taken(double elapsed, double lag) {
  return 1.0 - std::exp(-elapsed / lag);
}

}  // namespace

void ResidueFollower::begin(double told) noexcept {
  low_.fill(told);
  going_ = gone_ = told;
  answer_.fill(0.0);
  shares_.fill(0.0);
  both_.fill(answer_);
  time_ = 0.0;
  count_ = 0;
  known_ = true;
}

/// What was foreseen for now, against what is told now.
void ResidueFollower::learn(double elapsed, double told, double horizon) noexcept {
  const auto said = [this](std::size_t back) -> const Said& {
    return said_[(newest_ + kRemembered - back) % kRemembered];
  };
  std::size_t low = 0, high = count_;  // said(low) is not younger than a horizon
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    if (said(middle).time > time_ - horizon + 1e-9)
      low = middle + 1;
    else
      high = middle;
  }
  if (low < count_) {
    const Said& then = said(low);
    const double take = taken(elapsed, kMemory);
    for (std::size_t i = 0; i < kSteps; ++i) {
      answer_[i] += take * (then.steps[i] * (told - then.lasting) - answer_[i]);
      for (std::size_t j = 0; j < kSteps; ++j)
        both_[i][j] += take * (then.steps[i] * then.steps[j] - both_[i][j]);
    }
  }
  // Each in turn as the others leave it: within 0 and 1 it has one answer, and the last update's is near.
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t i = 0; i < kSteps; ++i) {
      double left = answer_[i];
      for (std::size_t j = 0; j < kSteps; ++j) left -= j == i ? 0.0 : shares_[j] * both_[i][j];
      shares_[i] = std::clamp(left / (both_[i][i] + kUsual * kUsual), 0.0, 1.0);
    }
}

void ResidueFollower::update(double elapsed, double told, double horizon, double most) noexcept {
  if (!(elapsed > 0.0) || !std::isfinite(told) || !std::isfinite(horizon)) return restart();
  if (!known_) begin(told);
  time_ += elapsed;
  learn(elapsed, told, horizon);
  const double quickest = quickest_followed(horizon);
  for (std::size_t i = 0; i < kLows; ++i)
    low_[i] += taken(elapsed, std::max(kLags[i], quickest)) * (told - low_[i]);
  const double goes = std::max(kGoes, quickest);
  going_ += taken(elapsed, goes) * (told - going_);
  gone_ += taken(elapsed, goes) * (going_ - gone_);
  Said now{time_, low_[0], {}};
  for (std::size_t i = 0; i + 1 < kLows; ++i) now.steps[i] = low_[i + 1] - low_[i];
  now.steps[kLows - 1] =
      std::clamp(std::min(horizon, kResidueCarriedOn) * (going_ - gone_) / goes, -most, most);
  foreseen_ = now.lasting;
  for (std::size_t i = 0; i < kSteps; ++i) foreseen_ += shares_[i] * now.steps[i];
  newest_ = (newest_ + 1) % kRemembered;
  count_ = std::min(count_ + 1, kRemembered);
  said_[newest_] = now;
}

}  // namespace slosh
