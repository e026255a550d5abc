// The pressure of the corrected model: each particle presses through a tensor that makes up for the
// unevenness of its own neighbourhood.
//
// Between two particles the force is −(T_p + T_i) ∇W, T = V V⁰ P L, L the inverse of M = V⁰ Σ d ⊗ d (−W'/r)
// (Bonet & Lok 1999). A particle's virial, Σ V⁰ d ⊗ T ∇W, is then −V P · 1 whatever way its neighbours lie:
// its pressure is isotropic and carries no shear. With L = 1 the lattice that particles under pressure settle
// into has a shear modulus of some tenths of P, and the fluid yields like sand. Forces are equal and
// opposite; since L M = 1 is symmetric, they exert no net torque where the correction is whole.
//
// The price: the force is no energy's gradient. viscosity/artificial_viscosity.h damps the velocity
// fluctuations that gain by it.
#pragma once

#include "sim/math/kernels.h"
#include "sim/math/symmetric.h"

namespace slosh {

/// Below this compression all of the correction is made. A default stiffness keeps a fluid's own weight below
/// a third of it. From there the correction fades, and by the second there is none: in an impact the gradient
/// of an energy gives back no more than it took (tests/stability: drops rebound higher than they fell without
/// this).
inline constexpr float kQuietCompression = 0.1f;
inline constexpr float kImpact = 0.2f;
/// Below this determinant a neighbourhood's moment matrix is near singular, and L goes to 1.
inline constexpr float kFlattest = 0.1f;

/// What a particle's neighbours (itself included) add up to. Lengths in m, without the kernels' constants.
template <class Real>
struct Neighborhood {
  Real number;             ///< Σ W, walls with their share
  Symmetric<Real> moment;  ///< Σ d ⊗ d (−W'/r), walls as one layer (CorrectionConstants::wall_layer)
  Real fluid_number;       ///< Σ W over fluid
  Real vx, vy, vz;         ///< Σ W v over fluid
  Real fx, fy, fz;         ///< what their flow adds to that on the way to the particle (neighbour_flow.h)
};

template <class Real>
SLOSH_HD void add_moment(Real dx, Real dy, Real dz, const PairKernel<Real>& kernel, Symmetric<Real>& moment) {
  const Real sx = kernel.slope_over_r * dx;
  const Real sy = kernel.slope_over_r * dy;
  const Real sz = kernel.slope_over_r * dz;
  moment.xx += sx * dx;
  moment.xy += sx * dy;
  moment.xz += sx * dz;
  moment.yy += sy * dy;
  moment.yz += sy * dz;
  moment.zz += sz * dz;
}

/// One fluid neighbour (or a batch of them) at x_i = x_p − d, moving at v. `weight` is 1 where it counts.
template <class Kernel, class Real>
SLOSH_HD void add_fluid_neighbor(Real dx, Real dy, Real dz, Real vx, Real vy, Real vz, Real h, Real weight,
                                 Neighborhood<Real>& sum) {
  const PairKernel<Real> kernel = Kernel::pair(dx * dx + dy * dy + dz * dz, h, weight);
  const Real w = Kernel::shape_of(kernel);
  sum.number += w;
  sum.fluid_number += w;
  sum.vx += w * vx;
  sum.vy += w * vy;
  sum.vz += w * vz;
  add_moment(dx, dy, dz, kernel, sum.moment);
}

/// One wall particle. `share`: how many lattice particles it stands for. It presses and counts as so many,
/// but in the moment as `layer`: with all of it the first layer of fluid is pushed off to the side.
template <class Kernel, class Real>
SLOSH_HD void add_wall_neighbor(Real dx, Real dy, Real dz, Real share, Real layer, Real h, Real weight,
                                Neighborhood<Real>& sum) {
  const PairKernel<Real> kernel = Kernel::pair(dx * dx + dy * dy + dz * dz, h, weight);
  sum.number += share * Kernel::shape_of(kernel);
  add_moment(dx, dy, dz, {kernel.inverse_r, layer * kernel.slope_over_r, kernel.laplacian}, sum.moment);
}

/// Regularises a moment matrix that is near singular with as much of 1 as that takes. Returns the share of it
/// that is left.
template <class Real>
SLOSH_HD Real unflattened(Symmetric<Real>& moment) {
  const Real one(1.0f), flat = determinant(moment) / kFlattest;
  const Real keep = RealOps<Real>::positive_part(flat);
  const Symmetric<Real> upright = scaled_and_shifted(moment, keep, one - keep);
  const auto where_flat = [&](Real yes, Real no) { return RealOps<Real>::where_less(flat, one, yes, no); };
  moment = {where_flat(upright.xx, moment.xx), where_flat(upright.xy, moment.xy),
            where_flat(upright.xz, moment.xz), where_flat(upright.yy, moment.yy),
            where_flat(upright.yz, moment.yz), where_flat(upright.zz, moment.zz)};
  return where_flat(keep, one);
}

/// How much of the correction a particle gets at a compression ρ/ρ⁰ − 1: 0–1.
template <class Real>
SLOSH_HD Real corrected_share(Real compression) {
  const Real left = RealOps<Real>::positive_part(kImpact - compression) / (kImpact - kQuietCompression);
  return RealOps<Real>::where_less(left, Real(1.0f), left, Real(1.0f));
}

/// What V² P is multiplied by, from a moment that is 1 on the rest lattice: `share` of its inverse, `virial`
/// times as strong, and for the rest 1, the gradient of an energy of the densities. Where
/// neighbours are missing (a free surface, spray) they are taken to lie evenly, and the share goes with them;
/// none are from `whole_from` of the moment on.
template <class Real>
SLOSH_HD Symmetric<Real> pressure_directions(const Symmetric<Real>& moment, Real share, Real virial,
                                             Real whole_from = Real(1.0f)) {
  const Real missing = RealOps<Real>::positive_part(1.0f - trace(moment) / (3.0f * whole_from));
  Symmetric<Real> whole = scaled_and_shifted(moment, Real(1.0f), missing);
  unflattened(whole);
  const Real made = share * RealOps<Real>::positive_part(1.0f - missing);
  return scaled_and_shifted(inverse(whole), made * virial, 1.0f - made);
}

}  // namespace slosh
