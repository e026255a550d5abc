#include "sim/cuda/host_particles.h"

#include <cmath>
#include <vector>

namespace slosh::cuda {

std::uint64_t broken(const HostPacks& packs, const CellGrid& grid) {
  std::uint64_t count = 0;
  for (std::size_t p = 0; p < packs.id.size(); ++p) {
    const float4 x = packs.x[p];
    const bool finite = std::isfinite(x.x) && std::isfinite(x.y) && std::isfinite(x.z);
    count += packs.key[p] >= grid.retired_key() && !finite;
  }
  return count;
}

void to_state(const HostPacks& packs, const CellGrid& grid, const CellGrid& world, ParticleState& out) {
  out.resize(packs.id.size());
  std::size_t count = 0;
  for_each_present(packs, grid, [&](std::size_t p) {
    for_each_value(packs, p, [&](auto column, const auto& value) {
      if constexpr (info(column).saved) column_of<column>(out)[count] = value;
    });
    out.key[count] = world.cell_of(packs.x[p].x, packs.x[p].y, packs.x[p].z);
    ++count;
  });
  out.resize(count);
}

HostPacks from_state(const ParticleState& state, const CellGrid& world, const CellGrid& grid,
                     float rest_volume, const std::vector<std::uint8_t>& kinds_by_id) {
  const std::size_t total = kinds_by_id.size();
  HostPacks packs;
  for_each_pack([total](auto, auto& values) { values.resize(total); }, packs);
  std::vector<bool> seen(total, false);
  for (std::size_t p = 0; p < state.size(); ++p) {
    for_each_value(packs, p, [&](auto column, auto& value) {
      if constexpr (info(column).saved) value = column_of<column>(state)[p];  // zeros where a plan has it not
    });
    const float4 x = packs.x[p];
    packs.key[p] = state.key[p] >= world.retired_key() ? grid.retired_key() : grid.cell_of(x.x, x.y, x.z);
    seen[state.id[p]] = true;
  }
  std::size_t behind = state.size();
  for (std::uint32_t id = 0; id < total; ++id) {
    if (seen[id]) continue;
    packs.id[behind] = id;
    packs.key[behind] = grid.retired_key();
    packs.v[behind++].w = rest_volume;
  }
  for (std::size_t p = 0; p < total; ++p) packs.kind[p] = kinds_by_id[packs.id[p]];
  return packs;
}

}  // namespace slosh::cuda
