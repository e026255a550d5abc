// The fluid's packs on the host: what a saved world, a fingerprint and the sums over a fluid are read from.
#pragma once

#include <type_traits>

#include "sim/columns.h"
#include "sim/cuda/kernels.h"

namespace slosh::cuda {

using HostPacks = MovingPacks<PlainColumn>;

/// One column's part of a pack.
template <class T>
auto& lane(T& pack, int index) {
  if constexpr (std::is_same_v<std::remove_const_t<T>, float4>) {
    return (&pack.x)[index];
  } else {
    return pack;
  }
}

/// Calls f(column, value) for each column of one particle that outlives a step.
template <class Packs, class F>
void for_each_value(Packs& packs, std::size_t p, F&& f) {
  for_each_column([&](auto column) {
    constexpr ColumnInfo kInfo = info(decltype(column)::value);
    for_each_pack(
        [&](auto pack, auto& values) {
          if constexpr (decltype(pack)::value == kInfo.pack) f(column, lane(values[p], kInfo.lane));
        },
        packs);
  });
}

/// Calls f(p) for the particles that are still in the world.
template <class F>
void for_each_present(const HostPacks& packs, const CellGrid& grid, F&& f) {
  for (std::size_t p = 0; p < packs.id.size(); ++p) {
    if (packs.key[p] < grid.retired_key()) f(p);
  }
}

/// Of those that are not, how many stopped where nothing is finite. Where a particle left is kept with it.
std::uint64_t broken(const HostPacks& packs, const CellGrid& grid);

/// The columns that a saved world holds, of the particles that are still in it. Their cells are those of
/// `grid` on the GPU, of `world` in `out`.
void to_state(const HostPacks& packs, const CellGrid& grid, const CellGrid& world, ParticleState& out);
/// The reverse: those that `state` lacks come last, retired, at `rest_volume`. `kinds_by_id` has one entry a
/// particle, in the world or not.
HostPacks from_state(const ParticleState& state, const CellGrid& world, const CellGrid& grid,
                     float rest_volume, const std::vector<std::uint8_t>& kinds_by_id);

}  // namespace slosh::cuda
