// The viscous force of a free-slip wall: none along itself, and across itself that of the fluid's mirror
// image behind it.
//
// Free slip is symmetry: the same fluid behind the wall, mirrored. Pressures have the wall's particles for
// it; without this the viscous force would be half as large as it should across a wall
// (tests/notebook/2026-11-26-convergence-of-a-vortex.md). A particle of the wall's surface drags fluid along
// the normal at the fluid's own foot, against what that has across the wall. So nothing brakes what slides,
// along a bent wall neither.
#pragma once

#include "sim/math/kernels.h"
#include "sim/math/symmetric.h"
#include "sim/passes/pair_viscosity/pair_viscosity.h"

namespace slosh {

/// A MirrorPlane (walls/mirror_planes.h) as pairs see it. `Real` is a number, or a SIMD batch of neighbours.
template <class Real>
struct MirrorView {
  Real nx, ny, nz;
  Symmetric<Real> bend;
};

/// Adds the force that a fluid particle loses for each m/s, N·s/m, without the kernel's constant:
/// `fluid`'s place, volume and viscosity, `wall`'s place and volume.
template <class Kernel, class Real>
SLOSH_HD void add_mirror_rate(const ParticleView<Real>& fluid, const ParticleView<Real>& wall,
                              const MirrorView<Real>& mirror, Real h, const DragShape<Real>& shape,
                              Real weight, Symmetric<Real>& sum) {
  const Real dx = fluid.x - wall.x, dy = fluid.y - wall.y, dz = fluid.z - wall.z;
  const PairKernel<Real> kernel = Kernel::pair(dx * dx + dy * dy + dz * dz, h, weight);
  const Vector3<Real> turned = times(mirror.bend, dx, dy, dz);
  const Real nx = mirror.nx + turned.x, ny = mirror.ny + turned.y, nz = mirror.nz + turned.z;
  // Where nothing is mirrored the normal is 0.
  const Real squared = nx * nx + ny * ny + nz * nz + Real(1e-12f);
  const Real drag = (Real(kCentralDrag) * fluid.viscosity * fluid.volume) *
                    (wall.volume * shape(kernel.laplacian)) / squared;
  add_outer(drag, nx, ny, nz, sum);
}

/// Adds what the wall's particle feels, N without the kernel's constant, of a pair whose fluid moves by its
/// velocity, with the couple that its bearing at the fluid's place is.
template <class Kernel, class Real>
SLOSH_HD void add_mirror_force(const ParticleView<Real>& fluid, const ParticleView<Real>& wall,
                               const MirrorView<Real>& mirror, Real h, const DragShape<Real>& shape,
                               Real weight, SurfaceSum<Real>& sum) {
  Symmetric<Real> rate{Real(0.0f), Real(0.0f), Real(0.0f), Real(0.0f), Real(0.0f), Real(0.0f)};
  add_mirror_rate<Kernel>(fluid, wall, mirror, h, shape, weight, rate);
  const Vector3<Real> force = times(rate, fluid.vx, fluid.vy, fluid.vz);
  const Real dx = fluid.x - wall.x, dy = fluid.y - wall.y, dz = fluid.z - wall.z;
  sum.x += force.x;
  sum.y += force.y;
  sum.z += force.z;
  sum.cx += dy * force.z - dz * force.y;
  sum.cy += dz * force.x - dx * force.z;
  sum.cz += dx * force.y - dy * force.x;
}

}  // namespace slosh
