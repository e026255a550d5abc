// How a particle's fluid neighbours flow, to first order: so that the velocity fluctuation
// (artificial_viscosity.h) is zero in rigid rotation and linear shear, at a wall and at a surface too.
//
// There all neighbours lie on one side, and their mean velocity is that of a place some tenths of a spacing
// off. Damping against that mean would act on the flow itself
// (tests/notebook/2026-11-26-artificial-viscosity-follows-the-flow.md).
#pragma once

#include "sim/math/symmetric.h"
#include "sim/passes/density/gradient_correction.h"

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

/// What those are for one particle.
template <class Real = float>
struct FlowAround {
  Vector3<Real> offset;   ///< Σ W d, m
  Matrix3<Real> carried;  ///< Σ (v_p − v_i) ⊗ d (−W'/r)
};

/// `v`: the particle's, m/s.
template <class Real>
SLOSH_HD FlowAround<Real> flow_around(const FlowSums<Real>& sum, const Real (&v)[3]) {
  const auto row = [&](int j) {
    return Vector3<Real>{v[j] * sum.slope[0] - sum.carried[j][0], v[j] * sum.slope[1] - sum.carried[j][1],
                         v[j] * sum.slope[2] - sum.carried[j][2]};
  };
  return {{sum.offset[0], sum.offset[1], sum.offset[2]}, {row(0), row(1), row(2)}};
}

/// Σ d ⊗ d (−W'/r) by fluid alone, over the rest lattice's, and its inverse.
template <class Real = float>
struct InverseMoment {
  Symmetric<Real> whole;    ///< the moment itself
  Symmetric<Real> inverse;  ///< of what unflattened() makes of it
  Real kept;                ///< by how much it was flat enough for that to be itself, 0 to 1
};
template <class Real>
SLOSH_HD InverseMoment<Real> inverse_moment(const Symmetric<Real>& moment, float rest_moment) {
  InverseMoment<Real> found;
  Symmetric<Real> upright = found.whole = scaled_and_shifted(moment, Real(1.0f / rest_moment), Real(0.0f));
  found.kept = unflattened(upright);
  found.inverse = inverse(upright);
  return found;
}

/// What Σ W v over the neighbours gains on the way from their middle to the particle, along G = Σ (v_p − v_i)
/// ⊗ d (−W'/r) M⁻¹: exact where they flow linearly. Where M is near singular (a layer, a thread, a drop of a
/// few) it is as much less. `rest_moment`: Σ x² (−W'/r) over the rest lattice. To n.fx, fy, fz.
template <class Real>
SLOSH_HD void follow_flow(const FlowAround<Real>& flow, const InverseMoment<Real>& moment, float rest_moment,
                          Neighborhood<Real>& n) {
  const Real scale = moment.kept / rest_moment;
  const Vector3<Real> to =
      times(moment.inverse, scale * flow.offset.x, scale * flow.offset.y, scale * flow.offset.z);
  const Vector3<Real> found = times(flow.carried, to.x, to.y, to.z);
  n.fx = found.x;
  n.fy = found.y;
  n.fz = found.z;
}

}  // namespace slosh
