// What the force pass writes down beside the forces, where a solve asks for the pairs again: who drags whom, who
// presses on whom.
#pragma once

#include "sim/cpu/passes.h"
#include "sim/cpu/pressure_rows.h"
#include "sim/cpu/row_drag.h"
#include "sim/viscosity/implicit.h"

namespace slosh {

// What the passes over fluid particles go through.
struct FluidWalk {
  const PassContext& context;
  ThreadTeam& team;
  FluidParticles& fluid;
  const BoundaryParticles& fixed;
  const BoundaryParticles& moving;
};

// Where drag is not solved for, nothing is written down beside the forces.
struct NoRows {
  struct Given {};
  struct Row {
    Row(NoRows&, std::uint32_t, const ParticleView<FloatBatch>&) {}
    auto fluid() { return kNothingMore; }
    auto fixed() { return kNothingMore; }
    auto moving() { return kNothingMore; }
    void end() {}
  };
  NoRows(const Given&, std::size_t) {}
};

// Who drags whom, of one chunk of runs. By fluid and by moving bodies' particles, which are numbered on
// behind the fluid's; fixed ones are in the own block alone.
template <class Parts, Viscosity viscosity>
struct RowsOf {
  struct Given {
    const FluidWalk& walk;
    float dt;
    FluidDrag& drag;
  };

  // Of one particle; small enough to stay in registers.
  class Row {
   public:
    Row(RowsOf& rows, std::uint32_t p, const ParticleView<FloatBatch>& self)
        : rows_(rows), p_(p), self_(self) {
      rows_.writer.begin(p);
    }
    auto fluid() {
      return [this](const BatchView&, const BatchView&, std::uint32_t j, FloatBatch weight) {
        rows_.writer.add(j, pairs<viscosity, Neighbours::kFluid>(rows_.fluids, j, weight));
      };
    }
    auto moving() {
      return [this](const BatchView&, const BatchView&, std::uint32_t j, FloatBatch weight) {
        rows_.writer.add(rows_.behind + j,
                         pairs<Viscosity::kPair, Neighbours::kWalls>(rows_.bodies, j, weight));
      };
    }
    auto fixed() {
      return [this](const BatchView&, const BatchView&, std::uint32_t j, FloatBatch weight) {
        const PairBatch w = pairs<Viscosity::kPair, Neighbours::kWalls>(rows_.walls, j, weight);
        const FloatBatch x = w.q * w.x, y = w.q * w.y;
        by_walls_.xx += x * w.x;
        by_walls_.xy += x * w.y;
        by_walls_.xz += x * w.z;
        by_walls_.yy += y * w.y;
        by_walls_.yz += y * w.z;
        by_walls_.zz += w.q * w.z * w.z;
      };
    }
    void end() {
      const Symmetric<float> all = rows_.writer.end(), walls = summed(by_walls_);
      const FluidWalk& walk = rows_.given.walk;
      rows_.given.drag.by_walls[p_] = walls;
      rows_.given.drag.block[p_] = inverse_block(walk.context.kinds[walk.fluid.kind[p_]].mass, 1.0f,
                                                 {all.xx + walls.xx, all.xy + walls.xy, all.xz + walls.xz,
                                                  all.yy + walls.yy, all.yz + walls.yz, all.zz + walls.zz});
    }

   private:
    template <Viscosity of_pair, Neighbours neighbours>
    PairBatch pairs(const NeighborColumns& n, std::uint32_t j, FloatBatch weight) {
      return drag_pairs<Parts, of_pair, neighbours>(self_, n, j, weight, rows_.h, rows_.factor,
                                                    FloatBatch(1.0f));
    }

    RowsOf& rows_;
    const std::uint32_t p_;
    const ParticleView<FloatBatch> self_;
    Symmetric<FloatBatch> by_walls_ = no_rate();
  };

  RowsOf(const Given& g, std::size_t chunk)
      : given(g),
        writer(g.drag.rows, chunk),
        fluids(columns(g.walk.fluid)),
        walls(columns(g.walk.fixed)),
        bodies(columns(g.walk.moving)),
        h(g.walk.context.support_radius),
        factor(kCentralDrag * g.dt * g.walk.context.force_scale),
        behind(static_cast<std::uint32_t>(g.walk.fluid.index.particles())) {}

