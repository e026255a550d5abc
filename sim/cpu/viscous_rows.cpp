// Which pairs drag, as conjugate gradients ask for them (viscous_solve.h).
#include "sim/cpu/row_force.h"
#include "sim/cpu/viscous_solve.h"

namespace slosh {

namespace {

constexpr std::size_t kRunsPerChunk = 16;

// Calls f.template operator()<Parts, Viscosity>(): Eq 6 or Eq 9 between fluids.
template <class F>
void with_drag(const Plan& plan, F&& f) {
  with_model(plan.model, [&]<class Parts>() {
    if constexpr (Parts::kDrag == DragRule::kCentral) {
      if (plan.has(PassId::kPairViscosity)) {
        f.template operator()<Parts, Viscosity::kPair>();
      } else {
        f.template operator()<Parts, Viscosity::kOne>();
      }
    }
  });
}

Symmetric<FloatBatch> no_rate() {
  const FloatBatch z(0.0f);
  return {z, z, z, z, z, z};
}

Symmetric<float> summed(const Symmetric<FloatBatch>& s) {
  return {lane_sum(s.xx), lane_sum(s.xy), lane_sum(s.xz), lane_sum(s.yy), lane_sum(s.yz), lane_sum(s.zz)};
}

Symmetric<float> operator+(const Symmetric<float>& a, const Symmetric<float>& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
}

// Calls take(j, wx, wy, wz) for the batches of p's pairs (DragRows), and adds w wᵀ to `rate`. `factor`: dt
// and the kernel's constant.
template <class Parts, Viscosity viscosity, Neighbours neighbours, class Take>
void for_each_pair(const ParticleView<FloatBatch>& p, const NeighborColumns& n, const RowList& rows,
                   FloatBatch h, FloatBatch factor, FloatBatch of_fluid, Symmetric<FloatBatch>& rate,
                   Take&& take) {
  for_each_batch(rows, [&](std::uint32_t j, FloatBatch weight) {
    ParticleView<FloatBatch> i;
    i.volume = FloatBatch::load_unaligned(n.volume + j);
    i.viscosity = viscosity_of<viscosity, neighbours>(p, n, j, of_fluid);
    const FloatBatch dx = p.x - FloatBatch::load_unaligned(n.x + j);
    const FloatBatch dy = p.y - FloatBatch::load_unaligned(n.y + j);
    const FloatBatch dz = p.z - FloatBatch::load_unaligned(n.z + j);
    const auto kernel = Parts::ForceKernel::pair(dx * dx + dy * dy + dz * dz, h, weight);
    const FloatBatch drag = factor * drag_coefficient(p, i, kernel.laplacian);
    const FloatBatch w = xsimd::sqrt(RealOps<FloatBatch>::positive_part(drag)) * kernel.inverse_r;
    const FloatBatch wx = w * dx, wy = w * dy, wz = w * dz;
    rate.xx += wx * wx;
    rate.xy += wx * wy;
    rate.xz += wx * wz;
    rate.yy += wy * wy;
    rate.yz += wy * wz;
    rate.zz += wz * wz;
    take(j, wx, wy, wz);
  });
}

constexpr auto kNobody = [](std::uint32_t, FloatBatch, FloatBatch, FloatBatch) {};

}  // namespace

// By fluid and by moving bodies' particles, which are numbered on behind the fluid's; fixed ones are in the
// own block alone.
void ViscousSolver::write_fluid_rows(const Work& work) {
  const PassContext& context = work.context;
  const FluidParticles& fluid = work.sides.fluid;
  const BoundaryParticles& moving = work.sides.moving.sorted();
  const std::vector<CellRun>& runs = fluid.index.runs();
  const NeighborColumns fluids = columns(fluid), fixed = columns(work.sides.fixed), bodies = columns(moving);
  const FloatBatch h(context.support_radius), one(1.0f), factor(kCentralDrag * work.dt * context.force_scale);
  const auto behind = static_cast<std::uint32_t>(work.fluid);
  fluid_rows_.clear(work.fluid, chunk_count(runs.size(), kRunsPerChunk));
  by_walls_.resize(work.fluid);
  block_.resize(work.fluid);
  with_drag(context.plan, [&]<class Parts, Viscosity viscosity>() {
    work.team.run(runs.size(), kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
      DragRows::Writer writer(fluid_rows_, begin / kRunsPerChunk);
      for (std::size_t r = begin; r < end; ++r) {
        const RowList fluid_rows = fluid.index.rows(context.grid, runs[r].cell);
        const RowList fixed_rows = work.sides.fixed.index.rows(context.grid, runs[r].cell);
        const RowList moving_rows = moving.index.rows(context.grid, runs[r].cell);
        for (std::uint32_t p = runs[r].particles.begin; p < runs[r].particles.end; ++p) {
          const ParticleKind& kind = context.kinds[fluid.kind[p]];
          const ParticleView<FloatBatch> self = broadcast(fluids, p, kind.viscosity);
          Symmetric<FloatBatch> rate = no_rate(), by_walls = no_rate();
          writer.begin(p);
          for_each_pair<Parts, viscosity, Neighbours::kFluid>(
              self, fluids, fluid_rows, h, factor, one, rate,
              [&](std::uint32_t j, FloatBatch x, FloatBatch y, FloatBatch z) { writer.add(j, x, y, z); });
          for_each_pair<Parts, Viscosity::kPair, Neighbours::kWalls>(
              self, bodies, moving_rows, h, factor, one, rate,
              [&](std::uint32_t j, FloatBatch x, FloatBatch y, FloatBatch z) {
                writer.add(behind + j, x, y, z);
              });
          writer.end();
          for_each_pair<Parts, Viscosity::kPair, Neighbours::kWalls>(self, fixed, fixed_rows, h, factor, one,
                                                                     by_walls, kNobody);
          by_walls_[p] = summed(by_walls);
          block_[p] = inverse_block(kind.mass, 1.0f, summed(rate) + by_walls_[p]);
        }
      }
    });
  });
}

