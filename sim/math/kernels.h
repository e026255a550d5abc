// Smoothing kernels of Müller, Charypar & Gross 2003, which the paper uses ([6]): poly6 for density, the
// spiky kernel and its gradient for pressure, the viscosity kernel's Laplacian for viscosity. All vanish at
// the support radius h. `Real` is float (CUDA, scalar code), double (tests) or a SIMD batch (sim/cpu).
#pragma once

#include <cmath>

#include "sim/math/host_device.h"

namespace slosh {

/// The operations on Real that are spelled differently for a number and for a SIMD batch. sim/cpu/simd.h
/// specialises it for batches.
template <class Real>
struct RealOps {
  SLOSH_HD static Real positive_part(Real x) { return x > Real(0) ? x : Real(0); }
  /// a < b ? yes : no
  SLOSH_HD static Real where_less(Real a, Real b, Real yes, Real no) { return a < b ? yes : no; }
  SLOSH_HD static Real root(Real x) { return std::sqrt(x); }
  /// 1/√x for x > 0, to the last bits of Real.
  SLOSH_HD static Real inverse_sqrt(Real x) {
#ifdef __CUDA_ARCH__
    // One instruction, within two last places; a root and a division are thirty.
    if constexpr (sizeof(Real) == sizeof(float)) return rsqrtf(x);
#endif
    return Real(1) / std::sqrt(x);
  }
};

/// W_poly6(r) without its constant: (h² − r²)³, m⁶; 0 from h on. Takes r² so that density needs no root.
template <class Real>
SLOSH_HD Real poly6_shape(Real r_squared, Real h_squared) {
  const Real d = RealOps<Real>::positive_part(h_squared - r_squared);
  return d * d * d;
}

/// W_spiky without its constant: (h − r)³, m³. Takes r² like poly6_shape.
template <class Real>
SLOSH_HD Real spiky_shape(Real r_squared, Real h) {
  // The floor keeps 1/√ finite for the particle itself; it moves W(0) by 10⁻⁶.
  const Real floored = r_squared + h * h * Real(1e-12f);
  const Real d = RealOps<Real>::positive_part(h - floored * RealOps<Real>::inverse_sqrt(floored));
  return d * d * d;
}

/// h − r, 0 from h on: the building block of both force kernels.
template <class Real>
SLOSH_HD Real kernel_reach(Real r, Real h) {
  return RealOps<Real>::positive_part(h - r);
}

/// A support radius h, m, and its square.
template <class Real>
struct Support {
  Real radius, radius_squared;
};

/// What a pair's forces take from their kernel at one distance, all without its constant, Kernel::scale(h):
///   ∇W = −scale · slope_over_r · d      (d = x_p − x_i)
///   ∇²W = scale · laplacian
template <class Real>
struct PairKernel {
  Real inverse_r;
  Real slope_over_r;
  Real laplacian;
};

/// How a pair's viscous force falls off within the support radius h, in place of the kernel's ∇²W (h − r,
/// without its constant): (h − r) (level + growth (h − r)). {1, 0} is ∇²W itself, bitwise.
template <class Real>
struct DragShape {
  Real level;
  Real growth;  ///< 1/m

  /// `reach`: h − r, m; 0 from h on.
  SLOSH_HD Real operator()(Real reach) const { return reach * (level + growth * reach); }
};

/// For densities alone.
struct Poly6 {
  template <class Real>
  SLOSH_HD static Real shape(Real r_squared, const Support<Real>& support) {
    return poly6_shape(r_squared, support.radius_squared);
  }
  /// m⁻⁹: W = scale · shape.
  static double shape_scale(double h) { return 315.0 / (64.0 * 3.14159265358979323846 * std::pow(h, 9)); }
};

/// The spiky kernel, and with it the viscosity kernel's Laplacian: their constants are the same.
struct Spiky {
  template <class Real>
  SLOSH_HD static Real shape(Real r_squared, const Support<Real>& support) {
    return spiky_shape(r_squared, support.radius);
  }
  /// m⁻⁶: W = scale · shape.
  static double shape_scale(double h) { return scale(h) / 3.0; }

  /// `weight` is 1 where the neighbour counts, else 0.
  template <class Real>
  SLOSH_HD static PairKernel<Real> pair(Real r_squared, Real h, Real weight) {
    // The floor keeps 1/r finite at r = 0; it is 10⁻⁶ h, where d/r is already nothing but rounding.
    const Real floored = r_squared + h * h * Real(1e-12f);
    const Real inverse_r = RealOps<Real>::inverse_sqrt(floored);
    const Real reach = kernel_reach(floored * inverse_r, h) * weight;
    return {inverse_r, reach * reach * inverse_r, reach};
  }
  /// shape() of the same pair.
  template <class Real>
  SLOSH_HD static Real shape_of(const PairKernel<Real>& pair) {
    return pair.laplacian * pair.laplacian * pair.laplacian;
  }
  /// The same at a distance r >= 0.
  static double laplacian(double r, double h) { return kernel_reach(r, h); }
  /// m⁻⁶.
  static double scale(double h) { return 45.0 / (3.14159265358979323846 * std::pow(h, 6)); }
};

}  // namespace slosh
