#include "sim/steadiness.h"

#include <algorithm>

namespace slosh {

void Steadiness::feel(const std::vector<GripState>& grips, double seconds) {
  now_.resize(grips.size());
  for (std::size_t g = 0; g < grips.size(); ++g) {
    const glm::dvec3& force = grips[g].on_hand.force;
    now_[g].sum += force;
    now_[g].low = glm::min(now_[g].low, force);
    now_[g].high = glm::max(now_[g].high, force);
  }
  ++samples_;
  felt_ += seconds;
  if (felt_ < kWindow) return;
  steady_ = before_.size() == now_.size();
  before_.resize(now_.size());
  for (std::size_t g = 0; g < now_.size(); ++g) {
    const glm::dvec3 mean = now_[g].sum / static_cast<double>(samples_);
    const double apart =
        std::max(glm::length(mean - before_[g]), 0.5 * glm::length(now_[g].high - now_[g].low));
    steady_ = steady_ && apart <= std::max(kShare * glm::length(mean), kMin);
    before_[g] = mean;
  }
  now_.assign(now_.size(), Window{});
  felt_ = 0.0;
  samples_ = 0;
}

}  // namespace slosh
