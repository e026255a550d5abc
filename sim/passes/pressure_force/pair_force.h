// The force of one particle on another: Eq 5, 6 and 9 as a pure function. A CUDA kernel calls it with float,
// the CPU with a SIMD batch of neighbours.
#pragma once

#include "sim/passes/pair_viscosity/pair_viscosity.h"
#include "sim/passes/pressure_force/pair_pressure.h"

namespace slosh {

/// Adds one neighbour's (or one batch of neighbours') part of the pressure force and, with `viscous`, of Eq 9
/// to `sum`. The force on p is Kernel::scale(h) times the sum. The pair (p, i) and the pair (i, p) give
/// opposite forces to rounding: every factor is symmetric but d and dv. Coincident particles (and p itself)
/// add nothing. `shape`: of all viscous forces. `weight` is 1 where the neighbour counts, else 0. `Sum`:
/// ForceSum, or SurfaceSum where p is a wall's.
template <class Kernel, PairRule rule, DragRule drag_rule, bool viscous, class Real, class Sum>
SLOSH_HD void add_pair_force(const ParticleView<Real>& p, const ParticleView<Real>& i, Real h,
                             const DragShape<Real>& shape, Real weight, Sum& sum) {
  const Real dx = p.x - i.x;
  const Real dy = p.y - i.y;
  const Real dz = p.z - i.z;
  const Real r_squared = dx * dx + dy * dy + dz * dz;
  const PairKernel<Real> kernel = Kernel::pair(r_squared, h, weight);
  Real along(0.0f);  // of d
  if constexpr (presses_by_tensor(rule)) {
    const Symmetric<Real> t = pressure_tensor<rule>(p, i);
    const Real tx = kernel.slope_over_r * (t.xx * dx + t.xy * dy + t.xz * dz);
    const Real ty = kernel.slope_over_r * (t.xy * dx + t.yy * dy + t.yz * dz);
    const Real tz = kernel.slope_over_r * (t.xz * dx + t.yz * dy + t.zz * dz);
    sum.x += tx;
    sum.y += ty;
    sum.z += tz;
    // Fluid presses without a torque on all that its moment counts, and of a wall that is less than presses:
    // what is beyond it has its reaction on the body where the fluid is, not where the wall's particle is. A
    // body takes a force anywhere, so the pair exerts no net torque.
    if constexpr (is_corrected_body(rule) && requires { sum.cx; }) {
      sum.cx += sum.beyond * (ty * dz - tz * dy);
      sum.cy += sum.beyond * (tz * dx - tx * dz);
      sum.cz += sum.beyond * (tx * dy - ty * dx);
    }
  } else if constexpr (rule == PairRule::kPaper) {
    along = pressure_coefficient(p, i) * kernel.slope_over_r;
  }
  if constexpr (is_corrected_fluid(rule)) {
    const Real dragged = (i.ux - p.ux) * dx + (i.uy - p.uy) * dy + (i.uz - p.uz) * dz;
    along += (Real(kCentralDrag) * (p.volume * i.volume) * shape(kernel.laplacian)) *
             (dragged * (kernel.inverse_r * kernel.inverse_r));
  }
  if constexpr (viscous) {
    const Real dvx = i.vx - p.vx;
    const Real dvy = i.vy - p.vy;
    const Real dvz = i.vz - p.vz;
    const Real drag = drag_coefficient(p, i, shape(kernel.laplacian));
    if constexpr (drag_rule == DragRule::kAlongVelocity) {
      sum.x += drag * dvx;
      sum.y += drag * dvy;
      sum.z += drag * dvz;
    } else {
      along += (Real(kCentralDrag) * drag) *
               ((dvx * dx + dvy * dy + dvz * dz) * (kernel.inverse_r * kernel.inverse_r));
    }
  }
  sum.x += along * dx;
  sum.y += along * dy;
  sum.z += along * dz;
}

}  // namespace slosh
