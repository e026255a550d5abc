#include "sim/cpu/viscous_solve.h"

#include <cmath>

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

}  // namespace

// The velocities of moving bodies' particles, behind the fluid's.
void ViscousSolver::carry_surface(const Work& work, std::span<const Twist> twists,
                                  VectorColumns& velocities) {
  work.sides.moving.set_velocities(work.sides.bodies, twists);
  const BoundaryParticles& moving = work.sides.moving.sorted();
  std::copy_n(moving.vx.begin(), work.surface,
              velocities.x.begin() + static_cast<std::ptrdiff_t>(work.fluid));
  std::copy_n(moving.vy.begin(), work.surface,
              velocities.y.begin() + static_cast<std::ptrdiff_t>(work.fluid));
  std::copy_n(moving.vz.begin(), work.surface,
              velocities.z.begin() + static_cast<std::ptrdiff_t>(work.fluid));
}

// on_bodies_: N·s on those that move, in one fixed order, so that the sum does not depend on the threads.
void ViscousSolver::sum_over_bodies(const Work& work, const VectorColumns& velocities) {
  const BoundaryParticles& moving = work.sides.moving.sorted();
  on_surface_.resize(work.surface);
  work.team.run(work.surface, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ForceSum<float> f = body_rows_.drag_on(static_cast<std::uint32_t>(i), moving.vx[i], moving.vy[i],
                                                   moving.vz[i], velocities);
      on_surface_[i] = {f.x, f.y, f.z};
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

// The residual of the velocities that the sub-step begins with, and everybody's own block.
void ViscousSolver::begin(const Work& work) {
  FluidParticles& fluid = work.sides.fluid;
  const BoundaryParticles& moving = work.sides.moving.sorted();
  for (VectorColumns* v : {&change_, &residual_, &direction_, &product_})
    v->provide(work.fluid + work.surface);
  write_fluid_rows(work);
  write_body_rows(work);
  std::copy_n(fluid.vx.begin(), work.fluid, direction_.x.begin());
  std::copy_n(fluid.vy.begin(), work.fluid, direction_.y.begin());
  std::copy_n(fluid.vz.begin(), work.fluid, direction_.z.begin());
  twists_.assign(work.bodies.size(), Twist{});
  for (std::size_t b = 0; b < work.bodies.size(); ++b) twists_[b] = work.bodies[b].twist;
  carry_surface(work, twists_, direction_);
  sum_over_bodies(work, direction_);
  const glm::vec3 g = work.context.gravity;
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const float mass = work.context.kinds[fluid.kind[p]].mass;
      const glm::vec3 v(fluid.vx[p], fluid.vy[p], fluid.vz[p]);
      const glm::vec3 by_walls = times(by_walls_[p], v);
      const ForceSum<float> drag =
          fluid_rows_.drag_on(static_cast<std::uint32_t>(p), v.x, v.y, v.z, direction_);
      residual_.x[p] = work.dt * (fluid.fx[p] + mass * g.x) + drag.x - by_walls.x;
      residual_.y[p] = work.dt * (fluid.fy[p] + mass * g.y) + drag.y - by_walls.y;
      residual_.z[p] = work.dt * (fluid.fz[p] + mass * g.z) + drag.z - by_walls.z;
      change_.x[p] = change_.y[p] = change_.z[p] = 0.0f;
    }
  });
  for (Column<float>* column : {&direction_.x, &direction_.y, &direction_.z})
    std::fill(column->begin(), column->end(), 0.0f);

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

// product = block⁻¹ residual; returns residual · product.
double ViscousSolver::precondition(const Work& work) {
  parts_.assign(chunk_count(work.fluid, kParticlesPerChunk), 0.0);
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t p = begin; p < end; ++p) {
      const glm::vec3 r(residual_.x[p], residual_.y[p], residual_.z[p]);
      const glm::vec3 z = times(block_[p], r);
      product_.x[p] = z.x;
      product_.y[p] = z.y;
      product_.z[p] = z.z;
      sum += static_cast<double>(glm::dot(r, z));
    }
    parts_[begin / kParticlesPerChunk] = sum;
  });
  double sum = total(parts_);
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
      direction_.x[p] = product_.x[p] + k * direction_.x[p];
      direction_.y[p] = product_.y[p] + k * direction_.y[p];
      direction_.z[p] = product_.z[p] + k * direction_.z[p];
    }
  });
  for (std::size_t b = 0; b < unknowns_.size(); ++b) {
    Unknown& u = unknowns_[b];
    for (int i = 0; i < 6; ++i) u.direction[i] = u.product[i] + keep * u.direction[i];
    twists_[b] = twist_of(u.direction);
  }
  carry_surface(work, twists_, direction_);
}

