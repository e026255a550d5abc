// How a particle's fluid neighbours flow, to first order: so that what it moves otherwise than they do
// (noise.h) is nothing in a fluid that turns or shears as one, at a wall and at a surface too.
//
// There all neighbours lie on one side, and their mean velocity is that of a place some tenths of a spacing
// off. Drag against that mean was drag on the flow: a fluid of 0.5 Pa·s in a glass that turned at 16 rad/s
// turned by 4 % faster than the glass (10 mm), and a cylinder that suddenly turned in it was braked by 6 %
// too much (README.md, *Jostling, and the flow*).
#pragma once

#include "sim/math/symmetric.h"
#include "sim/pressure/gradient_correction.h"

namespace slosh {

/// Sums over the fluid neighbours at x_i = x_p − d, without the kernels' constants.
template <class Real>
struct FlowSums {
  Real offset[3];      ///< Σ W d, m
  Real slope[3];       ///< Σ d (−W'/r)
  Real carried[3][3];  ///< Σ v_j d_k (−W'/r), m/s
};

template <class Kernel, class Real>
SLOSH_HD void add_flow(const Real (&d)[3], const Real (&v)[3], Real h, FlowSums<Real>& sum) {
  const PairKernel<Real> kernel = Kernel::pair(d[0] * d[0] + d[1] * d[1] + d[2] * d[2], h, Real(1));
  const Real w = Kernel::shape_of(kernel);
  for (int k = 0; k < 3; ++k) {
    const Real weighed = kernel.slope_over_r * d[k];
    sum.offset[k] += w * d[k];
    sum.slope[k] += weighed;
    for (int j = 0; j < 3; ++j) sum.carried[j][k] += v[j] * weighed;
  }
}

/// What Σ W v over the neighbours gains on the way from their middle to the particle, along G = Σ (v_p − v_i)
/// ⊗ d (−W'/r) M⁻¹, M the moment by fluid alone: exact where they flow linearly. Where M is too flat to be
/// turned round (a layer, a thread, a drop of a few) it is as much less. `moment`: M over the rest lattice's,
/// `rest_moment`; `v`: the particle's, m/s. To n.fx, fy, fz.
SLOSH_HD inline void follow_flow(const FlowSums<float>& sum, Symmetric<float> moment, float rest_moment,
                                 const float (&v)[3], Neighborhood<float>& n) {
  const float kept = unflattened(moment);
  const float scale = kept / rest_moment;
  const Symmetric<float> turned = inverse(moment);
  const Vector3<float> to =
      times(turned, scale * sum.offset[0], scale * sum.offset[1], scale * sum.offset[2]);
  const auto along = [&](int j) {
    const float by_x = v[j] * sum.slope[0] - sum.carried[j][0];
    const float by_y = v[j] * sum.slope[1] - sum.carried[j][1];
    const float by_z = v[j] * sum.slope[2] - sum.carried[j][2];
    return by_x * to.x + by_y * to.y + by_z * to.z;
  };
  n.fx = along(0);
  n.fy = along(1);
  n.fz = along(2);
}

}  // namespace slosh
