#include "peer/replica/slosh_record.h"

#include <algorithm>
#include <cmath>

namespace slosh {

void SloshRecord::add_sample(double dt, double acceleration, double velocity, double force,
                             const SloshMode& mode) noexcept {
  open_.dt += dt;
  open_.acceleration += dt * acceleration;
  open_.velocity += dt * velocity;
  open_.force += dt * force;
  if (open_.dt < kBlock - 1e-9) return;
  Block& block = blocks_[count_ % kBlocks];
  if (count_ >= kBlocks && mode.mass > 0.0)
    begin_ = SloshStep(mode.pace, mode.damping, block.dt)(begin_, block.dt * block.acceleration);
  block = {open_.dt, std::exp(-open_.dt / kSloshMemory), open_.acceleration / open_.dt,
           open_.velocity / open_.dt, open_.force / open_.dt};
  open_ = Block{};
  count_ += 1;
}

void SloshRecord::lighten(double share) noexcept {
  for (Block& block : blocks_) block.force *= share;
  open_.force *= share;
}

SloshFit SloshRecord::fit(const SloshMode* mode, const SloshPrior& prior, std::size_t end,
                          SloshSums* given) const noexcept {
  SloshSums sums;
  ModeSums own;
  const SloshMode one = mode ? SloshMode{1.0, mode->pace, mode->damping} : SloshMode{};
  SloshState state = begin_;
  SloshStep step;
  double steps_for = 0.0;
  double before = slosh_force(one, state);
  for (std::size_t i = count_ - std::min(count_, kBlocks); i < end; ++i) {
    const Block& block = blocks_[i % kBlocks];
    const SloshSums::Common x{1.0, -block.acceleration, -block.velocity};
    sums.add(block.dt, block.keep, x, block.force);
    if (!mode) continue;
    if (std::abs(block.dt - steps_for) > 1e-9) {
      steps_for = block.dt;
      step = SloshStep(one.pace, one.damping, block.dt);
    }
    state = step(state, block.dt * block.acceleration);
    const double now = slosh_force(one, state);
    own.add(block.dt, block.keep, 0.5 * (before + now), x, block.force);
    before = now;
  }
  if (given) *given = sums;
  return fit_slosh(sums, mode ? &own : nullptr, one.pace, prior);
}

}  // namespace slosh
