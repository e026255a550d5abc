#include "peer/replica/slosh_search.h"

#include <algorithm>
#include <cmath>

namespace slosh {
namespace {

// Of the logarithms of pace and damping.
constexpr double kPaceStep = 0.07, kMinPaceStep = 0.001;
constexpr double kDampingStep = 0.5, kMinDampingStep = 0.01;
constexpr double kGrows = 2.0, kShrinks = 0.5;

}  // namespace

void SloshSearch::restart(double slowest, double fastest) noexcept {
  *this = SloshSearch{};
  slowest_ = slowest;
  fastest_ = fastest;
}

void SloshSearch::propose(double pace, double damping, const SloshRecord& record,
                          const SloshPrior& prior) noexcept {
  const SloshMode there{1.0, pace, damping};
  if (mode_.mass > 0.0) {
    const std::size_t end = record.count();
    if (!(record.fit(&there, prior, end).rest < record.fit(&mode_, prior, end).rest)) return;
  }
  mode_ = there;
  pace_step_ = kPaceStep;
  damping_step_ = kDampingStep;
  gone_pace_ = gone_damping_ = 1.0;
  tried_ = 0;
}

SloshMode SloshSearch::neighbour(std::size_t which) const noexcept {
  double pace = 1.0, damping = 1.0;  // times what it is
  if (which == 0) {
    pace = gone_pace_ * gone_pace_;
    damping = gone_damping_ * gone_damping_;
  } else if (which < 3) {
    pace = std::exp(which == 1 ? pace_step_ : -pace_step_);
  } else {
    damping = std::exp(which == 3 ? damping_step_ : -damping_step_);
  }
  return {1.0, std::clamp(mode_.pace * pace, slowest_, fastest_),
          std::clamp(mode_.damping * damping, kMinDamping, kMaxDamping)};
}

void SloshSearch::look_on(const SloshRecord& record, const SloshPrior& prior) noexcept {
  if (!(mode_.mass > 0.0)) return;
  if (tried_ == 0) {
    // All of a round is of the same blocks, or what is tried later would seem to leave more.
    end_ = record.count();
    SloshSums sums;
    best_ = mode_;
    best_fit_ = record.fit(&mode_, prior, end_, &sums);
    looked_without_ = fit_slosh(sums, nullptr, 0.0, prior);
    weight_ = sums.weight;
    tried_ = 1;
    return;
  }
  const SloshMode there = neighbour(tried_ - 1);
  const SloshFit fit = record.fit(&there, prior, end_);
  if (fit.rest < best_fit_.rest) {
    best_ = there;
    best_fit_ = fit;
  }
  if (++tried_ > kNeighbours) end_round();
}

void SloshSearch::end_round() noexcept {
  tried_ = 0;
  rounds_ += 1;
  const bool stays = best_.pace == mode_.pace && best_.damping == mode_.damping;
  const double by = stays ? kShrinks : kGrows;
  pace_step_ = std::clamp(pace_step_ * by, kMinPaceStep, kPaceStep);
  damping_step_ = std::clamp(damping_step_ * by, kMinDampingStep, kDampingStep);
  gone_pace_ = best_.pace / mode_.pace;
  gone_damping_ = best_.damping / mode_.damping;
  mode_ = best_;
  fit_ = best_fit_;
  without_ = looked_without_;
  unexplained_ = weight_ > 0.0 ? std::max(fit_.unexplained, 0.0) / weight_ : 1.0;
}

bool SloshSearch::at_an_end() const noexcept {
  return mode_.pace < slowest_ * (1.0 + kPaceStep) || mode_.pace > fastest_ / (1.0 + kPaceStep);
}

}  // namespace slosh
