#include "sim/passes/implicit_viscosity/cpu.h"

#include <cmath>

#include "sim/cpu/state.h"

namespace slosh {

namespace {

constexpr std::size_t kParticlesPerChunk = 2048;

double total(const std::vector<double>& parts) {
  double sum = 0.0;
  for (const double part : parts) sum += part;
  return sum;
}

double dot(const Vector6& a, const Vector6& b) {
  double sum = 0.0;
  for (int i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

Vector6 times(const Matrix6& m, const Vector6& v) {
  Vector6 out{};
  for (int i = 0; i < 6; ++i) out[i] = dot(m[i], v);
  return out;
}

Vector6 vector_of(const Twist& t) {
  return {t.linear.x, t.linear.y, t.linear.z, t.angular.x, t.angular.y, t.angular.z};
}

Vector6 vector_of(const Wrench& w) {
  return {w.force.x, w.force.y, w.force.z, w.torque.x, w.torque.y, w.torque.z};
}

Twist twist_of(const Vector6& v) {
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

glm::vec3 times(const Symmetric<float>& s, const glm::vec3& v) {
  return {s.xx * v.x + s.xy * v.y + s.xz * v.z, s.xy * v.x + s.yy * v.y + s.yz * v.z,
          s.xz * v.x + s.yz * v.y + s.zz * v.z};
}

Vector4 vector4(const glm::vec3& v) {
  return {v.x, v.y, v.z, 0.0f};
}
glm::vec3 vec3(const Vector4& v) {
  return {v.x, v.y, v.z};
}
glm::vec3 vec3(const ForceSum<float>& f) {
  return {f.x, f.y, f.z};
}

}  // namespace

// The velocities of moving bodies' particles, behind the fluid's.
void ViscousSolver::carry_surface(const Work& work, std::span<const Twist> twists) {
  work.sides.moving.set_velocities(work.sides.bodies, twists);
  const BoundaryParticles& moving = work.sides.moving.sorted();
  for (std::size_t i = 0; i < work.surface; ++i)
    direction_[work.fluid + i] = {moving.vx[i], moving.vy[i], moving.vz[i], 0.0f};
}

// on_bodies_: N·s on those that move, all moving by direction_, in one fixed order, so that the sum does not
// depend on the threads.
void ViscousSolver::sum_over_bodies(const Work& work) {
  const BoundaryParticles& moving = work.sides.moving.sorted();
  on_surface_.resize(work.surface);
  work.team.run(body_rows_.chunks(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) {
      for_each_dragged_of(
          body_rows_, chunk, places_.data(), direction_.data(),
          [&](std::uint32_t i, const ForceSum<float>& drag) { on_surface_[i - work.fluid] = vec3(drag); });
    }
  });
  on_bodies_.assign(work.bodies.size(), Wrench{});
  for (std::size_t i = 0; i < work.surface; ++i) {
    const int body = moving.body[i];
    const glm::dvec3 force(on_surface_[i]);
    const glm::dvec3 arm =
        glm::dvec3(moving.x[i], moving.y[i], moving.z[i]) - work.sides.bodies[body].position;
    on_bodies_[body].force += force;
    on_bodies_[body].torque += glm::cross(arm, force);
  }
}

// The sum of f(p, N·s on p, all moving by direction_), in an order that does not depend on the threads.
template <class F>
double ViscousSolver::sum_over_dragged(const Work& work, F&& f) {
  const PairRows& rows = work.sides.drag.rows;
  parts_.assign(rows.chunks(), 0.0);
  work.team.run(rows.chunks(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) {
      double sum = 0.0;
      for_each_dragged_of(rows, chunk, places_.data(), direction_.data(),
                          [&](std::uint32_t p, const ForceSum<float>& drag) {
                            sum += static_cast<double>(f(p, vec3(drag)));
                          });
      parts_[chunk] = sum;
    }
  });
  return total(parts_);
}

// The residual of the velocities that the sub-step begins with, and everybody's own block. Returns residual ·
// product.
double ViscousSolver::begin(const Work& work) {
  FluidParticles& fluid = work.sides.fluid;
  const FluidViscosity& drag = work.sides.drag;
  change_.resize(work.fluid);
  residual_.resize(work.fluid);
  product_.resize(work.fluid);
  direction_.resize(work.fluid + work.surface + 4);
  write_body_rows(work);
  find_blocks(work);
  for (std::size_t p = 0; p < work.fluid; ++p) direction_[p] = {fluid.vx[p], fluid.vy[p], fluid.vz[p], 0.0f};
  twists_.assign(work.bodies.size(), Twist{});
  for (std::size_t b = 0; b < work.bodies.size(); ++b) twists_[b] = work.bodies[b].twist;
  carry_surface(work, twists_);
  sum_over_bodies(work);
  const glm::vec3 g = work.context.gravity;
  const double sum = sum_over_dragged(work, [&](std::uint32_t p, const glm::vec3& dragged) {
    const float mass = work.context.kinds[fluid.kind[p]].mass;
    const glm::vec3 force(fluid.fx[p], fluid.fy[p], fluid.fz[p]);
    const glm::vec3 r = work.dt * (force + mass * g) + dragged - times(drag.by_walls[p], vec3(direction_[p]));
    const glm::vec3 z = times(block_[p], r);
    residual_[p] = vector4(r);
    product_[p] = vector4(z);
    change_[p] = {};
    return glm::dot(r, z);
  });
  begin_bodies(work);
  return sum + precondition_bodies(work);
}

void ViscousSolver::begin_bodies(const Work& work) {
  const BoundaryParticles& moving = work.sides.moving.sorted();
  drags_.assign(work.bodies.size(), BodyDrag{});
  for (std::size_t i = 0; i < work.surface; ++i) {
    const Symmetric<float>& rate = rate_[i];
    drags_[moving.body[i]].add(
        {rate.xx, rate.xy, rate.xz, rate.yy, rate.yz, rate.zz},
        glm::dvec3(moving.x[i], moving.y[i], moving.z[i]) - work.sides.bodies[moving.body[i]].position);
  }
  unknowns_.assign(work.bodies.size(), Unknown{});
  for (std::size_t b = 0; b < work.bodies.size(); ++b) {
    const ViscousBody& body = work.bodies[b];
    if (!body.moves) continue;
    Unknown& u = unknowns_[b];
    const Vector6 kept = times(body.inertia, vector_of(body.twist)), drag = vector_of(on_bodies_[b]);
    Matrix6 block = drags_[b].matrix();
    for (int i = 0; i < 6; ++i) {
      u.residual[i] = body.momentum[i] - kept[i] + drag[i];
      for (int j = 0; j < 6; ++j) block[i][j] += body.inertia[i][j];
    }
    if (!cholesky(block, u.factor)) cholesky(body.inertia, u.factor);
  }
  for (BodyDrag& drag : drags_) {
    for (double& value : drag.upper) value /= work.dt;
  }
}

// A body's product = block⁻¹ residual; returns the sum of residual · product over the bodies.
double ViscousSolver::precondition_bodies(const Work& work) {
  double sum = 0.0;
  for (std::size_t b = 0; b < unknowns_.size(); ++b) {
    if (!work.bodies[b].moves) continue;
    Unknown& u = unknowns_[b];
    u.product = cholesky_solve(u.factor, u.residual);
    sum += dot(u.residual, u.product);
  }
  return sum;
}

// direction = product + keep · direction.
void ViscousSolver::follow(const Work& work, double keep) {
  const float k = static_cast<float>(keep);
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Vector4 z = product_[p], d = direction_[p];
      direction_[p] = {z.x + k * d.x, z.y + k * d.y, z.z + k * d.z, 0.0f};
    }
  });
  for (std::size_t b = 0; b < unknowns_.size(); ++b) {
    Unknown& u = unknowns_[b];
    for (int i = 0; i < 6; ++i) u.direction[i] = u.product[i] + keep * u.direction[i];
    twists_[b] = twist_of(u.direction);
  }
  carry_surface(work, twists_);
}

