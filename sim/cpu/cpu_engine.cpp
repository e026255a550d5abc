#include "sim/cpu/cpu_engine.h"

#include <algorithm>

#include "sim/cpu/passes.h"
#include "sim/fluid_sums.h"
#include "sim/stopwatch.h"

namespace slosh {

namespace {

class CpuEngine final : public ParticleEngine {
 public:
  CpuEngine(const RunConstants& constants, const ParticleStart& start, std::span<const RigidBody> bodies,
            int threads)
      : team_(threads),
        fixed_(start.fixed),
        moving_(start.moving),
        probes_(start.probes),
        kinds_(start.kinds),
        fluid_count_(start.fluid_count) {
    static_cast<RunConstants&>(context_) = constants;
    wanted_.assign(bodies.size(), 0);
    for (const int b : constants.plan.wrench_bodies) wanted_[b] = 1;
    fixed_measured_ = std::any_of(constants.plan.wrench_bodies.begin(), constants.plan.wrench_bodies.end(),
                                  [&](int b) { return !bodies[b].free; });
    load(start);
    fixed_.place(context_, bodies);
  }

  void step(std::span<const RigidBody> bodies, std::span<Wrench> wrenches) override {
    Stopwatch watch;
    carry_probes_in(bodies);
    sort_fluid(context_, team_, fluid_, sorter_, scratch_);
    if (moving_.size() > 0) moving_.place(context_, bodies);
    times_.sort = watch.lap();
    compute_density(context_, team_, fluid_, fixed_.sorted(), moving_.sorted());
    times_.density = watch.lap();
    compute_fluid_forces(context_, team_, fluid_, fixed_.sorted(), moving_.sorted());
    std::fill(wrenches.begin(), wrenches.end(), Wrench{});
    if (context_.plan.body_wrench) {
      const auto sum = [&](const BodySurface& surface) {
        sum_body_wrenches(context_, team_, fluid_, surface.sorted(), bodies, wanted_, body_scratch_,
                          wrenches);
      };
      sum(moving_);
      if (fixed_measured_) sum(fixed_);
      carry_probe_forces_out(wrenches);
    }
    integrate_fluid(context_, team_, fluid_);
    times_.force = watch.lap();
  }

  void damp(float keep) override {
    for (Column<float>* column : {&fluid_.vx, &fluid_.vy, &fluid_.vz}) {
      for (std::size_t p = 0; p < fluid_.active; ++p) (*column)[p] *= keep;
    }
  }

  void set_constants(const RunConstants& constants) override {
    static_cast<RunConstants&>(context_) = constants;
  }

  bool save(ParticleState& out) const override {
    out.resize(fluid_.active);
    const auto copy = [&](const auto& from, auto& to) {
      std::copy_n(from.begin(), fluid_.active, to.begin());
    };
    copy(fluid_.x, out.x);
    copy(fluid_.y, out.y);
    copy(fluid_.z, out.z);
    copy(fluid_.vx, out.vx);
    copy(fluid_.vy, out.vy);
    copy(fluid_.vz, out.vz);
    copy(fluid_.volume, out.volume);
    copy(fluid_.id, out.id);
    copy(fluid_.key, out.key);
    return true;
  }

  void restore(const ParticleState& state) override {
    fluid_.resize(kinds_.size());
    const auto copy = [&](const auto& from, auto& to) { std::copy(from.begin(), from.end(), to.begin()); };
    copy(state.x, fluid_.x);
    copy(state.y, fluid_.y);
    copy(state.z, fluid_.z);
    copy(state.vx, fluid_.vx);
    copy(state.vy, fluid_.vy);
    copy(state.vz, fluid_.vz);
    copy(state.volume, fluid_.volume);
    copy(state.id, fluid_.id);
    copy(state.key, fluid_.key);
    for (std::size_t p = 0; p < state.size(); ++p) fluid_.kind[p] = kinds_[state.id[p]];
    fluid_.active = state.size();
    context_.status = 0;
  }

  std::uint32_t status() const override { return context_.status.load(std::memory_order_relaxed); }
  std::uint32_t take_status() override { return context_.status.exchange(0); }

  void fill(std::span<glm::vec3> positions, std::span<std::uint8_t> fluid_index) const override {
    std::fill(fluid_index.begin(), fluid_index.end(), std::uint8_t{255});
    for (std::size_t p = 0; p < fluid_.active; ++p) {
      const std::uint32_t id = fluid_.id[p];
      if (id >= fluid_count_ || fluid_.key[p] >= context_.grid.retired_key()) continue;
      positions[id] = glm::vec3(fluid_.x[p], fluid_.y[p], fluid_.z[p]);
      fluid_index[id] = fluid_.kind[p];
    }
  }

