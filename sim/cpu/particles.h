// The particle sets of the CPU backend: columns sorted by cell, each with kLanes entries of padding.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/columns.h"
#include "sim/cpu/cell_grid.h"
#include "sim/cpu/simd.h"
#include "sim/plan.h"
#include "sim/walls/mirror_planes.h"

namespace slosh {

/// Fluid particles, and point probes behind Scene's fluids. Sorted by cell; [0, active) are in the world.
struct FluidParticles : FluidColumns<Column> {
  std::size_t active = 0;
  CellIndex index;
  std::vector<std::uint8_t> near_wall;  ///< one a particle, by the last force pass: bodies are around it

  /// Makes those columns that the plan needs and that are not there yet, zeroed.
  void provide(const Plan& plan, std::size_t count);
};

/// Where a sort gathers to: only the columns that it carries are there.
struct GatheredColumns : FluidColumns<Column> {
  void provide(const Plan& plan, std::size_t count);
};

/// A MirrorPlane a particle (walls/mirror_planes.h), world axes. Empty where no body of a set mirrors.
struct MirrorColumns {
  Column<float> nx, ny, nz, xx, xy, xz, yy, yz, zz;

  bool empty() const { return nx.empty(); }
  void resize(std::size_t count);
  void set(std::size_t i, const MirrorPlane& plane);
};

/// Particles of rigid bodies with constant density (section 4.1). One set for the fixed bodies, sorted once,
/// and one for the free ones, placed and sorted every step.
struct BoundaryParticles {
  Column<float> x, y, z;     ///< m, world
  Column<float> vx, vy, vz;  ///< m/s (Eq 14)
  Column<float> pressure;    ///< kPaper: Pa, Eq 7 at the body's constant density; corrects_gradients(): how
                           ///< many lattice particles it stands for, about kWallShare
  Column<float> volume;        ///< m³
  Column<float> viscosity;     ///< Pa·s
  Column<float> reach;         ///< m, SurfaceParticle::reach
  Column<std::uint16_t> body;  ///< index into Scene::bodies
  MirrorColumns mirror;
  CellIndex index;

  void resize(std::size_t count);
};

}  // namespace slosh