// product = (M + dt D) direction; returns direction · product.
double ViscousSolver::multiply(const Work& work) {
  const FluidParticles& fluid = work.sides.fluid;
  const FluidViscosity& drag = work.sides.drag;
  double sum = sum_over_dragged(work, [&](std::uint32_t p, const glm::vec3& dragged) {
    const float mass = work.context.kinds[fluid.kind[p]].mass;
    const glm::vec3 d = vec3(direction_[p]);
    const glm::vec3 q = mass * d + times(drag.by_walls[p], d) - dragged;
    product_[p] = vector4(q);
    return glm::dot(d, q);
  });
  sum_over_bodies(work);
  for (std::size_t b = 0; b < unknowns_.size(); ++b) {
    if (!work.bodies[b].moves) continue;
    Unknown& u = unknowns_[b];
    const Vector6 on_body = vector_of(on_bodies_[b]);
    u.product = times(work.bodies[b].inertia, u.direction);
    for (int i = 0; i < 6; ++i) u.product[i] -= on_body[i];
    sum += dot(u.direction, u.product);
  }
  return sum;
}

// One iteration's step along the direction, and the residual made ready for the next.
ViscousSolver::Sums ViscousSolver::advance(const Work& work, double length) {
  const FluidParticles& fluid = work.sides.fluid;
  const float a = static_cast<float>(length);
  sums_.assign(chunk_count(work.fluid, kParticlesPerChunk), Sums{});
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    Sums sums;
    for (std::size_t p = begin; p < end; ++p) {
      const float mass = work.context.kinds[fluid.kind[p]].mass;
      const glm::vec3 u = vec3(change_[p]) + a * vec3(direction_[p]);
      const glm::vec3 r = vec3(residual_[p]) - a * vec3(product_[p]);
      const glm::vec3 z = times(block_[p], r);
      change_[p] = vector4(u);
      residual_[p] = vector4(r);
      product_[p] = vector4(z);
      sums.left += static_cast<double>(glm::dot(r, r) / mass);
      sums.changed += static_cast<double>(mass * glm::dot(u, u));
      sums.step += static_cast<double>(glm::dot(r, z));
    }
    sums_[begin / kParticlesPerChunk] = sums;
  });
  for (Unknown& u : unknowns_) {
    for (int i = 0; i < 6; ++i) {
      u.change[i] += length * u.direction[i];
      u.residual[i] -= length * u.product[i];
    }
  }
  Sums all;
  for (const Sums& part : sums_) {
    all.left += part.left;
    all.changed += part.changed;
    all.step += part.step;
  }
  all.step += precondition_bodies(work);
  return all;
}

