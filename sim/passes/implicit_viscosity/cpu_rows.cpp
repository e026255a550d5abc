// The viscous pairs, as conjugate gradients use them (viscous_solve.h).
#include "sim/passes/implicit_viscosity/cpu.h"
#include "sim/passes/pair_viscosity/row_viscosity.h"
#include "sim/passes/walls/row_mirror.h"

namespace slosh {

namespace {

constexpr std::size_t kRunsPerChunk = 16;

// Implicit viscosity is for this model and the incompressible one, whose viscous force is the same
// (Plan::implicit_viscosity).
using Parts = ModelParts<ParticleModel::kCorrected>;
static_assert(Parts::kDrag == DragRule::kCentral);

}  // namespace

// Of moving bodies' particles, by fluid.
void ViscousSolver::write_body_rows(const Work& work) {
  const PassContext& context = work.context;
  const FluidParticles& fluid = work.sides.fluid;
  const BoundaryParticles& moving = work.sides.moving.sorted();
  const std::vector<CellRun>& runs = moving.index.runs();
  const NeighborColumns fluids = columns(fluid), own = columns(moving);
  const FloatBatch h(context.support_radius), factor(kCentralDrag * work.dt * context.force_scale);
  const DragShape<FloatBatch> shape = in_all_lanes(context.drag_shape);
  body_rows_.clear(chunk_count(runs.size(), kRunsPerChunk));
  rate_.assign(work.surface, Symmetric<float>{});
  with_solved_viscosity(context.plan, [&]<Viscosity viscosity>() {
    work.team.run(runs.size(), kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
      PairRows::Writer writer(body_rows_, begin / kRunsPerChunk);
      for (std::size_t r = begin; r < end; ++r) {
        const RowList rows = fluid.index.rows(context.grid, runs[r].cell);
        for (std::uint32_t i = runs[r].particles.begin; i < runs[r].particles.end; ++i) {
          writer.begin(static_cast<std::uint32_t>(work.fluid) + i);
          if (!work.bodies[moving.body[i]].moves) {
            writer.end();
            continue;
          }
          const WallViscosity wall = wall_viscosity(moving.viscosity[i]);
          const ParticleView<FloatBatch> self =
              broadcast(own, i, own_viscosity<viscosity>(wall, context.kinds.front().viscosity));
          for_each_batch(rows, [&](std::uint32_t j, FloatBatch weight) {
            const PairBatch found = drag_pairs<Parts, viscosity, Neighbours::kFluid>(
                self, fluids, j, weight, h, shape, factor, FloatBatch(wall.of_fluid));
            writer.add(j, found.q, lanes_less(FloatBatch(0.0f), found.q * found.r_squared));
          });
          writer.end();
        }
      }
    });
  });
}

// Where everybody is, and what it loses by its own velocity.
void ViscousSolver::find_blocks(const Work& work) {
  const FluidParticles& fluid = work.sides.fluid;
  const BoundaryParticles& moving = work.sides.moving.sorted();
  const FluidViscosity& drag = work.sides.drag;
  places_.resize(work.fluid + work.surface + 4);
  block_.resize(work.fluid);
  for (std::size_t p = 0; p < work.fluid; ++p) places_[p] = {fluid.x[p], fluid.y[p], fluid.z[p], 0.0f};
  for (std::size_t i = 0; i < work.surface; ++i)
    places_[work.fluid + i] = {moving.x[i], moving.y[i], moving.z[i], 0.0f};
  work.team.run(drag.rows.chunks(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t chunk = begin; chunk < end; ++chunk) {
      for_each_rate_of(drag.rows, chunk, places_.data(), [&](std::uint32_t p, const Symmetric<float>& all) {
        const Symmetric<float>& walls = drag.by_walls[p];
        block_[p] = inverse_block(work.context.kinds[fluid.kind[p]].mass, 1.0f,
                                  {all.xx + walls.xx, all.xy + walls.xy, all.xz + walls.xz, all.yy + walls.yy,
                                   all.yz + walls.yz, all.zz + walls.zz});
      });
    }
  });
  for (std::size_t chunk = 0; chunk < body_rows_.chunks(); ++chunk) {
    for_each_rate_of(body_rows_, chunk, places_.data(),
                     [&](std::uint32_t i, const Symmetric<float>& rate) { rate_[i - work.fluid] = rate; });
  }
}

