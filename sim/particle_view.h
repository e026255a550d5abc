// A particle as pairs see it.
#pragma once

#include "sim/math/kernels.h"
#include "sim/math/symmetric.h"

namespace slosh {

/// SI. `Real` is a number, or a SIMD batch of neighbours.
template <class Real>
struct ParticleView {
  Real x, y, z;     ///< m
  Real vx, vy, vz;  ///< m/s
  Real pressure;    ///< Pa, or what PairRule says
  Real volume;      ///< m³
  Real viscosity;   ///< Pa·s (its side of Eq 9)
  // The corrected model's:
  Symmetric<Real> push;  ///< what it presses with, N·m⁴ (passes/density/gradient_correction.h)
  Real ux, uy,
      uz;  ///< Pa·m: viscosity times velocity, and times fluctuation (viscosity/artificial_viscosity.h)
};

template <class Real>
struct ForceSum {
  Real x, y, z;
};

/// Of a body's particle, with what turns the body besides the force's moment about its centre.
template <class Real>
struct SurfaceSum : ForceSum<Real> {
  Real cx, cy, cz;
  Real beyond;  ///< the share of what it bears that bears where the fluid is
                ///< (passes/pressure_force/pair_force.h)
};

}  // namespace slosh