// Of moving bodies' particles, by fluid.
void ViscousSolver::write_body_rows(const Work& work) {
  const PassContext& context = work.context;
  const FluidParticles& fluid = work.sides.fluid;
  const BoundaryParticles& moving = work.sides.moving.sorted();
  const std::vector<CellRun>& runs = moving.index.runs();
  const NeighborColumns fluids = columns(fluid), own = columns(moving);
  const FloatBatch h(context.support_radius), factor(kCentralDrag * work.dt * context.force_scale);
  body_rows_.clear(work.surface, chunk_count(runs.size(), kRunsPerChunk));
  rate_.assign(work.surface, Symmetric<float>{});
  with_drag(context.plan, [&]<class Parts, Viscosity viscosity>() {
    work.team.run(runs.size(), kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
      DragRows::Writer writer(body_rows_, begin / kRunsPerChunk);
      for (std::size_t r = begin; r < end; ++r) {
        const RowList rows = fluid.index.rows(context.grid, runs[r].cell);
        if (rows.count == 0) continue;
        for (std::uint32_t i = runs[r].particles.begin; i < runs[r].particles.end; ++i) {
          if (!work.bodies[moving.body[i]].moves) continue;
          const WallViscosity wall = wall_viscosity(moving.viscosity[i]);
          const ParticleView<FloatBatch> self =
              broadcast(own, i, own_viscosity<viscosity>(wall, context.kinds.front().viscosity));
          Symmetric<FloatBatch> rate = no_rate();
          writer.begin(i);
          for_each_pair<Parts, viscosity, Neighbours::kFluid>(
              self, fluids, rows, h, factor, FloatBatch(wall.of_fluid), rate,
              [&](std::uint32_t j, FloatBatch x, FloatBatch y, FloatBatch z) { writer.add(j, x, y, z); });
          writer.end();
          rate_[i] = summed(rate);
        }
      }
    });
  });
}

// The drag on fixed bodies that are measured, by the velocities that the turns found.
void ViscousSolver::add_fixed(const Work& work, std::span<Wrench> wrenches) {
  const BoundaryParticles& fixed = work.sides.fixed;
  const auto asked = [&](int body) { return work.measured[body] && !work.sides.bodies[body].free; };
  bool any = false;
  for (std::size_t b = 0; b < work.bodies.size(); ++b) any |= asked(static_cast<int>(b));
  if (!any) return;
  const PassContext& context = work.context;
  const FluidParticles& fluid = work.sides.fluid;
  for (std::size_t p = 0; p < work.fluid; ++p) {
    product_.x[p] = fluid.vx[p] + change_.x[p];
    product_.y[p] = fluid.vy[p] + change_.y[p];
    product_.z[p] = fluid.vz[p] + change_.z[p];
  }
  const std::vector<CellRun>& runs = fixed.index.runs();
  const NeighborColumns fluids = columns(fluid), own = columns(fixed);
  const FloatBatch h(context.support_radius), factor(kCentralDrag * context.force_scale), zero(0.0f);
  std::vector<glm::vec3> forces(fixed.index.particles(), glm::vec3(0.0f));
  with_drag(context.plan, [&]<class Parts, Viscosity viscosity>() {
    work.team.run(runs.size(), kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t r = begin; r < end; ++r) {
        const RowList rows = fluid.index.rows(context.grid, runs[r].cell);
        if (rows.count == 0) continue;
        for (std::uint32_t i = runs[r].particles.begin; i < runs[r].particles.end; ++i) {
          if (!asked(fixed.body[i])) continue;
          const WallViscosity wall = wall_viscosity(fixed.viscosity[i]);
          const ParticleView<FloatBatch> self =
              broadcast(own, i, own_viscosity<viscosity>(wall, context.kinds.front().viscosity));
          Symmetric<FloatBatch> rate = no_rate();
          ForceSum<FloatBatch> force{zero, zero, zero};
          for_each_pair<Parts, viscosity, Neighbours::kFluid>(
              self, fluids, rows, h, factor, FloatBatch(wall.of_fluid), rate,
              [&](std::uint32_t j, FloatBatch x, FloatBatch y, FloatBatch z) {
                const FloatBatch along = x * FloatBatch::load_unaligned(product_.x.data() + j) +
                                         y * FloatBatch::load_unaligned(product_.y.data() + j) +
                                         z * FloatBatch::load_unaligned(product_.z.data() + j);
                force.x += x * along;
                force.y += y * along;
                force.z += z * along;
              });
          forces[i] = {lane_sum(force.x), lane_sum(force.y), lane_sum(force.z)};
        }
      }
    });
  });
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const int body = fixed.body[i];
    if (!asked(body)) continue;
    const glm::dvec3 force(forces[i]);
    wrenches[body].force += force;
    wrenches[body].torque +=
        glm::cross(glm::dvec3(fixed.x[i], fixed.y[i], fixed.z[i]) - work.sides.bodies[body].position, force);
  }
}

}  // namespace slosh
