// What a group of fluid particles is pushed and dragged by, over the rows of who presses on whom.
#pragma once

#include "sim/cpu/pressure_rows.h"

namespace slosh {

/// Of up to four particles.
struct GroupForces {
  Sixteen pressed = {};  ///< N, by what others press with and by their stresses
  Sixteen dragged =
      {};  ///< Σ V shape/r² d (d · what others drag by, less one's own), without Eq 9's constants
};

/// `presses`: by the tensors; `stresses`: by the stresses; `jostles`: by `drags`, Pa·m; `drags`: besides by
/// Eq 9 of each one's own viscosity, all as `drag` falls off. Calls also(four, shape, even, odd) for a pair
/// of each: drag's shape/r² (0 where it fills a row up) and the others' tensors. `h`: the support radius, m.
template <bool presses, bool jostles, bool drags, bool stresses, class Also>
GroupForces walk_forces(const FluidPress& press, const PairRows::Walk& walk, float h,
                        const DragShape<float>& drag, Also&& also) {
  const float *const tensors = &press.tensors[0].xx, *const us = &press.drags[0].x;
  const float* const velocities = &press.velocities[0].x;
  const float* const passed = stresses ? &press.stresses[0].straight.x : nullptr;
  const Sixteen own_u = walk.of_group<4>(us + std::size_t{4} * walk.first);
  const Sixteen own_v = walk.of_group<4>(velocities + std::size_t{4} * walk.first);
  const Sixteen viscosity = fourths(walk.of_group<8>(tensors + std::size_t{8} * walk.first + 4));
  Sixteen straight = {}, turning = {}, back = {}, dragged = {};
  walk.for_each_way(press.places.data(), [&](Sixteen d, const PairRows::Pair* four) {
    const Sixteen slope = each_even_four_times(&four->weight);
    const Sixteen even = walk.of_others<8>(tensors, four), odd = walk.of_others<8>(tensors + 4, four);
    if constexpr (presses) {
      const Sixteen g = slope * d;
      straight += even * g;
      turning += odd * turned(g);
      back += odd * g;
    }
    if constexpr (stresses) {
      const Sixteen g = slope * d;
      straight += walk.of_others<16>(passed, four) * g + walk.of_others<16>(passed + 4, four) * turned(g) +
                  walk.of_others<16>(passed + 8, four) * turned_back(g);
    }
    const Sixteen shape = where_above_zero(slope, at_least_zero(PairRows::Walk::drag_shape(d, h, drag)));
    if constexpr (jostles || drags) {
      Sixteen by = {};
      if constexpr (jostles) by += walk.of_others<4>(us, four) - own_u;
      if constexpr (drags)
        by += (0.5f * (viscosity + fourths(odd))) * (walk.of_others<4>(velocities, four) - own_v);
      // The fourth of d is 0.
      dragged += (shape * fourths(even) * sums(d * by)) * d;
    }
    also(four, shape, even, odd);
  });
  return {straight + turning + turned_back(back), dragged};
}

}  // namespace slosh
