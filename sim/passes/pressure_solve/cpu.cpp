#include "sim/passes/pressure_solve/cpu.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "sim/cpu/state.h"
#include "sim/model.h"
#include "sim/step_limits.h"

namespace slosh {

namespace {

constexpr std::size_t kParticlesPerChunk = 2048;
// Pressures that are cut off below 0 are put right when they come to more than this share of what is left.
constexpr double kMaxClipped = 0.02;

double dot(const Vector6& a, const Vector6& b) {
  double sum = 0.0;
  for (int i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

Four four_at(const Vector4& v) {
  return slosh::four_at(&v.x);
}

}  // namespace

// f(p, N on p by the direction, as pressures).
template <class F>
void PressureSolver::for_each_pushed(const Work& work, F&& f) const {
  const FluidPress& press = work.sides.press;
  work.team.run(press.rows.chunks(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) {
      press.rows.for_each_group(chunk, [&](const PairRows::Walk& walk) {
        float by_others[16];
        const Sixteen pushed = walk.push(press.places.data(), pressing_.data());
        std::memcpy(by_others, &pushed, sizeof pushed);
        for (std::uint32_t a = 0; a < walk.count; ++a) {
          const std::uint32_t p = walk.first + a;
          f(p, direction_[p] * four_at(press.own[p]) + slosh::four_at(by_others + 4 * a));
        }
      });
    }
  });
}

// The sum of f(p, m³/s that velocity_ is as a flow out of p, without bodies), in an order that does not
// depend on the threads.
template <class F>
double PressureSolver::sum_over_flows(const Work& work, F&& f) {
  const FluidPress& press = work.sides.press;
  parts_.assign(press.rows.chunks(), 0.0);
  work.team.run(press.rows.chunks(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) {
      double sum = 0.0;
      press.rows.for_each_group(chunk, [&](const PairRows::Walk& walk) {
        Sixteen parts =
            walk.of_group<4>(&press.own[walk.first].x) * walk.of_group<4>(&velocity_[walk.first].x);
        parts -= walk.flow(press.places.data(), press.tensors.data(), velocity_.data());
        float of[16];
        std::memcpy(of, &parts, sizeof parts);
        for (std::uint32_t a = 0; a < walk.count; ++a)
          sum += f(walk.first + a, (of[4 * a] + of[4 * a + 1]) + of[4 * a + 2]);
      });
      parts_[chunk] = sum;
    }
  });
  double sum = 0.0;
  for (const double part : parts_) sum += part;
  return sum;
}

void PressureSolver::begin_bodies(const Work& work) {
  factors_.assign(work.bodies.size(), Matrix6{});
  twists_.assign(work.bodies.size(), Vector6{});
  for (std::size_t b = 0; b < work.bodies.size(); ++b) {
    const ViscousBody& body = work.bodies[b];
    if (body.moves && cholesky(body.inertia, factors_[b]))
      twists_[b] = cholesky_solve(factors_[b], body.momentum);
  }
}

// The flows that there would be by the last step's pressures, and the system's diagonal.
void PressureSolver::begin(const Work& work) {
  FluidParticles& fluid = work.sides.fluid;
  for (std::vector<float>* column : {&flow_, &inverse_, &pressure_, &residual_, &product_, &clipped_})
    column->resize(work.fluid);
  direction_.resize(work.fluid);
  pressing_.resize(work.fluid + 4);
  velocity_.resize(work.fluid + 4);
  find_touches(work);
  begin_bodies(work);
  const glm::vec3 g = work.context.gravity;
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const ParticleKind& kind = work.context.kinds[fluid.kind[p]];
      const glm::vec3 v(fluid.vx[p], fluid.vy[p], fluid.vz[p]);
      const float per_mass = kind.probe ? 0.0f : 1.0f / kind.mass;
      const glm::vec3 force = glm::vec3(fluid.fx[p], fluid.fy[p], fluid.fz[p]);
      const glm::vec3 then = kind.probe ? v : v + work.dt * (per_mass * force + g);
      velocity_[p] = {then.x, then.y, then.z, per_mass};
    }
  });
  const double gravity = glm::length(work.context.gravity);
  const float wanted =
      work.context.rest_volume / static_cast<float>(density_time(work.context.plan, gravity, work.dt));
  find_diagonal(work);
  sum_over_flows(work, [&](std::uint32_t p, double flow) {
    double diagonal = inverse_[p];
    for (std::uint32_t t = first_touch_[p]; t < first_touch_[p + 1]; ++t) {
      const Touch& touch = touches_[t];
      if (!work.bodies[touch.body].moves) continue;
      flow += dot(touch.push, twists_[touch.body]);
      diagonal += work.dt * dot(touch.push, cholesky_solve(factors_[touch.body], touch.push));
    }
    flow_[p] = static_cast<float>(flow) - wanted * fluid.pressure[p];
    inverse_[p] = diagonal > 0.0 ? static_cast<float>(1.0 / diagonal) : 0.0f;
    pressure_[p] = diagonal > 0.0 ? fluid.solved[p] : 0.0f;
    clipped_[p] = 0.0f;
    return 0.0;
  });
}

