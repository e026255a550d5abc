// Pressure loop: pressure and viscous forces on a group of fluid particles, over the rows of pressure pairs.
#pragma once

#include "sim/passes/pressure_solve/cpu_pairs.h"

namespace slosh {

/// Of up to four particles.
struct GroupForces {
  Sixteen pressed = {};  ///< N, by what others press with and by their stresses
  Sixteen dragged = {};  ///< Σ V shape/r² d (d · (u of others − one's own)), without Eq 9's constants
};

/// `presses`: by the tensors; `artificial`: by `drags`, Pa·m; `drags`: besides by Eq 9 of each one's own
/// viscosity, all by the shape `drag`. Calls also(four, shape, even, odd) for a pair of each: drag's shape/r²
/// (0 where it fills a row up) and the others' tensors. `h`: the support radius, m.
template <bool presses, bool artificial, bool drags, class Also>
GroupForces walk_forces(const FluidPress& press, const PairRows::Walk& walk, float h,
                        const DragShape<float>& drag, Also&& also) {
  const float *const tensors = &press.tensors[0].xx, *const us = &press.drags[0].x;
  const float* const velocities = &press.velocities[0].x;
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
    const Sixteen shape = where_above_zero(slope, at_least_zero(PairRows::Walk::drag_shape(d, h, drag)));
    if constexpr (artificial || drags) {
      Sixteen by = {};
      if constexpr (artificial) by += walk.of_others<4>(us, four) - own_u;
      if constexpr (drags)
        by += (0.5f * (viscosity + fourths(odd))) * (walk.of_others<4>(velocities, four) - own_v);
      // The fourth of d is 0.
      dragged += (shape * fourths(even) * sums(d * by)) * d;
    }
    also(four, shape, even, odd);
  });
  return {straight + turning + turned_back(back), dragged};
}

/// All of that with particle stresses, too.
inline GroupForces walk_passed(const FluidPress& press, const PairRows::Walk& walk, float h,
                               const DragShape<float>& drag) {
  constexpr std::size_t kFloats = sizeof(Passed) / sizeof(float);
  const float *const all = &press.passed[0].straight.x, *const own = all + kFloats * walk.first;
  const float* const velocities = &press.velocities[0].x;
  const Sixteen viscosity = fourths(walk.of_group<kFloats>(own + 4)),
                own_u = walk.of_group<kFloats>(own + 12);
  const Sixteen own_v = walk.of_group<4>(velocities + std::size_t{4} * walk.first);
  GroupForces sum;
  walk.for_each_way(press.places.data(), [&](Sixteen d, const PairRows::Pair* four) {
    const Sixteen slope = each_even_four_times(&four->weight), g = slope * d;
    const auto part = [&](std::size_t from) { return walk.of_others<kFloats>(all + from, four); };
    const Sixteen straight = part(0), turning = part(4);
    sum.pressed += straight * g + turning * turned(g) + part(8) * turned_back(g);
    const Sixteen shape = where_above_zero(slope, at_least_zero(PairRows::Walk::drag_shape(d, h, drag)));
    const Sixteen by =
        part(12) - own_u +
        (0.5f * (viscosity + fourths(turning))) * (walk.of_others<4>(velocities, four) - own_v);
    sum.dragged += (shape * fourths(straight) * sums(d * by)) * d;
  });
  return sum;
}

}  // namespace slosh
