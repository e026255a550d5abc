// The particle sets of the CPU backend: columns sorted by cell, each with kLanes entries of padding.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/cpu/cell_grid.h"
#include "sim/cpu/simd.h"

namespace slosh {

/// Fluid particles, and point probes behind Scene's fluids. Sorted by cell; [0, active) are in the world.
struct FluidParticles {
  Column<float> x, y, z;           ///< m
  Column<float> vx, vy, vz;        ///< m/s, half a step behind x (leap-frog)
  Column<std::uint32_t> id;        ///< fixed for the run
  Column<std::uint8_t> kind;       ///< index into the kinds table: a fluid, or a probe
  Column<std::uint32_t> key;       ///< cell, or retired
  Column<float> pressure, volume;  ///< Pa (kConsistent: V²P, N·m⁴), m³: written by the density pass
  Column<float> viscosity;         ///< Pa·s; filled only when pairs differ
  Column<float> fx, fy, fz;        ///< N: written by the force pass
  std::size_t active = 0;
  CellIndex index;

  void resize(std::size_t count);
  std::size_t size() const { return id.size() - kLanes; }
};

/// Particles of rigid bodies with constant density (section 4.1). One set for the fixed bodies, sorted once,
/// and one for the free ones, placed and sorted every step.
struct BoundaryParticles {
  Column<float> x, y, z;     ///< m, world
  Column<float> vx, vy, vz;  ///< m/s (Eq 14)
  Column<float> pressure;  ///< kPaper: Pa, Eq 7 at the body's constant density; kConsistent: how many lattice
                           ///< particles it stands for, about kWallShare
  Column<float> volume;    ///< m³
  Column<float> viscosity;     ///< Pa·s
  Column<std::uint16_t> body;  ///< index into Scene::bodies
  Column<std::uint32_t> key;
  CellIndex index;

  void resize(std::size_t count);
  std::size_t size() const { return body.empty() ? 0 : body.size() - kLanes; }
};

}  // namespace slosh