// inverse_ gets the system's diagonal itself, without bodies.
void PressureSolver::find_diagonal(const Work& work) {
  const FluidPress& press = work.sides.press;
  work.team.run(press.rows.chunks(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) {
      press.rows.for_each_group(chunk, [&](const PairRows::Walk& walk) {
        const PairRows::Walk::SumOfSquares sums = walk.squares(press.places.data(), velocity_.data());
        float even[16], odd[16];
        std::memcpy(even, &sums.even, sizeof even);
        std::memcpy(odd, &sums.odd, sizeof odd);
        for (std::uint32_t a = 0; a < walk.count; ++a) {
          const std::uint32_t p = walk.first + a;
          const float *e = even + 4 * a, *o = odd + 4 * a;
          // The sum over the pairs of (K g)² over each other's mass.
          const auto by = [&](float x, float y, float z) {
            return (x * x * e[0] + y * y * e[1] + z * z * e[2]) +
                   2.0f * (x * y * o[0] + y * z * o[1] + x * z * o[2]);
          };
          const PressureTensor& k = press.tensors[p];
          const Four own = four_at(press.own[p]), squared = own * own;
          inverse_[p] = work.dt * (((squared[0] + squared[1]) + squared[2]) * velocity_[p].w +
                                   (by(k.xx, k.xy, k.xz) + by(k.xy, k.yy, k.yz) + by(k.xz, k.yz, k.zz)));
        }
      });
    }
  });
}

PressureSolver::Sums PressureSolver::total() const {
  Sums all;
  for (const Sums& part : sums_) {
    all.left += part.left;
    all.step += part.step;
    all.turned += part.turned;
    all.clipped += part.clipped;
    all.squares += part.squares;
    all.pressing += part.pressing;
  }
  return all;
}

// What is left, of those that press or are pushed together.
PressureSolver::Sums PressureSolver::look(const Work& work) {
  sums_.assign(chunk_count(work.fluid, kParticlesPerChunk), Sums{});
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    Sums sums;
    for (std::size_t p = begin; p < end; ++p) {
      const bool presses = pressure_[p] > 0.0f || flow_[p] < 0.0f;
      const float r = presses ? -flow_[p] : 0.0f;
      residual_[p] = r;
      sums.step += static_cast<double>(inverse_[p] * r * r);
      sums.squares += static_cast<double>(r) * r;
      sums.pressing += presses;
    }
    sums_[begin / kParticlesPerChunk] = sums;
  });
  return total();
}

// The direction of p, Pa.
void PressureSolver::press(const Work& work, std::size_t p, float pressure) {
  direction_[p] = pressure;
  Eight tensor;
  std::memcpy(&tensor, &work.sides.press.tensors[p], sizeof tensor);
  tensor *= pressure;
  std::memcpy(&pressing_[p], &tensor, sizeof tensor);
}

// direction = preconditioned residual + keep · direction, of those that press.
void PressureSolver::follow(const Work& work, double keep) {
  const float k = static_cast<float>(keep);
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const bool presses = pressure_[p] > 0.0f || flow_[p] < 0.0f;
      const float before = k > 0.0f ? k * direction_[p] : 0.0f;
      press(work, p, presses ? inverse_[p] * residual_[p] + before : 0.0f);
    }
  });
}

// velocity and twists: what the direction, as pressures, changes them by over the sub-step.
void PressureSolver::push(const Work& work) {
  for_each_pushed(work, [&](std::uint32_t p, Four force) {
    const float per_mass = velocity_[p].w;
    const Four change = work.dt * per_mass * force;
    velocity_[p] = {change[0], change[1], change[2], per_mass};
  });
  for (Vector6& twist : twists_) twist = {};
  for (const Touch& touch : touches_) {
    const double pressure = work.dt * static_cast<double>(direction_[touch.particle]);
    for (int i = 0; i < 6; ++i) twists_[touch.body][i] += pressure * touch.push[i];
  }
  for (std::size_t b = 0; b < twists_.size(); ++b)
    twists_[b] = work.bodies[b].moves ? cholesky_solve(factors_[b], twists_[b]) : Vector6{};
}

// product = system · direction, after push(); returns direction · product.
double PressureSolver::multiply(const Work& work) {
  return sum_over_flows(work, [&](std::uint32_t p, float flow) {
    for (std::uint32_t t = first_touch_[p]; t < first_touch_[p + 1]; ++t)
      flow += static_cast<float>(dot(touches_[t].push, twists_[touches_[t].body]));
    product_[p] = flow;
    return static_cast<double>(direction_[p]) * flow;
  });
}

