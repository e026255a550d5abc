// What an iteration of the pressure projection needs of the pairs, and the bodies' share of it: one block
// sums what was found for a body's particles, its first thread does the body's 6×6 in double.
#pragma once

#include "sim/cuda/solve_sums.cuh"
#include "sim/passes/pressure_solve/cuda_pairs.cuh"

namespace slosh::cuda {

/// What the parts of an iteration need beside the view.
struct Press {
  StepConstants c;
  const ParticleKind* kinds;
  float dt;
  float density_time;
  SortedFluid fluid;
  SortedSurface moving;
  LocalSurface local;
  PressureView view;
};

__device__ inline void add(const float3& v, float by, float3& sum) {
  sum.x += by * v.x;
  sum.y += by * v.y;
  sum.z += by * v.z;
}

/// N on a fluid particle by the direction, as pressures.
__device__ inline float3 push_on_fluid(const Press& s, std::uint32_t p) {
  const PressureView& view = s.view;
  float3 sum = make_float3(0.0f, 0.0f, 0.0f);
  add(vec3(view.own[p]), view.direction[p], sum);
  if (view.rows.counts[p] > view.rows.room) {
    for_each_press(s.c, s.fluid, s.moving, p, [&](std::uint32_t j, const float3&, const float3& by_other) {
      if (j < view.fluid) add(by_other, view.direction[j], sum);
    });
    return sum;
  }
  const float4* pairs = view.by_other + view.rows.at(p, 0);
  const std::uint32_t count = view.with_fluid[p];
#pragma unroll 4
  for (std::uint32_t k = 0; k < count; ++k) {
    const float4 pair = __ldcs(pairs + std::size_t{32} * k);
    add(vec3(pair), view.direction[__float_as_uint(pair.w)], sum);
  }
  return sum;
}

/// From a body's particle at x to where its share of a fluid particle's push acts: what is beyond the
/// moment's layer has its reaction where the fluid is (passes/pressure_force/pair_force.h).
__device__ inline float3 beyond(const StepConstants& c, const float4& x, const float4& fluid) {
  const float share = 1.0f - c.correction.wall_layer;
  return make_float3(share * (fluid.x - x.x), share * (fluid.y - x.y), share * (fluid.z - x.z));
}

__device__ inline float3 cross(const float3& a, const float3& b) {
  return make_float3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

/// The same on a particle of a body, to view.on_surface and view.turning.
__device__ inline void push_on_surface(const Press& s, std::uint32_t e) {
  const PressureView& view = s.view;
  const std::uint32_t i = e - view.fluid;
  const float4 x = s.moving.x[i];
  float3 force = make_float3(0.0f, 0.0f, 0.0f), couple = force;
  const auto take = [&](std::uint32_t j, const float3& by_own) {
    const float pressure = view.direction[j];
    const float3 f = make_float3(pressure * by_own.x, pressure * by_own.y, pressure * by_own.z);
    add(f, 1.0f, force);
    add(cross(beyond(s.c, x, s.fluid.pressed[j]), f), 1.0f, couple);
  };
  const std::uint32_t count = view.rows.counts[e];
  if (count > view.rows.room) {
    for_each_press(s.c, s.fluid, s.moving, e,
                   [&](std::uint32_t j, const float3& by_own, const float3&) { take(j, by_own); });
  } else {
    for (std::uint32_t k = 0; k < count; ++k) {
      const float4 pair = view.rows.pairs[view.rows.at(e, k)];
      take(__float_as_uint(pair.w), vec3(pair));
    }
  }
  const std::uint32_t at = s.moving.order[i];
  view.on_surface[at] = make_float4(force.x, force.y, force.z, 0.0f);
  view.turning[at] = make_float4(couple.x, couple.y, couple.z, 0.0f);
}

/// Calls f(i, on_fluid) for the pairs of fluid particle p with the particles of bodies that may move.
template <class F>
__device__ inline void for_each_touch(const Press& s, std::uint32_t p, F&& f) {
  const PressureView& view = s.view;
  const std::uint32_t count = view.rows.counts[p];
  if (count > view.rows.room) {
    for_each_press(s.c, s.fluid, s.moving, p, [&](std::uint32_t j, const float3& by_own, const float3&) {
      if (j >= view.fluid) f(j - view.fluid, by_own);
    });
    return;
  }
  for (std::uint32_t k = view.with_fluid[p]; k < count; ++k) {
    const float4 pair = view.rows.pairs[view.rows.at(p, k)];
    f(__float_as_uint(pair.w) - view.fluid, vec3(pair));
  }
}

/// What 1 Pa of p puts on the body of particle i, in that pair, on its six components.
__device__ inline Vector6 touch(const Press& s, std::uint32_t p, std::uint32_t i, const float3& on_fluid) {
  const float4 x = s.moving.x[i];
  const float3 further = beyond(s.c, x, s.fluid.pressed[p]);
  const glm::dvec3 arm = glm::dvec3(x.x, x.y, x.z) - s.view.body[s.moving.body[i]].center +
                         glm::dvec3(further.x, further.y, further.z);
  const glm::dvec3 force(-on_fluid.x, -on_fluid.y, -on_fluid.z);
  const glm::dvec3 torque = glm::cross(arm, force);
  return {force.x, force.y, force.z, torque.x, torque.y, torque.z};
}

/// m³/s: the flow out of fluid particle p that there is by `velocity` and the bodies' twists.
__device__ inline float flow_of(const Press& s, std::uint32_t p) {
  const PressureView& view = s.view;
  float flow = dot(vec3(view.own[p]), vec3(view.velocity[p]));
  if (view.rows.counts[p] > view.rows.room) {
    for_each_press(s.c, s.fluid, s.moving, p, [&](std::uint32_t j, const float3& by_own, const float3&) {
      if (j < view.fluid) flow -= dot(by_own, vec3(view.velocity[j]));
    });
  } else {
    const float4* pairs = view.rows.pairs + view.rows.at(p, 0);
    const std::uint32_t count = view.with_fluid[p];
#pragma unroll 4
    for (std::uint32_t k = 0; k < count; ++k) {
      const float4 pair = __ldcs(pairs + std::size_t{32} * k);
      flow -= dot(vec3(pair), vec3(view.velocity[__float_as_uint(pair.w)]));
    }
  }
  if (view.bodies == 0) return flow;
  double by_bodies = 0.0;
  for_each_touch(s, p, [&](std::uint32_t i, const float3& on_fluid) {
    by_bodies += dot(touch(s, p, i, on_fluid), view.unknown[s.moving.body[i]].twist);
  });
  return flow + static_cast<float>(by_bodies);
}

/// What the bodies around p add to the system's diagonal, without dt: the pairs with one body together.
__device__ __noinline__ inline double diagonal_by_bodies(const Press& s, std::uint32_t p) {
  const PressureView& view = s.view;
  double sum = 0.0;
  for (std::int64_t last = -1;;) {
    std::int64_t body = view.bodies;
    for_each_touch(s, p, [&](std::uint32_t i, const float3&) {
      const std::int64_t b = s.moving.body[i];
      if (b > last && b < body) body = b;
    });
    if (body == view.bodies) return sum;
    last = body;
    if (!view.body[body].body.moves) continue;
    Vector6 push{};
    for_each_touch(s, p, [&](std::uint32_t i, const float3& on_fluid) {
      if (s.moving.body[i] != body) return;
      const Vector6 one = touch(s, p, i, on_fluid);
      for (int k = 0; k < 6; ++k) push[k] += one[k];
    });
    sum += dot(push, cholesky_solve(view.unknown[body].factor, push));
  }
}

/// Calls f(b, on_body) for each body that is this block's, in its first thread: N and N·m on it by what was
/// found for its particles.
template <class F>
__device__ inline void for_each_pressed_body(const Press& s, F&& f) {
  for (std::uint32_t b = blockIdx.x; b < s.view.bodies; b += gridDim.x) {
    const DevicePressedBody& body = s.view.body[b];
    double sum[6] = {};
    for (std::uint32_t i = body.begin + threadIdx.x; i < body.end; i += kSolveThreads) {
      const float4 force = s.view.on_surface[i], couple = s.view.turning[i], x = s.local.placed[i];
      const glm::dvec3 part(force.x, force.y, force.z);
      const glm::dvec3 torque = glm::cross(glm::dvec3(x.x, x.y, x.z) - body.center, part) +
                                glm::dvec3(couple.x, couple.y, couple.z);
      for (int k = 0; k < 3; ++k) {
        sum[k] += part[k];
        sum[3 + k] += torque[k];
      }
    }
    sum_block(sum);
    if (threadIdx.x == 0) f(b, Vector6{sum[0], sum[1], sum[2], sum[3], sum[4], sum[5]});
  }
}

}  // namespace slosh::cuda
