#include "sim/cpu/cpu_engine.h"

#include <algorithm>

#include "sim/cpu/passes.h"
#include "sim/cpu/pressure_solve.h"
#include "sim/cpu/viscous_solve.h"
#include "sim/fluid_sums.h"
#include "sim/pass_table.h"

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
        kinds_(start.particles.kind),
        fluid_count_(start.fluid_count),
        fields_(start.guarded),
        impulses_(no_impulses(bodies.size())),
        bodies_(bodies.begin(), bodies.end()),
        found_(bodies.size()),
        drags_(bodies.size()) {
    static_cast<RunConstants&>(context_) = constants;
    wanted_.assign(bodies.size(), 0);
    for (const int b : constants.plan.wrench_bodies) wanted_[b] = 1;
    fixed_measured_ = std::any_of(constants.plan.wrench_bodies.begin(), constants.plan.wrench_bodies.end(),
                                  [&](int b) { return !bodies[b].free; });
    fluid_.provide(context_.plan, kinds_.size());
    scratch_.provide(context_.plan, kinds_.size());
    for (const DistanceField& field : fields_)
      views_.push_back(field.distance.empty() ? DistanceFieldView{} : field.view());
    restore(start.particles, impulses_);
    context_.status = start.status;
    fixed_.place(context_, bodies);
  }

  void prepare(std::span<const RigidBody> bodies) override {
    bodies_.assign(bodies.begin(), bodies.end());
    times_ = StepTimes{};
    run(SubStepPart::kPrepare, 0.0);
  }
  void forces(double dt) override {
    std::fill(found_.begin(), found_.end(), Wrench{});
    std::fill(drags_.begin(), drags_.end(), BodyDrag{});
    run(SubStepPart::kForces, dt);
    give_impulses(dt);
  }
  void advance(double dt, std::span<const RigidBody> after) override {
    centers_.clear();
    for (const RigidBody& body : after) centers_.push_back(body.position);
    if (context_.plan.guards_walls()) guard_bodies(views_, context_.plan, bodies_, after, guarded_);
    run(SubStepPart::kAdvance, dt);
  }
  void wrenches(std::span<Wrench> out) override { std::copy(found_.begin(), found_.end(), out.begin()); }
  void body_drags(std::span<BodyDrag> out) const override {
    std::copy(drags_.begin(), drags_.end(), out.begin());
  }
  void drag(std::span<const Twist> changes) override {
    moving_.set_velocities(bodies_, changes);
    run(SubStepPart::kDrag, 0.0);
  }

  void solve_viscosity(double dt, std::span<const ViscousBody> bodies, std::span<Wrench> wrenches) override {
    viscous_ = {bodies, wrenches};
    run(SubStepPart::kViscosity, dt);
  }

  void solve_pressure(double dt, std::span<const ViscousBody> bodies, std::span<Wrench> wrenches) override {
    viscous_ = {bodies, wrenches};
    run(SubStepPart::kPressure, dt);
  }

  void damp(float keep) override {
    for (Column<float>* column : {&fluid_.vx, &fluid_.vy, &fluid_.vz}) {
      for (std::size_t p = 0; p < fluid_.active; ++p) (*column)[p] *= keep;
    }
  }

  void set_constants(const RunConstants& constants) override {
    static_cast<RunConstants&>(context_) = constants;
    fluid_.provide(context_.plan, kinds_.size());
  }
  void set_correction(const CorrectionConstants& correction) override { context_.correction = correction; }

  bool save(ParticleState& out, ImpulseSums& impulses) const override {
    impulses = impulses_;
    out.broken = context_.broken;
    out.resize(fluid_.active);
    for_each_column(
        [&](auto column, const auto& from, auto& to) {
          if constexpr (info(column).saved) {
            if (!from.empty()) std::copy_n(from.begin(), fluid_.active, to.begin());
          }
        },
        fluid_, out);
    return true;
  }

  void restore(const ParticleState& state, const ImpulseSums& impulses) override {
    impulses_ = impulses;
    for_each_column(
        [](auto column, const auto& from, auto& to) {
          if constexpr (info(column).saved) {
            if (!to.empty()) std::copy(from.begin(), from.end(), to.begin());
          }
        },
        state, fluid_);
    for (std::size_t p = 0; p < state.size(); ++p) fluid_.kind[p] = kinds_[state.id[p]];
    fluid_.active = state.size();
    context_.status = 0;
    context_.broken = state.broken;
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
      for_each_column(
          [&](auto column, const auto& values) {
            if constexpr (info(column).hashed && column != FluidColumn::id) print.add(values[p]);
          },
          fluid_);
    }
  }

  Diagnostics diagnostics() const override {
    FluidSums sums(context_);
    for (std::size_t p = 0; p < fluid_.active; ++p) {
      if (fluid_.key[p] >= context_.grid.retired_key()) continue;
      sums.add(fluid_.kind[p], {fluid_.x[p], fluid_.y[p], fluid_.z[p]},
               {fluid_.vx[p], fluid_.vy[p], fluid_.vz[p]}, fluid_.volume[p]);
    }
    sums.add(impulses_);
    return sums.finish(fluid_count_, context_.broken);
  }

  StepTimes times() const override { return times_; }

  std::string name() const override {
    return "CPU, " + std::to_string(team_.size()) + (team_.size() == 1 ? " thread" : " threads");
  }

 private:
  static std::span<const PassRow<CpuEngine>> table() {
    using enum PassId;
    static constexpr PassRow<CpuEngine> kTable[] = {
        {SubStepPart::kPrepare, {kSortFluid}, &CpuEngine::sort, &StepTimes::sort},
        {SubStepPart::kPrepare, {kPlaceBodies}, &CpuEngine::place_bodies, &StepTimes::sort},
        {SubStepPart::kForces, {kDensity, kFluidStress}, &CpuEngine::find_density, &StepTimes::density},
        {SubStepPart::kForces,
         {kPressureForce, kOneViscosity, kPairViscosity, kWalls},
         &CpuEngine::find_forces,
         &StepTimes::force},
        {SubStepPart::kForces, {kWrenches}, &CpuEngine::sum_wrenches, &StepTimes::force},
        {SubStepPart::kViscosity,
         {kImplicitViscosity},
         &CpuEngine::find_implicit_viscosity,
         &StepTimes::force},
        {SubStepPart::kPressure, {kPressureSolve}, &CpuEngine::solve_for_pressure, &StepTimes::force},
        {SubStepPart::kDrag, {kBodyDrag}, &CpuEngine::drag_on_fluid, &StepTimes::force},
        {SubStepPart::kAdvance, {kIntegrateFluid}, &CpuEngine::integrate, &StepTimes::force},
    };
    static_assert(covers_all_particle_passes(kTable));
    return kTable;
  }
  void run(SubStepPart part, double dt) { run_passes(*this, table(), part, context_.plan, dt, &times_); }

  void sort(double) {
    carry_probes_in();
    sort_fluid(context_, team_, fluid_, sorter_, scratch_);
  }
  void place_bodies(double) { moving_.place(context_, bodies_); }
  void find_density(double) {
    compute_density(context_, team_, fluid_, fixed_.sorted(), moving_.sorted(), pressure_rows_);
  }
  void find_forces(double dt) {
    compute_fluid_forces(context_, team_, fluid_, fixed_.sorted(), moving_.sorted(), dt, fluid_viscosity_,
                         pressure_rows_);
    if (context_.plan.has(PassId::kPressureSolve))
      pressure_solver_.push_by_last(context_, team_, {fluid_, moving_.sorted(), bodies_, pressure_rows_});
  }
  void sum_wrenches(double) {
    centers_.clear();
    for (const RigidBody& body : bodies_) centers_.push_back(body.position);
    const auto sum = [&](const BodySurface& surface, std::span<BodyDrag> drags) {
      sum_body_wrenches(context_, team_, fluid_, surface.sorted(), centers_, wanted_, body_scratch_, found_,
                        drags);
    };
    sum(moving_, context_.plan.has(PassId::kBodyDrag) ? std::span(drags_) : std::span<BodyDrag>());
    // Fixed ones are measured when all of the pressure is known.
    if (fixed_measured_ && !context_.plan.has(PassId::kPressureSolve)) sum(fixed_, {});
    if (!context_.plan.has(PassId::kPressureSolve)) carry_probe_forces_out(found_);
  }
  void drag_on_fluid(double) { drag_fluid(context_, team_, fluid_, moving_.sorted()); }
  void find_implicit_viscosity(double dt) {
    const ViscousReport report =
        solver_.solve(context_, team_, {fluid_, fixed_.sorted(), moving_, bodies_, fluid_viscosity_}, dt,
                      viscous_.bodies, wanted_, viscous_.wrenches);
    drags_ = solver_.drags();
    if (!report.converged) context_.status.fetch_or(kStatusViscosityCut, std::memory_order_relaxed);
  }
  void solve_for_pressure(double dt) {
    pressure_solver_.solve(context_, team_, {fluid_, moving_.sorted(), bodies_, pressure_rows_}, dt,
                           viscous_.bodies, viscous_.wrenches);
    if (fixed_measured_)
      sum_body_wrenches(context_, team_, fluid_, fixed_.sorted(), centers_, wanted_, body_scratch_,
                        viscous_.wrenches, {});
    carry_probe_forces_out(viscous_.wrenches);
  }
  void integrate(double dt) { integrate_fluid(context_, team_, fluid_, {guarded_, centers_, impulses_}, dt); }

  // What walls took from particles when they moved last acts on the bodies now.
  void give_impulses(double dt) {
    if (!context_.plan.guards_walls()) return;
    for (std::size_t b = 0; b < found_.size(); ++b) {
      const std::span<std::int64_t> words(impulses_.data() + kImpulseWords * b, kImpulseWords);
      if (wanted_[b]) found_[b] = found_[b] + impulse_wrench(words, context_.impulse_units, dt);
      std::fill(words.begin(), words.end(), 0);
    }
  }

  // Probes are particles that their body carries: their state goes in before the passes, the force comes out
  // after.
  void carry_probes_in() {
    if (probes_.empty()) return;
    for (std::size_t p = 0; p < fluid_.active; ++p) {
      if (fluid_.id[p] < fluid_count_) continue;
      const RigidBody& body = bodies_[probes_[fluid_.id[p] - fluid_count_].body];
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

  void carry_probe_forces_out(std::span<Wrench> out) const {
    if (probes_.empty()) return;
    for (std::size_t p = 0; p < fluid_.active; ++p) {
      if (fluid_.id[p] < fluid_count_) continue;
      out[probes_[fluid_.id[p] - fluid_count_].body].force +=
          glm::dvec3(fluid_.fx[p], fluid_.fy[p], fluid_.fz[p]);
    }
  }

  // What solve_viscosity() and solve_pressure() are called with.
  struct Viscous {
    std::span<const ViscousBody> bodies;
    std::span<Wrench> wrenches;
  };

  PassContext context_;
  ThreadTeam team_;
  FluidParticles fluid_;
  GatheredColumns scratch_;
  KeySorter sorter_;
  BodySurface fixed_, moving_;
  std::vector<Probe> probes_;
  std::vector<std::uint8_t> kinds_;  // by id
  std::size_t fluid_count_;          // without probes
  std::vector<char> wanted_;         // one a body: its wrench is summed
  bool fixed_measured_ = false;
  std::vector<DistanceField> fields_;  // of the bodies with a penetration clamp
  std::vector<DistanceFieldView> views_;
  std::vector<GuardedBody> guarded_;
  ImpulseSums impulses_;
  std::vector<RigidBody> bodies_;  // as they were in prepare()
  std::vector<glm::dvec3> centers_;
  std::vector<Wrench> found_;    // one a body, by the last forces()
  std::vector<BodyDrag> drags_;  // one a body, by the same
  SurfaceSums body_scratch_;
  FluidViscosity fluid_viscosity_;
  ViscousSolver solver_;
  FluidPress pressure_rows_;
  PressureSolver pressure_solver_;
  Viscous viscous_;
  StepTimes times_;
};

}  // namespace

std::unique_ptr<ParticleEngine> make_cpu_engine(const RunConstants& constants, const ParticleStart& start,
                                                std::span<const RigidBody> bodies, int threads) {
  return std::make_unique<CpuEngine>(constants, start, bodies, threads);
}

}  // namespace slosh