  const Given given;
  DragRows::Writer writer;
  const NeighborColumns fluids, walls, bodies;
  const FloatBatch h, factor;
  const std::uint32_t behind;
};

// Who presses on whom, of one chunk of runs. By fluid; walls and bodies are in the own vector alone.
template <class Parts>
struct PressRowsOf {
  struct Given {
    const FluidWalk& walk;
    FluidPress& press;
  };

  class Row {
   public:
    Row(PressRowsOf& rows, std::uint32_t p, const ParticleView<FloatBatch>&) : rows_(rows), p_(p) {
      rows_.writer.begin(p);
    }
    auto fluid() {
      return [this](const BatchView& p, const BatchView& i, std::uint32_t j, FloatBatch weight) {
        const FloatBatch dx = p.x - i.x, dy = p.y - i.y, dz = p.z - i.z;
        const FloatBatch r_squared = dx * dx + dy * dy + dz * dz;
        const FloatBatch slope = Parts::ForceKernel::pair(r_squared, rows_.h, weight).slope_over_r;
        rows_.writer.add(j, {{slope * dx, slope * dy, slope * dz}, r_squared * slope});
      };
    }
    auto fixed() { return of_walls(rows_.walls); }
    auto moving() { return of_walls(rows_.bodies); }
    void end() {
      const Vector4 by_fluid = rows_.writer.end(rows_.given.press.tensors.data());
      const PressTensor& t = rows_.given.press.tensors[p_];
      const float x = lane_sum(by_walls_.x), y = lane_sum(by_walls_.y), z = lane_sum(by_walls_.z);
      rows_.given.press.own[p_] = {by_fluid.x + (t.x[0] * x + t.y[0] * y + t.z[0] * z),
                                   by_fluid.y + (t.x[1] * x + t.y[1] * y + t.z[1] * z),
                                   by_fluid.z + (t.x[2] * x + t.y[2] * y + t.z[2] * z), by_fluid.w};
    }

   private:
    auto of_walls(const NeighborColumns& n) {
      return [this, &n](const BatchView& p, const BatchView& i, std::uint32_t j, FloatBatch weight) {
        const FloatBatch dx = p.x - i.x, dy = p.y - i.y, dz = p.z - i.z;
        const auto kernel = Parts::ForceKernel::pair(dx * dx + dy * dy + dz * dz, rows_.h, weight);
        const FloatBatch by = kernel.slope_over_r * FloatBatch::load_unaligned(n.pressure + j);
        by_walls_.x += by * dx;
        by_walls_.y += by * dy;
        by_walls_.z += by * dz;
      };
    }

    PressRowsOf& rows_;
    const std::uint32_t p_;
    Vector3<FloatBatch> by_walls_{FloatBatch(0.0f), FloatBatch(0.0f), FloatBatch(0.0f)};
  };

  PressRowsOf(const Given& g, std::size_t chunk)
      : given(g),
        writer(g.press.rows, chunk),
        walls(columns(g.walk.fixed)),
        bodies(columns(g.walk.moving)),
        h(g.walk.context.support_radius) {}

  const Given given;
  PressureRows::Writer writer;
  const NeighborColumns walls, bodies;
  const FloatBatch h;
};

// Both of one chunk.
template <class A, class B>
struct BothRows {
  struct Given {
    typename A::Given a;
    typename B::Given b;
  };
  struct Row {
    Row(BothRows& rows, std::uint32_t p, const ParticleView<FloatBatch>& self)
        : a(rows.a, p, self), b(rows.b, p, self) {}
    auto fluid() { return both(a.fluid(), b.fluid()); }
    auto fixed() { return both(a.fixed(), b.fixed()); }
    auto moving() { return both(a.moving(), b.moving()); }
    void end() {
      a.end();
      b.end();
    }
    template <class F, class G>
    static auto both(F f, G g) {
      return [f, g](const BatchView& p, const BatchView& i, std::uint32_t j, FloatBatch weight) {
        f(p, i, j, weight);
        g(p, i, j, weight);
      };
    }
    typename A::Row a;
    typename B::Row b;
  };
  BothRows(const Given& given, std::size_t chunk) : a(given.a, chunk), b(given.b, chunk) {}
  A a;
  B b;
};

}  // namespace slosh