// One iteration's step along the direction, no pressure below 0, and the residual.
PressureSolver::Sums PressureSolver::advance(const Work& work, double length) {
  const float a = static_cast<float>(length);
  sums_.assign(chunk_count(work.fluid, kParticlesPerChunk), Sums{});
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    Sums sums;
    for (std::size_t p = begin; p < end; ++p) {
      const float to = pressure_[p] + a * direction_[p];
      pressure_[p] = to > 0.0f ? to : 0.0f;
      clipped_[p] += pressure_[p] - to;
      flow_[p] += a * product_[p];
      const bool presses = pressure_[p] > 0.0f || flow_[p] < 0.0f;
      const float r = presses ? -flow_[p] : 0.0f;
      const float z = inverse_[p] * r;
      sums.step += static_cast<double>(z) * r;
      sums.turned += static_cast<double>(z) * residual_[p];
      sums.squares += static_cast<double>(r) * r;
      sums.pressing += presses;
      if (clipped_[p] > 0.0f) sums.clipped += static_cast<double>(clipped_[p]) * clipped_[p] / inverse_[p];
      residual_[p] = r;
    }
    sums_[begin / kParticlesPerChunk] = sums;
  });
  return total();
}

// The flows get to know of what was cut off.
void PressureSolver::undo_clips(const Work& work) {
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) press(work, p, clipped_[p]);
  });
  push(work);
  multiply(work);
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      flow_[p] += product_[p];
      clipped_[p] = 0.0f;
    }
  });
}

// The direction, as pressures, on the fluid.
void PressureSolver::add_forces(const Work& work) {
  FluidParticles& fluid = work.sides.fluid;
  for_each_pushed(work, [&](std::uint32_t p, Four force) {
    fluid.fx[p] += force[0];
    fluid.fy[p] += force[1];
    fluid.fz[p] += force[2];
  });
}

void PressureSolver::finish(const Work& work, std::span<Wrench> wrenches) {
  FluidParticles& fluid = work.sides.fluid;
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) press(work, p, pressure_[p] - fluid.solved[p]);
  });
  add_forces(work);
  for (const Touch& touch : touches_) {
    const double pressure = static_cast<double>(pressure_[touch.particle]) - fluid.solved[touch.particle];
    Wrench& wrench = wrenches[touch.body];
    for (int i = 0; i < 3; ++i) {
      wrench.force[i] += pressure * touch.push[i];
      wrench.torque[i] += pressure * touch.push[i + 3];
    }
  }
  std::copy(pressure_.begin(), pressure_.end(), fluid.solved.begin());
}

void PressureSolver::push_by_last(const PassContext& context, ThreadTeam& team, const PressedSides& sides) {
  const Work work{context, team, sides, 0.0f, {}, sides.fluid.index.particles()};
  direction_.resize(work.fluid);
  pressing_.resize(work.fluid + 4);
  team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) press(work, p, sides.fluid.solved[p]);
  });
  add_forces(work);
}

PressureReport PressureSolver::solve(const PassContext& context, ThreadTeam& team, const PressedSides& sides,
                                     double dt, std::span<const ViscousBody> bodies,
                                     std::span<Wrench> wrenches) {
  const Work work{context, team, sides, static_cast<float>(dt), bodies, sides.fluid.index.particles()};
  begin(work);
  Sums sums = look(work);
  const double per_flow = dt / context.rest_volume;
  const auto left = [&] { return per_flow * std::sqrt(sums.squares / std::max(sums.pressing, 1.0)); };
  const double enough = std::max(kPressureFloor, kPressureTolerance * left());
  PressureReport report;
  double keep = 0.0;
  while (report.iterations < kMaxPressureIterations && sums.step > 0.0 && left() > enough) {
    const double before = sums.step;
    follow(work, keep);
    push(work);
    const double curvature = multiply(work);
    ++report.iterations;
    if (!(curvature > 0.0)) break;
    sums = advance(work, before / curvature);
    keep = std::max(0.0, (sums.step - sums.turned) / before);
    if (sums.clipped > kMaxClipped * sums.step && report.iterations + 1 < kMaxPressureIterations) {
      undo_clips(work);
      ++report.iterations;
      sums = look(work);
      keep = 0.0;
    }
  }
  report.left = left();
  finish(work, wrenches);
  return report;
}

namespace passes {

void pressure_solve_on_cpu(CpuState& s, const PassInputs& in) {
  s.memory<PressureSolver>(PassId::kPressureSolve)
      .solve(s.context, s.team, {s.fluid, s.moving.sorted(), s.bodies, s.pairs}, in.dt, in.bodies,
             in.wrenches);
  if (s.fixed_measured) s.sum_wrenches(s.fixed, in.wrenches, {});
  s.carry_probe_forces_out(in.wrenches);
}

}  // namespace passes

}  // namespace slosh
