// Smoothing kernels of Müller, Charypar & Gross 2003, which the paper uses ([6]): poly6 for density, the
// spiky kernel and its gradient for pressure, the viscosity kernel's Laplacian for viscosity. All vanish at
// the support radius h. `Real` is float (CUDA, scalar code), double (tests) or a SIMD batch (sim/cpu).
#pragma once

#include <cmath>

#include "sim/math/host_device.h"

namespace slosh {

/// The two operations on Real that are spelled differently for a number and for a SIMD batch.
/// sim/cpu/simd.h specialises it for batches.
template <class Real>
struct RealOps {
  SLOSH_HD static Real positive_part(Real x) { return x > Real(0) ? x : Real(0); }
  /// 1/√x for x > 0, to the last bits of Real.
  SLOSH_HD static Real inverse_sqrt(Real x) {
#ifdef __CUDA_ARCH__
    // One instruction, within two last places; a root and a division are thirty.
    if constexpr (sizeof(Real) == sizeof(float)) return rsqrtf(x);
#endif
    return Real(1) / std::sqrt(x);
  }
};

/// What the kernels need to know about one support radius.
struct KernelConstants {
  float support_radius = 0.0f;          ///< h, m
  float support_radius_squared = 0.0f;  ///< m²
  float poly6 = 0.0f;                   ///< 315/(64πh⁹), m⁻⁹
  float spiky =
      0.0f;  ///< 45/(πh⁶), m⁻⁶: of the spiky gradient and of the viscosity Laplacian alike (W: a third)
};

inline KernelConstants make_kernel_constants(double support_radius) {
  const double h = support_radius;
  const double pi = 3.14159265358979323846;
  return {static_cast<float>(h), static_cast<float>(h * h),
          static_cast<float>(315.0 / (64.0 * pi * std::pow(h, 9))),
          static_cast<float>(45.0 / (pi * std::pow(h, 6)))};
}

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
///   W_spiky = spiky/3 · reach³
///   ∇W_spiky = −spiky · reach² · d/r      (d = x_p − x_i)
///   ∇²W_viscosity = spiky · reach
template <class Real>
SLOSH_HD Real kernel_reach(Real r, Real h) {
  return RealOps<Real>::positive_part(h - r);
}

}  // namespace slosh
