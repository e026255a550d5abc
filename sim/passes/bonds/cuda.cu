// Bonds on the GPU: sim/passes/bonds/cpu.cpp.
#include "sim/cuda/rows.cuh"
#include "sim/passes/bonds/cuda.h"

namespace slosh::cuda {
namespace {

constexpr std::uint32_t kNowhere = 0xffffffffu;

// m, the same bitwise from either end.
__device__ inline float distance(const float4& a, const float4& b) {
  const float dx = a.x - b.x, dy = a.y - b.y, dz = a.z - b.z;
  return sqrtf(dx * dx + dy * dy + dz * dz);
}

__device__ inline bool is_present(const StepConstants& c, const SortedFluid& fluid, std::uint32_t p) {
  return p < fluid.count && fluid.state.key[p] < c.grid.retired_key();
}

__global__ void slots_kernel(StepConstants c, SortedFluid fluid, BondView bonds) {
  wait_for_last_kernel();
  const std::uint32_t p = thread_index();
  if (p < fluid.count) bonds.slot_of[fluid.state.id[p]] = is_present(c, fluid, p) ? p : kNowhere;
}

__global__ void look_kernel(StepConstants c, SortedFluid fluid, BondView bonds) {
  wait_for_last_kernel();
  const std::uint32_t p = thread_index();
  if (!is_present(c, fluid, p)) return;
  const std::uint32_t id = fluid.state.id[p];
  const bool did = bonds.set[id], does = counts_as_set(fluid.state.heat[p].y, did);
  bonds.is_new[id] = does && !did;
  bonds.set[id] = does;
}

__global__ __launch_bounds__(kThreads) void bind_kernel(StepConstants c, const HeatKind* kinds, float reach,
                                                        SortedFluid fluid, BondView bonds) {
  wait_for_last_kernel();
  const std::uint32_t p = thread_index();
  if (!is_present(c, fluid, p)) return;
  const std::uint32_t id = fluid.state.id[p];
  const auto stiffness = [&](std::uint32_t q) { return kinds[fluid.state.kind[q]].bond; };
  if (!bonds.set[id] || !(stiffness(p) > 0.0f)) return;
  const bool is_new = bonds.is_new[id];
  const float4 x = fluid.state.x[p];
  Bond* const row = bonds.bonds + std::size_t{id} * kMaxBonds;
  std::uint8_t count = bonds.count[id];
  for_neighbors(c.grid, fluid.cells, fluid.state.key[p], [&](std::uint32_t q) {
    const float apart = distance(x, __ldg(fluid.state.x + q));
    if (q == p || !(apart < reach) || !(apart > 0.0f) || count == kMaxBonds) return;
    const std::uint32_t other = fluid.state.id[q];
    if (bonds.set[other] && (is_new || bonds.is_new[other]) && stiffness(q) > 0.0f)
      row[count++] = {other, apart};
  });
  bonds.grew[id] = count > bonds.count[id];
  bonds.count[id] = count;
}

// Where one of two had no room left the other has no bond either: which of a row's are both's, a bit each.
__global__ void mark_kernel(StepConstants c, SortedFluid fluid, BondView bonds) {
  wait_for_last_kernel();
  const std::uint32_t p = thread_index();
  if (!is_present(c, fluid, p)) return;
  const std::uint32_t id = fluid.state.id[p];
  const Bond* const row = bonds.bonds + std::size_t{id} * kMaxBonds;
  std::uint32_t kept = 0;
  for (std::uint32_t k = 0; k < bonds.count[id]; ++k) {
    const std::uint32_t other = row[k].other;
    const Bond* const theirs = bonds.bonds + std::size_t{other} * kMaxBonds;
    bool both = bonds.count[other] < kMaxBonds;
    for (std::uint32_t i = 0; !both && i < kMaxBonds; ++i) both = theirs[i].other == id;
    kept |= both ? 1u << k : 0u;
  }
  bonds.kept[id] = kept;
}

__global__ void drop_kernel(StepConstants c, float whole, SortedFluid fluid, BondView bonds) {
  wait_for_last_kernel();
  const std::uint32_t p = thread_index();
  if (!is_present(c, fluid, p)) return;
  const std::uint32_t id = fluid.state.id[p], kept = bonds.kept[id];
  Bond* const row = bonds.bonds + std::size_t{id} * kMaxBonds;
  std::uint8_t count = 0;
  for (std::uint32_t k = 0; k < bonds.count[id]; ++k)
    if (kept >> k & 1u) row[count++] = row[k];
  bonds.count[id] = count;
  if (!bonds.grew[id]) return;
  float lengths = 0.0f;
  for (std::uint8_t k = 0; k < count; ++k) lengths += row[k].rest;
  bonds.weight[id] = bond_weight(lengths, whole);
}

__global__ __launch_bounds__(kThreads) void bonds_kernel(StepConstants c, const HeatKind* kinds,
                                                         SortedFluid fluid, BondView bonds) {
  wait_for_last_kernel();
  const std::uint32_t p = thread_index();
  if (!is_present(c, fluid, p)) return;
  const std::uint32_t id = fluid.state.id[p];
  std::uint8_t& count = bonds.count[id];
  if (!bonds.set[id]) count = 0;
  if (count == 0) return;
  Bond* const row = bonds.bonds + std::size_t{id} * kMaxBonds;
  const HeatKind& own = kinds[fluid.state.kind[p]];
  const float4 x = fluid.state.x[p];
  const float cure = fluid.state.heat[p].y, own_weight = bonds.weight[id];
  float3 sum = make_float3(0.0f, 0.0f, 0.0f);
  std::uint8_t kept = 0;
  for (std::uint8_t k = 0; k < count; ++k) {
    const Bond bond = row[k];
    const std::uint32_t q = bonds.slot_of[bond.other];
    if (q == kNowhere || !bonds.set[bond.other]) continue;
    const float4 y = fluid.state.x[q];
    const float r = distance(x, y), strain = (r - bond.rest) / bond.rest;
    const HeatKind& other = kinds[fluid.state.kind[q]];
    if (strain > fminf(own.tears_at, other.tears_at)) continue;
    row[kept++] = bond;
    const float weight = own_weight * bonds.weight[bond.other];
    const float pull =
        fminf(own.bond, other.bond) * weight * fminf(cure, fluid.state.heat[q].y) * strain / fmaxf(r, 1e-12f);
    sum.x += pull * (y.x - x.x);
    sum.y += pull * (y.y - x.y);
    sum.z += pull * (y.z - x.z);
  }
  count = kept;
  float4 force = fluid.force[p];
  force.x += sum.x;
  force.y += sum.y;
  force.z += sum.z;
  fluid.force[p] = force;
}

}  // namespace

void launch_bonds(const StepConstants& constants, const HeatKind* kinds, bool look, float reach, float whole,
                  const SortedFluid& fluid, const BondView& bonds, cudaStream_t stream) {
  const unsigned blocks = blocks_for(fluid.count);
  launch_early(slots_kernel, blocks, kThreads, stream, constants, fluid, bonds);
  if (look) {
    launch_early(look_kernel, blocks, kThreads, stream, constants, fluid, bonds);
    launch_early(bind_kernel, blocks, kThreads, stream, constants, kinds, reach, fluid, bonds);
    launch_early(mark_kernel, blocks, kThreads, stream, constants, fluid, bonds);
    launch_early(drop_kernel, blocks, kThreads, stream, constants, whole, fluid, bonds);
  }
  launch_early(bonds_kernel, blocks, kThreads, stream, constants, kinds, fluid, bonds);
}

}  // namespace slosh::cuda