  void add_to(Fingerprint& print) const override {
    for (std::size_t p = 0; p < fluid_.active; ++p) {
      print.add(fluid_.id[p]);
      for (const Column<float>* column :
           {&fluid_.x, &fluid_.y, &fluid_.z, &fluid_.vx, &fluid_.vy, &fluid_.vz}) {
        print.add((*column)[p]);
      }
    }
  }

  Diagnostics diagnostics() const override {
    FluidSums sums(context_);
    for (std::size_t p = 0; p < fluid_.active; ++p) {
      if (fluid_.key[p] >= context_.grid.retired_key()) continue;
      sums.add(fluid_.kind[p], {fluid_.x[p], fluid_.y[p], fluid_.z[p]},
               {fluid_.vx[p], fluid_.vy[p], fluid_.vz[p]}, fluid_.volume[p]);
    }
    return sums.finish(fluid_count_);
  }

  StepTimes times() const override { return times_; }

  std::string name() const override {
    return "CPU, " + std::to_string(team_.size()) + (team_.size() == 1 ? " thread" : " threads");
  }

 private:
  void load(const ParticleStart& start) {
    fluid_.resize(start.positions.size());
    std::fill(fluid_.volume.begin(), fluid_.volume.end(), context_.rest_volume);
    scratch_.resize(start.positions.size());
    for (std::size_t i = 0; i < start.positions.size(); ++i) {
      const glm::vec3& x = start.positions[i];
      const glm::vec3& v = start.velocities[i];
      fluid_.x[i] = x.x;
      fluid_.y[i] = x.y;
      fluid_.z[i] = x.z;
      fluid_.vx[i] = v.x;
      fluid_.vy[i] = v.y;
      fluid_.vz[i] = v.z;
      fluid_.id[i] = static_cast<std::uint32_t>(i);
      fluid_.kind[i] = start.kinds[i];
      fluid_.key[i] = start.keys[i];
    }
    context_.status = start.status;
    fluid_.active = start.positions.size();
  }

  // Probes are particles that their body carries: their state goes in before the passes, the force comes out
  // after.
  void carry_probes_in(std::span<const RigidBody> bodies) {
    if (probes_.empty()) return;
    for (std::size_t p = 0; p < fluid_.active; ++p) {
      if (fluid_.id[p] < fluid_count_) continue;
      const RigidBody& body = bodies[probes_[fluid_.id[p] - fluid_count_].body];
      fluid_.x[p] = static_cast<float>(body.position.x);
      fluid_.y[p] = static_cast<float>(body.position.y);
      fluid_.z[p] = static_cast<float>(body.position.z);
      fluid_.vx[p] = static_cast<float>(body.velocity.x);
      fluid_.vy[p] = static_cast<float>(body.velocity.y);
      fluid_.vz[p] = static_cast<float>(body.velocity.z);
      // A probe that a hand takes out of the domain comes back with it: it waits in the nearest cell.
      fluid_.key[p] = context_.grid.cell_of(fluid_.x[p], fluid_.y[p], fluid_.z[p]);
    }
  }

  void carry_probe_forces_out(std::span<Wrench> wrenches) const {
    if (probes_.empty()) return;
    for (std::size_t p = 0; p < fluid_.active; ++p) {
      if (fluid_.id[p] < fluid_count_) continue;
      wrenches[probes_[fluid_.id[p] - fluid_count_].body].force +=
          glm::dvec3(fluid_.fx[p], fluid_.fy[p], fluid_.fz[p]);
    }
  }

  PassContext context_;
  ThreadTeam team_;
  FluidParticles fluid_, scratch_;
  KeySorter sorter_;
  BodySurface fixed_, moving_;
  std::vector<Probe> probes_;
  std::vector<std::uint8_t> kinds_;  // by id
  std::size_t fluid_count_;          // without probes
  std::vector<char> wanted_;         // one a body: its wrench is summed
  bool fixed_measured_ = false;
  std::vector<glm::vec3> body_scratch_;
  StepTimes times_;
};

}  // namespace

std::unique_ptr<ParticleEngine> make_cpu_engine(const RunConstants& constants, const ParticleStart& start,
                                                std::span<const RigidBody> bodies, int threads) {
  return std::make_unique<CpuEngine>(constants, start, bodies, threads);
}

}  // namespace slosh
