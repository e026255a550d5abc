#include "tests/lab/report/roofline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "sim/columns.h"

namespace slosh::report {
namespace {

// FLOP, counted in the loops of sim/passes/density and sim/passes/pressure_force.
constexpr double kDistanceFlops = 8.0;    // a candidate: d, and r² of it
constexpr double kDensityFlops = 44.0;    // a neighbour: kernel, moment, mean velocity
constexpr double kStressFlops = 24.0;     // beside it: the flow's gradient
constexpr double kPressureFlops = 24.0;   // a neighbour: T g
constexpr double kViscosityFlops = 45.0;  // beside it: Eq 6 or 9
// Bytes a neighbour, that density writes down and pressure_force reads.
constexpr double kPairBytesOnCpu = 8.0;
constexpr double kPairBytesOnCuda = 4.0;
// Bytes a particle, of sorting: the key and the order, each written and read.
constexpr double kSortingBytes = 16.0;

struct ColumnBytes {
  double carried = 0.0;  // all that a sort gathers
  double state = 0.0;    // of these what forces depend on
  double step = 0.0;     // what density leaves for pressure_force
  double force = 0.0;
};

ColumnBytes bytes_of(const Plan& plan) {
  ColumnBytes sum;
  for (const ColumnInfo& column : kFluidColumns) {
    if (!needs(plan, column.need)) continue;
    const auto bytes = static_cast<double>(column.bytes);
    if (column.life == ColumnLife::kCarried) {
      sum.carried += bytes;
      if (column.pack != Pack::kId && column.pack != Pack::kSolved) sum.state += bytes;
    } else if (column.life == ColumnLife::kStep) {
      (column.pack == Pack::kForce ? sum.force : sum.step) += bytes;
    }
  }
  return sum;
}

using Cell = std::array<std::int32_t, 3>;
std::uint64_t key_of(const Cell& cell) {
  std::uint64_t key = 0;
  for (const std::int32_t c : cell) key = key << 21 | (static_cast<std::uint32_t>(c) & 0x1fffff);
  return key;
}

}  // namespace

PairCounts count_pairs(std::span<const glm::vec3> positions, double support_radius, std::size_t samples) {
  const auto cell_of = [&](const glm::vec3& x) {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis)
      cell[static_cast<std::size_t>(axis)] =
          static_cast<std::int32_t>(std::floor(static_cast<double>(x[axis]) / support_radius));
    return cell;
  };
  std::unordered_map<std::uint64_t, std::vector<glm::vec3>> cells;
  for (const glm::vec3& x : positions) cells[key_of(cell_of(x))].push_back(x);
  const std::size_t apart = std::max<std::size_t>(1, positions.size() / samples);
  const double reach = support_radius * support_radius;
  PairCounts counts;
  double taken = 0.0;
  for (std::size_t p = 0; p < positions.size(); p += apart, taken += 1.0) {
    const Cell own = cell_of(positions[p]);
    for (int i = 0; i < 27; ++i) {
      const auto found = cells.find(key_of({own[0] + i % 3 - 1, own[1] + i / 3 % 3 - 1, own[2] + i / 9 - 1}));
      if (found == cells.end()) continue;
      counts.candidates += static_cast<double>(found->second.size());
      for (const glm::vec3& x : found->second) {
        const glm::vec3 d = x - positions[p];
        if (glm::dot(d, d) < reach) counts.neighbours += 1.0;
      }
    }
    counts.neighbours -= 1.0;  // itself
  }
  if (taken > 0.0) counts = {counts.candidates / taken, counts.neighbours / taken};
  return counts;
}

std::vector<PassWork> pass_work(const Plan& plan, const PairCounts& pairs, Backend backend) {
  const ColumnBytes columns = bytes_of(plan);
  const double list = pairs.neighbours * (backend == Backend::kCuda ? kPairBytesOnCuda : kPairBytesOnCpu);
  const double volume = sizeof(float);  // which density writes anew
  const double density = kDensityFlops + (plan.has(PassId::kFluidStress) ? kStressFlops : 0.0);
  const double force = kPressureFlops + (plan.viscous() ? kViscosityFlops : 0.0);
  return {
      {PassId::kSortFluid, 2.0 * columns.carried + kSortingBytes, 0.0},
      {PassId::kDensity, columns.state + volume + columns.step + list,
       kDistanceFlops * pairs.candidates + density * pairs.neighbours},
      {PassId::kPressureForce, columns.state + columns.step + columns.force + list, force * pairs.neighbours},
  };
}

double roof(const Ceilings& ceilings, double flops_per_byte) {
  return std::min(ceilings.flops_per_s, ceilings.bytes_per_s * flops_per_byte);
}

}  // namespace slosh::report
