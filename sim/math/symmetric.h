// Symmetric 3×3 tensors as six numbers, or six batches of them, and others by their rows.
#pragma once

#include "sim/math/host_device.h"

namespace slosh {

template <class Real>
struct Symmetric {
  Real xx, xy, xz, yy, yz, zz;
};

template <class Real>
SLOSH_HD Real trace(const Symmetric<Real>& t) {
  return t.xx + t.yy + t.zz;
}

template <class Real>
SLOSH_HD Real determinant(const Symmetric<Real>& t) {
  return t.xx * (t.yy * t.zz - t.yz * t.yz) - t.xy * (t.xy * t.zz - t.yz * t.xz) +
         t.xz * (t.xy * t.yz - t.yy * t.xz);
}

template <class Real>
struct Vector3 {
  Real x, y, z;
};
template <class Real>
SLOSH_HD Vector3<Real> times(const Symmetric<Real>& t, Real x, Real y, Real z) {
  return {t.xx * x + t.xy * y + t.xz * z, t.xy * x + t.yy * y + t.yz * z, t.xz * x + t.yz * y + t.zz * z};
}

/// a · t + b · 1.
template <class Real>
SLOSH_HD Symmetric<Real> scaled_and_shifted(const Symmetric<Real>& t, Real a, Real b) {
  return {a * t.xx + b, a * t.xy, a * t.xz, a * t.yy + b, a * t.yz, a * t.zz + b};
}

/// sum += a · v vᵀ, v = (x, y, z).
template <class Real>
SLOSH_HD void add_outer(Real a, Real x, Real y, Real z, Symmetric<Real>& sum) {
  sum.xx += a * (x * x);
  sum.xy += a * (x * y);
  sum.xz += a * (x * z);
  sum.yy += a * (y * y);
  sum.yz += a * (y * z);
  sum.zz += a * (z * z);
}

/// sum += a · t.
template <class Real>
SLOSH_HD void add_scaled(const Symmetric<Real>& t, Real a, Symmetric<Real>& sum) {
  sum.xx += a * t.xx;
  sum.xy += a * t.xy;
  sum.xz += a * t.xz;
  sum.yy += a * t.yy;
  sum.yz += a * t.yz;
  sum.zz += a * t.zz;
}

/// A tensor that need not be symmetric.
template <class Real>
struct Matrix3 {
  Vector3<Real> x, y, z;
};
template <class Real>
SLOSH_HD Vector3<Real> times(const Matrix3<Real>& t, Real x, Real y, Real z) {
  return {t.x.x * x + t.x.y * y + t.x.z * z, t.y.x * x + t.y.y * y + t.y.z * z,
          t.z.x * x + t.z.y * y + t.z.z * z};
}
template <class Real>
SLOSH_HD Vector3<Real> times(const Vector3<Real>& row, const Symmetric<Real>& t) {
  return times(t, row.x, row.y, row.z);
}
template <class Real>
SLOSH_HD Matrix3<Real> times(const Matrix3<Real>& a, const Symmetric<Real>& t) {
  return {times(a.x, t), times(a.y, t), times(a.z, t)};
}
/// t · a.
template <class Real>
SLOSH_HD Matrix3<Real> times(const Symmetric<Real>& t, const Matrix3<Real>& a) {
  const Vector3<Real> x = times(t, a.x.x, a.y.x, a.z.x), y = times(t, a.x.y, a.y.y, a.z.y),
                      z = times(t, a.x.z, a.y.z, a.z.z);  // columns
  return {{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}};
}

/// The inverse of a tensor whose determinant is not zero.
template <class Real>
SLOSH_HD Symmetric<Real> inverse(const Symmetric<Real>& t) {
  const Real f = Real(1) / determinant(t);
  return {f * (t.yy * t.zz - t.yz * t.yz), f * (t.xz * t.yz - t.xy * t.zz), f * (t.xy * t.yz - t.xz * t.yy),
          f * (t.xx * t.zz - t.xz * t.xz), f * (t.xy * t.xz - t.xx * t.yz), f * (t.xx * t.yy - t.xy * t.xy)};
}

}  // namespace slosh
