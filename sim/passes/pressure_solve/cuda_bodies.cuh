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

/// Calls f(j, push) for the entries of a thread's row, `entries` of PressRows: four at a time, the next eight
/// of which are on their way.
template <class F>
__device__ inline void for_each_entry(const PressRows& rows, const uint4* entries, std::uint32_t thread,
                                      const uint2& head, F&& f) {
  const uint4* at = entries + rows.at(thread);
  std::uint32_t j = head.x;
  // Every row has room for eight: nobody waits for the head to read these.
  uint4 next[2] = {__ldcs(at), __ldcs(at + 32)}, after[2] = {__ldcs(at + 64), __ldcs(at + 96)};
#pragma unroll 1
  for (std::uint32_t k = 0; k < head.y; k += kListed) {
    const uint4 two[2] = {next[0], next[1]};
    const bool more = k + 2 * kListed < head.y;
    at += 64;
    for (std::uint32_t i = 0; i < 2; ++i) {
      next[i] = after[i];
      if (more) after[i] = __ldcs(at + 64 + 32 * i);
    }
    for (const uint4& e : two) {
      j += e.y >> 16;
      f(j, push_in(e.x, e.y));
      j += e.w >> 16;
      f(j, push_in(e.z, e.w));
    }
  }
}

/// The pressure, times its unit, that a direction of which so much is kept gives.
__device__ inline float pressing(const float2& j, float keep) {
  return j.x + keep * j.y;
}

/// For those who have more pairs than there is room for.
template <class Team>
__device__ __noinline__ float3 walked_push(const Press& s, std::uint32_t p, float keep) {
  float3 sum = make_float3(0.0f, 0.0f, 0.0f);
  for_each_walked<Team>(s.c, s.fluid, p, [&](std::uint32_t j, const PressPair& pair) {
    add(pair.by_other, pressing(s.view.pressing[j], keep), sum);
  });
  return sum;
}

/// N on a fluid particle by the direction, as pressures, in the team's threads. `own`: PressureView::own.
template <class Team>
__device__ inline float3 push_on_fluid(const Press& s, std::uint32_t thread, const float4& own, float keep) {
  const PressureView& view = s.view;
  const std::uint32_t p = thread / Team::kLanes;
  const uint2 head = view.rows.heads[thread];
  float3 sum = make_float3(0.0f, 0.0f, 0.0f);
  if (head.y > view.rows.room) {
    sum = walked_push<Team>(s, p, keep);
  } else {
    for_each_entry(view.rows, view.rows.by_other, thread, head, [&](std::uint32_t j, const float3& by_other) {
      add(by_other, pressing(view.pressing[j], keep), sum);
    });
  }
  Team::sum(sum.x, sum.y, sum.z);
  add(vec3(own), pressing(view.pressing[p], keep), sum);
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

/// The same on a body's particle i, to view.on_surface and view.turning.
__device__ __noinline__ inline void push_on_surface(const Press& s, std::uint32_t i, float keep) {
  const PressureView& view = s.view;
  const float4 x = s.moving.x[i];
  float3 force = make_float3(0.0f, 0.0f, 0.0f), couple = force;
  const auto take = [&](std::uint32_t j, const float3& by_own) {
    const float pressure = pressing(view.pressing[j], keep);
    const float3 f = make_float3(pressure * by_own.x, pressure * by_own.y, pressure * by_own.z);
    add(f, 1.0f, force);
    add(cross(beyond(s.c, x, s.fluid.pressed[j]), f), 1.0f, couple);
  };
  const std::uint32_t count = view.presses.counts[i];
  if (count > view.presses.room) {
    for_each_walked_press(s.c, s.fluid, s.moving, i, take);
  } else {
    for (std::uint32_t k = 0; k < count; ++k) {
      const float4 pair = view.presses.pairs[view.presses.at(i, k)];
      take(__float_as_uint(pair.w), vec3(pair));
    }
  }
  const std::uint32_t at = s.moving.order[i];
  view.on_surface[at] = make_float4(force.x, force.y, force.z, 0.0f);
  view.turning[at] = make_float4(couple.x, couple.y, couple.z, 0.0f);
}

/// Calls f(i, on_fluid) for the thread's share of the pairs of fluid particle p with the particles of bodies
/// that may move.
template <class Team, class F>
__device__ inline void for_each_touch(const Press& s, std::uint32_t p, F&& f) {
  const PairRows& touches = s.view.touches;
  const std::uint32_t count = touches.counts[p];
  if (count > touches.room) return for_each_walked_touch<Team>(s.c, s.fluid, s.moving, p, f);
  for (std::uint32_t k = Team::lane(); k < count; k += Team::kLanes) {
    const float4 pair = touches.pairs[touches.at(p, k)];
    f(__float_as_uint(pair.w), vec3(pair));
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

/// For those who have more pairs than there is room for.
template <class Team>
__device__ __noinline__ float walked_flow(const Press& s, std::uint32_t p) {
  float flow = 0.0f;
  for_each_walked<Team>(s.c, s.fluid, p, [&](std::uint32_t j, const PressPair& pair) {
    flow -= dot(pair.by_own, vec3(s.view.velocity[j]));
  });
  return flow;
}

/// m³/s: the flow out of a fluid particle by the bodies' twists, in the team's threads.
template <class Team>
__device__ __noinline__ float flow_by_bodies(const Press& s, std::uint32_t p) {
  double flow = 0.0;
  for_each_touch<Team>(s, p, [&](std::uint32_t i, const float3& on_fluid) {
    flow += dot(touch(s, p, i, on_fluid), s.view.unknown[s.moving.body[i]].twist);
  });
  Team::sum(flow);
  return static_cast<float>(flow);
}

/// m³/s: the flow out of a fluid particle that there is by `velocity` and the bodies' twists, in the team's
/// threads.
template <class Team>
__device__ inline float flow_of(const Press& s, std::uint32_t thread) {
  const PressureView& view = s.view;
  const std::uint32_t p = thread / Team::kLanes;
  const uint2 head = view.rows.heads[thread];
  float flow = 0.0f;
  if (head.y > view.rows.room) {
    flow = walked_flow<Team>(s, p);
  } else {
    for_each_entry(view.rows, view.rows.by_own, thread, head, [&](std::uint32_t j, const float3& by_own) {
      flow -= dot(by_own, vec3(view.velocity[j]));
    });
  }
  Team::sum(flow);
  const float4 own = view.own[p];
  flow = own.w * (flow + dot(vec3(own), vec3(view.velocity[p])));
  return view.bodies == 0 ? flow : flow + flow_by_bodies<Team>(s, p);
}

/// What the bodies around p add to the system's diagonal, without dt: the pairs with one body together.
__device__ __noinline__ inline double diagonal_by_bodies(const Press& s, std::uint32_t p) {
  const PressureView& view = s.view;
  double sum = 0.0;
  for (std::int64_t last = -1;;) {
    std::int64_t body = view.bodies;
    for_each_touch<Alone>(s, p, [&](std::uint32_t i, const float3&) {
      const std::int64_t b = s.moving.body[i];
      if (b > last && b < body) body = b;
    });
    if (body == view.bodies) return sum;
    last = body;
    if (!view.body[body].body.moves) continue;
    Vector6 push{};
    for_each_touch<Alone>(s, p, [&](std::uint32_t i, const float3& on_fluid) {
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
