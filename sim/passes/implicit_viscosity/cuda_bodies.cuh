// The bodies' share of an iteration of conjugate gradients: one block sums what was found for a body's
// particles, its first thread does the body's 6×6 in double.
#pragma once

#include "sim/cuda/solve_sums.cuh"
#include "sim/passes/implicit_viscosity/cuda_kernels.h"

namespace slosh::cuda {

/// What the parts of an iteration need beside the view.
struct Solve {
  StepConstants c;
  const ParticleKind* kinds;
  float first_viscosity;
  float dt;
  SortedFluid fluid;
  SortedSurface moving;
  LocalSurface local;
  ViscousView view;
};

/// The velocity of a body's particle by its body's twist.
__device__ inline float4 carried(const Solve& s, std::uint32_t i, const Vector6& twist) {
  const float4 x = s.moving.x[i];
  const glm::vec3 arm = glm::vec3(x.x, x.y, x.z) - glm::vec3(s.view.body[s.moving.body[i]].center);
  const glm::vec3 linear(static_cast<float>(twist[0]), static_cast<float>(twist[1]),
                         static_cast<float>(twist[2]));
  const glm::vec3 angular(static_cast<float>(twist[3]), static_cast<float>(twist[4]),
                          static_cast<float>(twist[5]));
  const glm::vec3 v = linear + glm::cross(angular, arm);
  return make_float4(v.x, v.y, v.z, 0.0f);
}

/// Calls f(b, on_body) for each moving body that is this block's, in its first thread: N·s and N·m·s on it by
/// what was found for its particles.
template <class F>
__device__ inline void for_each_body(const Solve& s, F&& f) {
  for (std::uint32_t b = blockIdx.x; b < s.view.bodies; b += gridDim.x) {
    const DeviceViscousBody& body = s.view.body[b];
    if (!body.body.moves) continue;
    double sum[6] = {};
    for (std::uint32_t i = body.begin + threadIdx.x; i < body.end; i += kSolveThreads) {
      const float4 force = s.view.on_surface[i];
      const float4 x = s.local.placed[i];
      const glm::dvec3 part(force.x, force.y, force.z);
      const glm::dvec3 torque = glm::cross(glm::dvec3(x.x, x.y, x.z) - body.center, part);
      for (int k = 0; k < 3; ++k) {
        sum[k] += part[k];
        sum[3 + k] += torque[k];
      }
    }
    sum_block(sum);
    if (threadIdx.x == 0) f(b, Vector6{sum[0], sum[1], sum[2], sum[3], sum[4], sum[5]});
  }
}

/// Calls f(b) in one thread for each moving body that is this block's.
template <class F>
__device__ inline void by_first_thread(const ViscousView& view, F&& f) {
  if (threadIdx.x != 0) return;
  for (std::uint32_t b = blockIdx.x; b < view.bodies; b += gridDim.x) {
    if (view.body[b].body.moves) f(b);
  }
}

__device__ __noinline__ inline void start_body(const Solve& s, std::uint32_t b, const Vector6& on_body) {
  const DeviceViscousBody& given = s.view.body[b];
  ViscousUnknown& u = s.view.unknown[b];
  const Vector6 kept = times(given.body.inertia, vector_of(given.body.twist));
  Matrix6 block{};
  if (given.drag >= 0) block = s.view.drags[given.drag].matrix();
  for (int i = 0; i < 6; ++i) {
    u.residual[i] = given.body.momentum[i] - kept[i] + on_body[i];
    u.change[i] = 0.0;
    u.direction[0][i] = u.direction[1][i] = 0.0;
    for (int j = 0; j < 6; ++j)
      block[i][j] = given.body.inertia[i][j] + static_cast<double>(s.dt) * block[i][j];
  }
  if (!cholesky(block, u.factor)) cholesky(given.body.inertia, u.factor);
  u.product = cholesky_solve(u.factor, u.residual);
  s.view.parts.body_step[b] = dot(u.residual, u.product);
}

__device__ __noinline__ inline void multiply_body(const Solve& s, std::uint32_t b, const Vector6& on_body,
                                                  int now) {
  ViscousUnknown& u = s.view.unknown[b];
  u.product = times(s.view.body[b].body.inertia, u.direction[now]);
  for (int i = 0; i < 6; ++i) u.product[i] -= on_body[i];
  s.view.parts.body_curvature[b] = dot(u.direction[now], u.product);
}

__device__ __noinline__ inline void advance_body(const Solve& s, std::uint32_t b, double length, int now) {
  ViscousUnknown& u = s.view.unknown[b];
  for (int i = 0; i < 6; ++i) {
    u.change[i] += length * u.direction[now][i];
    u.residual[i] -= length * u.product[i];
  }
  u.product = cholesky_solve(u.factor, u.residual);
  s.view.parts.body_step[b] = dot(u.residual, u.product);
}

__device__ __noinline__ inline void finish_body(const Solve& s, std::uint32_t b) {
  const ViscousBody& given = s.view.body[b].body;
  Vector6 end = vector_of(given.twist);
  for (int i = 0; i < 6; ++i) end[i] += s.view.unknown[b].change[i];
  Vector6 drag = times(given.inertia, end);
  for (int i = 0; i < 6; ++i)
    drag[i] = (drag[i] + s.view.unknown[b].residual[i] - given.momentum[i]) / static_cast<double>(s.dt);
  s.view.wrenches[b] = {{drag[0], drag[1], drag[2]}, {drag[3], drag[4], drag[5]}};
}

}  // namespace slosh::cuda
