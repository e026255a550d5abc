#include "sim/cpu/cpu_engine.h"

#include <algorithm>

#include "sim/cpu/state.h"
#include "sim/fluid_sums.h"

namespace slosh {

namespace passes {
#define SLOSH_OWN(id, name) void name##_on_cpu(CpuState& state, const PassInputs& inputs);
#define SLOSH_NONE(...)
SLOSH_PASSES(SLOSH_OWN, SLOSH_NONE, SLOSH_NONE)
#undef SLOSH_OWN
}  // namespace passes

namespace {

using CpuPass = void (*)(CpuState&, const PassInputs&);

CpuPass function_of(PassId id) {
  switch (id) {
#define SLOSH_OWN(id, name) \
  case PassId::id:          \
    return passes::name##_on_cpu;
    SLOSH_PASSES(SLOSH_OWN, SLOSH_NONE, SLOSH_NONE)
#undef SLOSH_OWN
#undef SLOSH_NONE
    default:
      return nullptr;
  }
}

class CpuEngine final : public ParticleEngine {
 public:
  CpuEngine(const RunConstants& constants, const ParticleStart& start, std::span<const RigidBody> bodies,
            int threads)
      : s_(constants, start, bodies, threads), kinds_(start.particles.kind) {
    restore(start.particles, s_.impulses);
    s_.context.status = start.status;
    s_.fixed.place(s_.context, bodies);
  }

  void begin(std::span<const RigidBody> bodies, double dt) override {
    s_.bodies.assign(bodies.begin(), bodies.end());
    std::fill(s_.found.begin(), s_.found.end(), Wrench{});
    std::fill(s_.drags.begin(), s_.drags.end(), BodyDrag{});
    take_impulses(dt);
  }
  void run(PassId id, const PassInputs& inputs) override { function_of(id)(s_, inputs); }
  void wrenches(std::span<Wrench> out) override {
    std::copy(s_.found.begin(), s_.found.end(), out.begin());
    if (!s_.context.plan.clamps_penetration()) return;
    for (std::size_t b = 0; b < out.size(); ++b) {
      if (s_.wanted[b]) out[b] = out[b] + s_.taken[b];
    }
  }
  void body_drags(std::span<BodyDrag> out) const override {
    std::copy(s_.drags.begin(), s_.drags.end(), out.begin());
  }

  void damp(float keep) override {
    for (Column<float>* column : {&s_.fluid.vx, &s_.fluid.vy, &s_.fluid.vz}) {
      for (std::size_t p = 0; p < s_.fluid.active; ++p) (*column)[p] *= keep;
    }
  }

  void set_constants(const RunConstants& constants) override {
    static_cast<RunConstants&>(s_.context) = constants;
    s_.fluid.provide(s_.context.plan, kinds_.size());
  }
  void set_correction(const CorrectionConstants& correction) override { s_.context.correction = correction; }

  bool save(ParticleState& out, ImpulseSums& impulses) const override {
    impulses = s_.impulses;
    out.broken = s_.context.broken;
    out.resize(s_.fluid.active);
    for_each_column(
        [&](auto column, const auto& from, auto& to) {
          if constexpr (info(column).saved) {
            if (!from.empty()) std::copy_n(from.begin(), s_.fluid.active, to.begin());
          }
        },
        s_.fluid, out);
    return true;
  }

  void restore(const ParticleState& state, const ImpulseSums& impulses) override {
    s_.impulses = impulses;
    for_each_column(
        [](auto column, const auto& from, auto& to) {
          if constexpr (info(column).saved) {
            if (!to.empty()) std::copy(from.begin(), from.end(), to.begin());
          }
        },
        state, s_.fluid);
    for (std::size_t p = 0; p < state.size(); ++p) s_.fluid.kind[p] = kinds_[state.id[p]];
    s_.fluid.active = state.size();
    s_.context.status = 0;
    s_.context.broken = state.broken;
  }

  void reshape(const ReshapedBody& as) override { s_.reshape(as); }

  bool save_bonds(BondTable& out) const override {
    out = s_.bonds.table;
    return true;
  }
  void restore_bonds(const BondTable& bonds) override { s_.bonds.table = bonds; }

  std::uint32_t status() const override { return s_.context.status.load(std::memory_order_relaxed); }
  std::uint32_t take_status() override { return s_.context.status.exchange(0); }

  void fill(std::span<glm::vec3> positions, std::span<std::uint8_t> fluid_index) const override {
    std::fill(fluid_index.begin(), fluid_index.end(), std::uint8_t{255});
    for (std::size_t p = 0; p < s_.fluid.active; ++p) {
      const std::uint32_t id = s_.fluid.id[p];
      if (id >= s_.fluid_count || s_.fluid.key[p] >= s_.context.grid.retired_key()) continue;
      positions[id] = glm::vec3(s_.fluid.x[p], s_.fluid.y[p], s_.fluid.z[p]);
      fluid_index[id] = s_.fluid.kind[p];
    }
  }

  void add_to(Fingerprint& print) const override {
    for (std::size_t p = 0; p < s_.fluid.active; ++p) {
      print.add(s_.fluid.id[p]);
      for_each_column(
          [&](auto column, const auto& values) {
            if constexpr (info(column).hashed && column != FluidColumn::id) {
              if (!values.empty()) print.add(values[p]);
            }
          },
          s_.fluid);
    }
  }

  Diagnostics diagnostics() const override {
    FluidSums sums(s_.context);
    for (std::size_t p = 0; p < s_.fluid.active; ++p) {
      if (s_.fluid.key[p] >= s_.context.grid.retired_key()) continue;
      sums.add(s_.fluid.kind[p], {s_.fluid.x[p], s_.fluid.y[p], s_.fluid.z[p]},
               {s_.fluid.vx[p], s_.fluid.vy[p], s_.fluid.vz[p]}, s_.fluid.volume[p]);
      if (!s_.fluid.temperature.empty())
        sums.add_heat(s_.fluid.kind[p], s_.fluid.temperature[p], s_.fluid.cure[p], s_.fluid.from_bodies[p]);
    }
    sums.add(s_.impulses);
    return sums.finish(s_.fluid_count, s_.context.broken);
  }

  std::string name() const override {
    return "CPU, " + std::to_string(s_.team.size()) + (s_.team.size() == 1 ? " thread" : " threads");
  }

 private:
  // What walls took from particles when they moved last acts on the bodies now.
  void take_impulses(double dt) {
    if (!s_.context.plan.clamps_penetration()) return;
    for (std::size_t b = 0; b < s_.taken.size(); ++b) {
      const std::span<std::int64_t> words(s_.impulses.data() + kImpulseWords * b, kImpulseWords);
      if (s_.wanted[b]) s_.taken[b] = impulse_wrench(words, s_.context.impulse_units, dt);
      std::fill(words.begin(), words.end(), 0);
    }
  }

  CpuState s_;
  std::vector<std::uint8_t> kinds_;  // by id
};

}  // namespace

std::string cpu_variant() {
  return std::to_string(kLanes) + " neighbours at a time (" + kInstructions + ")";
}

std::unique_ptr<ParticleEngine> make_cpu_engine(const RunConstants& constants, const ParticleStart& start,
                                                std::span<const RigidBody> bodies, int threads) {
  return std::make_unique<CpuEngine>(constants, start, bodies, threads);
}

}  // namespace slosh
