// The fluid's drag on a rigid body as a matrix of the body's twist.
//
// Drag taken from the velocities that a step begins with throws a body about as soon as the step is longer
// than twice its mass over its drag: a light box in honey. With the drag's derivative in the body's own solve
// the velocity that the step ends with is what drags, and the fluid is then dragged by the same velocity
// (add_pair_viscosity of the change), so that the pair goes on giving what it takes.
#pragma once

#include <glm/glm.hpp>

#include "sim/math/dense.h"
#include "sim/particle_view.h"
#include "sim/passes/pair_viscosity/pair_viscosity.h"

namespace slosh {

/// Adds how much force along each axis a pair gives for each m/s between its two, N·s/m, without the kernel's
/// constant. It is add_pair_force's viscous part, differentiated by i's velocity.
template <class Kernel, DragRule rule, class Real>
SLOSH_HD void add_pair_viscosity_rate(const ParticleView<Real>& p, const ParticleView<Real>& i, Real h,
                                      const DragShape<Real>& shape, Real weight, Symmetric<Real>& sum) {
  const Real dx = p.x - i.x;
  const Real dy = p.y - i.y;
  const Real dz = p.z - i.z;
  const PairKernel<Real> kernel = Kernel::pair(dx * dx + dy * dy + dz * dz, h, weight);
  const Real drag = drag_coefficient(p, i, shape(kernel.laplacian));
  if constexpr (rule == DragRule::kAlongVelocity) {
    sum.xx += drag;
    sum.yy += drag;
    sum.zz += drag;
  } else {
    const Real along = Real(kCentralDrag) * drag * (kernel.inverse_r * kernel.inverse_r);
    add_outer(along, dx, dy, dz, sum);
  }
}

/// Adds the viscous force on p of a neighbour that moves by (i.vx, i.vy, i.vz) m/s more than it did.
template <class Kernel, DragRule rule, class Real>
SLOSH_HD void add_pair_viscosity(const ParticleView<Real>& p, const ParticleView<Real>& i, Real h,
                                 const DragShape<Real>& shape, Real weight, ForceSum<Real>& sum) {
  Symmetric<Real> rate{Real(0.0f), Real(0.0f), Real(0.0f), Real(0.0f), Real(0.0f), Real(0.0f)};
  add_pair_viscosity_rate<Kernel, rule>(p, i, h, shape, weight, rate);
  sum.x += rate.xx * i.vx + rate.xy * i.vy + rate.xz * i.vz;
  sum.y += rate.xy * i.vx + rate.yy * i.vy + rate.yz * i.vz;
  sum.z += rate.xz * i.vx + rate.yz * i.vy + rate.zz * i.vz;
}

/// A body's drag: the wrench about its centre of mass that it loses for each unit of its twist (linear first,
/// angular after), as the 21 numbers on and above the diagonal, row by row.
struct BodyDrag {
  static constexpr int kSize = 21;
  double upper[kSize] = {};

  /// Adds one particle of the body, `arm` m from the centre of mass, that loses `rate` · its velocity.
  SLOSH_HD void add(const Symmetric<double>& rate, const glm::dvec3& arm) {
    // The particle moves by v + ω × arm, and its force f gives the torque arm × f: with X·v = arm × v the
    // blocks are C, −C·X and −X·C·X.
    const double c[3][3] = {
        {rate.xx, rate.xy, rate.xz}, {rate.xy, rate.yy, rate.yz}, {rate.xz, rate.yz, rate.zz}};
    const double x[3][3] = {{0.0, -arm.z, arm.y}, {arm.z, 0.0, -arm.x}, {-arm.y, arm.x, 0.0}};
    double cx[3][3];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) cx[i][j] = c[i][0] * x[0][j] + c[i][1] * x[1][j] + c[i][2] * x[2][j];
    }
    int k = 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) upper[k++] += c[i][j];
      for (int j = 0; j < 3; ++j) upper[k++] -= cx[i][j];
    }
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) upper[k++] -= x[i][0] * cx[0][j] + x[i][1] * cx[1][j] + x[i][2] * cx[2][j];
    }
  }

  SLOSH_HD Matrix6 matrix() const {
    Matrix6 full{};
    int k = 0;
    for (int i = 0; i < 6; ++i) {
      for (int j = i; j < 6; ++j) full[i][j] = full[j][i] = upper[k++];
    }
    return full;
  }
};

}  // namespace slosh