// product = (M + dt D) direction; returns direction · product.
double ViscousSolver::multiply(const Work& work) {
  const FluidParticles& fluid = work.sides.fluid;
  parts_.assign(chunk_count(work.fluid, kParticlesPerChunk), 0.0);
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    double sum = 0.0;
    for (std::size_t p = begin; p < end; ++p) {
      const float mass = work.context.kinds[fluid.kind[p]].mass;
      const glm::vec3 d(direction_.x[p], direction_.y[p], direction_.z[p]);
      const ForceSum<float> drag =
          fluid_rows_.drag_on(static_cast<std::uint32_t>(p), d.x, d.y, d.z, direction_);
      const glm::vec3 q = mass * d + times(by_walls_[p], d) - glm::vec3(drag.x, drag.y, drag.z);
      product_.x[p] = q.x;
      product_.y[p] = q.y;
      product_.z[p] = q.z;
      sum += static_cast<double>(glm::dot(d, q));
    }
    parts_[begin / kParticlesPerChunk] = sum;
  });
  double sum = total(parts_);
  sum_over_bodies(work, direction_);
  for (std::size_t b = 0; b < unknowns_.size(); ++b) {
    if (!work.bodies[b].moves) continue;
    Unknown& u = unknowns_[b];
    const Vector6 drag = vector_of(on_bodies_[b]);
    u.product = times(work.bodies[b].inertia, u.direction);
    for (int i = 0; i < 6; ++i) u.product[i] -= drag[i];
    sum += dot(u.direction, u.product);
  }
  return sum;
}

// One turn's way along the direction. Returns the sums of mass · (residual/mass)² and of mass · change².
ViscousSolver::Squares ViscousSolver::advance(const Work& work, double length) {
  const FluidParticles& fluid = work.sides.fluid;
  const float a = static_cast<float>(length);
  parts_.assign(chunk_count(work.fluid, kParticlesPerChunk), 0.0);
  more_parts_.assign(parts_.size(), 0.0);
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    double left = 0.0, changed = 0.0;
    for (std::size_t p = begin; p < end; ++p) {
      const float mass = work.context.kinds[fluid.kind[p]].mass;
      const auto along = [&](float& u, float& r, float d, float q) {
        u += a * d;
        r -= a * q;
        left += static_cast<double>(r * r / mass);
        changed += static_cast<double>(mass * u * u);
      };
      along(change_.x[p], residual_.x[p], direction_.x[p], product_.x[p]);
      along(change_.y[p], residual_.y[p], direction_.y[p], product_.y[p]);
      along(change_.z[p], residual_.z[p], direction_.z[p], product_.z[p]);
    }
    parts_[begin / kParticlesPerChunk] = left;
    more_parts_[begin / kParticlesPerChunk] = changed;
  });
  for (Unknown& u : unknowns_) {
    for (int i = 0; i < 6; ++i) {
      u.change[i] += length * u.direction[i];
      u.residual[i] -= length * u.product[i];
    }
  }
  return {total(parts_), total(more_parts_)};
}

// What is left over goes to each by its mass, so that the pair keeps its momentum.
void ViscousSolver::finish(const Work& work, std::span<Wrench> wrenches) {
  FluidParticles& fluid = work.sides.fluid;
  const glm::vec3 g = work.context.gravity;
  const float per_step = 1.0f / work.dt;
  work.team.run(work.fluid, kParticlesPerChunk, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const float mass = work.context.kinds[fluid.kind[p]].mass;
      fluid.fx[p] = per_step * (mass * change_.x[p] + residual_.x[p]) - mass * g.x;
      fluid.fy[p] = per_step * (mass * change_.y[p] + residual_.y[p]) - mass * g.y;
      fluid.fz[p] = per_step * (mass * change_.z[p] + residual_.z[p]) - mass * g.z;
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
  begin(work);
  double mass = 0.0;
  for (std::size_t p = 0; p < work.fluid; ++p) mass += context.kinds[sides.fluid.kind[p]].mass;
  const double floor = kViscousFloor * glm::length(context.gravity) * dt;
  ViscousReport report;
  report.converged = false;
  double before = 0.0;
  while (report.turns < kMostViscousTurns) {
    const double now = precondition(work);
    if (!(now > 0.0)) {
      report.converged = now == 0.0;
      break;
    }
    follow(work, before > 0.0 ? now / before : 0.0);
    before = now;
    const double curvature = multiply(work);
    if (!(curvature > 0.0)) break;
    const Squares left = advance(work, now / curvature);
    ++report.turns;
    if (left.residual <= kViscousTolerance * kViscousTolerance * left.change + floor * floor * mass) {
      report.converged = true;
      break;
    }
  }
  finish(work, wrenches);
  return report;
}

}  // namespace slosh