// What is left over goes to each by its mass, so that the pair keeps its momentum.
void ViscousSolver::finish(const Work& work, std::span<Wrench> wrenches) {
  FluidParticles& fluid = work.sides.fluid;
  const glm::vec3 g = work.context.gravity;
  const float per_step = 1.0f / work.dt;
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const float mass = work.context.kinds[fluid.kind[p]].mass;
      const glm::vec3 force = per_step * (mass * vec3(change_[p]) + vec3(residual_[p])) - mass * g;
      fluid.fx[p] = force.x;
      fluid.fy[p] = force.y;
      fluid.fz[p] = force.z;
    }
  });
  for (std::size_t b = 0; b < unknowns_.size(); ++b) {
    const ViscousBody& body = work.bodies[b];
    if (!body.moves) continue;
    Vector6 end = vector_of(body.twist);
    for (int i = 0; i < 6; ++i) end[i] += unknowns_[b].change[i];
    Vector6 drag = times(body.inertia, end);
    for (int i = 0; i < 6; ++i) drag[i] = (drag[i] + unknowns_[b].residual[i] - body.momentum[i]) / work.dt;
    const Twist pair = twist_of(drag);
    wrenches[b].force += pair.linear;
    wrenches[b].torque += pair.angular;
  }
  add_fixed(work, wrenches);
}

ViscousReport ViscousSolver::solve(const PassContext& context, ThreadTeam& team, const DragSides& sides,
                                   double dt, std::span<const ViscousBody> bodies,
                                   const std::vector<char>& measured, std::span<Wrench> wrenches) {
  const Work work{context,
                  team,
                  sides,
                  static_cast<float>(dt),
                  bodies,
                  measured,
                  sides.fluid.index.particles(),
                  sides.moving.sorted().index.particles()};
  double now = begin(work);
  double mass = 0.0;
  for (std::size_t p = 0; p < work.fluid; ++p) mass += context.kinds[sides.fluid.kind[p]].mass;
  const double floor = kViscousFloor * glm::length(context.gravity) * dt;
  ViscousReport report;
  report.converged = false;
  double before = 0.0;
  while (report.iterations < kMaxViscosityIterations) {
    if (!(now > 0.0)) {
      report.converged = now == 0.0;
      break;
    }
    follow(work, before > 0.0 ? now / before : 0.0);
    before = now;
    const double curvature = multiply(work);
    if (!(curvature > 0.0)) break;
    const Sums sums = advance(work, now / curvature);
    ++report.iterations;
    if (sums.left <= kViscousTolerance * kViscousTolerance * sums.changed + floor * floor * mass) {
      report.converged = true;
      break;
    }
    now = sums.step;
  }
  finish(work, wrenches);
  return report;
}

namespace passes {

void implicit_viscosity_on_cpu(CpuState& s, const PassInputs& in) {
  auto& solver = s.memory<ViscousSolver>(PassId::kImplicitViscosity);
  const ViscousReport report = solver.solve(
      s.context, s.team,
      {s.fluid, s.fixed.sorted(), s.moving, s.bodies, s.memory<FluidViscosity>(PassId::kPressureForce)},
      in.dt, in.bodies, s.wanted, in.wrenches);
  s.drags = solver.drags();
  if (!report.converged) s.context.status.fetch_or(kStatusViscosityCut, std::memory_order_relaxed);
}

}  // namespace passes

}  // namespace slosh