// The drag on fixed bodies that are measured, by the velocities that the iterations found.
void ViscousSolver::add_fixed(const Work& work, std::span<Wrench> wrenches) {
  const BoundaryParticles& fixed = work.sides.fixed;
  const auto asked = [&](int body) { return work.measured[body] && work.sides.bodies[body].is_fixed(); };
  bool any = false;
  for (std::size_t b = 0; b < work.bodies.size(); ++b) any |= asked(static_cast<int>(b));
  if (!any) return;
  const PassContext& context = work.context;
  const FluidParticles& fluid = work.sides.fluid;
  // In columns, as a walk over the neighbours takes them.
  for (Column<float>* column : {&end_x_, &end_y_, &end_z_}) column->resize(work.fluid + kLanes);
  for (std::size_t p = 0; p < work.fluid; ++p) {
    end_x_[p] = fluid.vx[p] + change_[p].x;
    end_y_[p] = fluid.vy[p] + change_[p].y;
    end_z_[p] = fluid.vz[p] + change_[p].z;
  }
  const std::vector<CellRun>& runs = fixed.index.runs();
  const NeighborColumns fluids = columns(fluid), own = columns(fixed);
  NeighborColumns ended = fluids;
  ended.vx = end_x_.data();
  ended.vy = end_y_.data();
  ended.vz = end_z_.data();
  const FloatBatch h(context.support_radius), factor(kCentralDrag * context.force_scale), zero(0.0f);
  const DragShape<FloatBatch> shape = in_all_lanes(context.drag_shape);
  std::vector<glm::vec3> forces(fixed.index.particles(), glm::vec3(0.0f)), couples = forces;
  with_solved_viscosity(context.plan, [&]<Viscosity viscosity>() {
    work.team.run(runs.size(), kRunsPerChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t r = begin; r < end; ++r) {
        const RowList rows = fluid.index.rows(context.grid, runs[r].cell);
        if (rows.count == 0) continue;
        for (std::uint32_t i = runs[r].particles.begin; i < runs[r].particles.end; ++i) {
          if (!asked(fixed.body[i])) continue;
          const WallViscosity wall = wall_viscosity(fixed.viscosity[i]);
          const ParticleView<FloatBatch> self =
              broadcast(own, i, own_viscosity<viscosity>(wall, context.kinds.front().viscosity));
          SurfaceSum<FloatBatch> force{{zero, zero, zero}, zero, zero, zero, zero};
          for_each_batch(rows, [&](std::uint32_t j, FloatBatch weight) {
            const PairBatch d = drag_pairs<Parts, viscosity, Neighbours::kFluid>(
                self, fluids, j, weight, h, shape, factor, FloatBatch(wall.of_fluid));
            const FloatBatch along = d.q * (d.x * FloatBatch::load_unaligned(ended.vx + j) +
                                            d.y * FloatBatch::load_unaligned(ended.vy + j) +
                                            d.z * FloatBatch::load_unaligned(ended.vz + j));
            force.x += d.x * along;
            force.y += d.y * along;
            force.z += d.z * along;
          });
          if (!fixed.mirror.empty())
            add_forces_on_mirror<Parts, viscosity>(fixed, i, context.kinds.front().viscosity, ended, rows, h,
                                                   shape, force, FloatBatch(context.force_scale));
          forces[i] = {lane_sum(force.x), lane_sum(force.y), lane_sum(force.z)};
          couples[i] = {lane_sum(force.cx), lane_sum(force.cy), lane_sum(force.cz)};
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
        glm::cross(glm::dvec3(fixed.x[i], fixed.y[i], fixed.z[i]) - work.sides.bodies[body].position, force) +
        glm::dvec3(couples[i]);
  }
}

}  // namespace slosh
