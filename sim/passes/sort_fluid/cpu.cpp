// Putting fluid particles in order for the next step.
#include <algorithm>

#include "sim/cpu/passes.h"
#include "sim/cpu/state.h"

namespace slosh {

namespace {
constexpr std::size_t kParticlesPerChunk = 2048;
}

void sort_fluid(PassContext& context, ThreadTeam& team, FluidParticles& fluid, KeySorter& sorter,
                GatheredColumns& scratch) {
  sorter.sort(fluid.key.data(), fluid.active, context.grid.retired_key());
  const std::uint32_t* order = sorter.order();
  team.run(fluid.active, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    for_each_column(
        [&](auto column, const auto& from, auto& to) {
          if constexpr (info(column).life == ColumnLife::kCarried) {
            if (to.empty()) return;  // the plan has it not
            for (std::size_t p = begin; p < end; ++p) to[p] = from[order[p]];
          }
        },
        fluid, scratch);
  });
  for_each_column(
      [](auto column, auto& values, auto& gathered) {
        if constexpr (info(column).life == ColumnLife::kCarried) values.swap(gathered);
      },
      fluid, scratch);
  fluid.index.rebuild(context.grid, fluid.key.data(), fluid.active);
  fluid.active = fluid.index.particles();
  // The last row's batch reads on into what was retired, and zero times not-a-number is not zero.
  const auto clear_padding = [&]<class T>(auto, Column<T>& values) {
    if constexpr (std::is_same_v<T, float>) {
      if (!values.empty())
        std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(fluid.active), kLanes, 0.0f);
    }
  };
  for_each_column(clear_padding, fluid);
}

namespace passes {

void sort_fluid_on_cpu(CpuState& s, const PassInputs&) {
  s.carry_probes_in();
  sort_fluid(s.context, s.team, s.fluid, s.memory<KeySorter>(PassId::kSortFluid), s.scratch);
}

}  // namespace passes

}  // namespace slosh
