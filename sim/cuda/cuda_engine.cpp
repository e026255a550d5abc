#include "sim/cuda/cuda_engine.h"

#include <algorithm>
#include <bit>

#include "sim/cuda/body_exchange.h"
#include "sim/cuda/downloads.h"
#include "sim/cuda/pass_clock.h"
#include "sim/cuda/pressure_solve.h"
#include "sim/cuda/shared_slots.h"
#include "sim/cuda/step_report.h"
#include "sim/cuda/viscous_solve.h"
#include "sim/cuda/wall_guards.h"
#include "sim/cuda/wrench_sums.h"
#include "sim/fluid_sums.h"
#include "sim/pass_table.h"

namespace slosh {

namespace cuda {
namespace {

class CudaEngine final : public ParticleEngine {
 public:
  CudaEngine(const RunConstants& constants, const ParticleStart& start, std::span<const RigidBody> bodies,
             std::string device)
      : constants_(constants),
        step_(step_constants(constants)),
        device_(std::move(device)),
        probes_(start.probes),
        kinds_by_id_(start.particles.kind),
        fluid_count_(start.fluid_count) {
    check_.ok(cudaStreamCreateWithFlags(&stream_, cudaStreamNonBlocking), "cudaStreamCreate");
    clock_.start(check_);
    fluid_.allocate(kinds_by_id_.size(), constants_, check_);
    fixed_.allocate(start.fixed, constants_, check_);
    moving_.allocate(start.moving, constants_, check_);
    const std::size_t largest = std::max({start.particles.size(), start.fixed.size(), start.moving.size()});
    space_.allocate(static_cast<std::uint32_t>(largest), std::bit_width(constants_.grid.retired_key()),
                    check_);
    kinds_.upload(constants_.kinds, check_);
    sums_.plan(constants_.plan, start, bodies.size(), check_);
    guards_.plan(constants_, start, bodies.size(), check_);
    viscous_.plan(constants_.plan, start, bodies.size(), sums_, check_);
    pressure_.plan(constants_.plan, start, bodies.size(), sums_, check_);
    report_.plan(sums_.bodies().size(), guards_.handed_bytes(), probes_.size(), check_);
    sent_.allocate(bodies.size(), check_);
    sent_probes_.allocate(probes_, check_);
    by_id_.allocate(3 * fluid_count_, check_);
    kind_by_id_.allocate(fluid_count_, check_);
    check_.ok(cudaDeviceSynchronize(), "setting up");  // the stream does not wait for what filled the buffers
    restore(start.particles, no_impulses(bodies.size()));
    status_ = start.status;
    if (fixed_.count() > 0) {
      sent_.send(bodies, check_, stream_);
      fixed_.place(step_, sent_.bodies(), space_, check_, stream_);
    }
    check_.ok(cudaDeviceSynchronize(), "setting up");
  }

  ~CudaEngine() override {
    if (!stream_) return;
    cudaStreamSynchronize(stream_);
    cudaStreamDestroy(stream_);
  }

  void prepare(std::span<const RigidBody> bodies) override {
    if (idle()) return;
    clock_.begin(check_, stream_);
    sent_.send(bodies, check_, stream_);
    sent_probes_.carry(step_, constants_.rest_volume, probes_, bodies, fluid_.state(), check_, stream_);
    prepared_.assign(bodies.begin(), bodies.end());
    run(SubStepPart::kPrepare, 0.0);
    clock_.mark(PassClock::kSorted, check_, stream_);
  }
  void forces(double dt) override {
    if (idle()) return;
    forces_dt_ = dt;
    // What walls took from particles when they moved last goes into this sub-step's report.
    guards_.hand_over(report_.impulses(), check_, stream_);
    run(SubStepPart::kForces, dt);
  }
  void advance(double dt, std::span<const RigidBody> after) override {
    if (idle()) return;
    guards_.send(constants_.plan, prepared_, after, check_, stream_);
    run(SubStepPart::kAdvance, dt);
    clock_.mark(PassClock::kForce, check_, stream_);
    // A probe's place changes before the next sort.
    sorted_ahead_ = probes_.empty();
    if (sorted_ahead_) fluid_.sort(step_, space_, check_, stream_);
    if (probes_report()) report_.fetch(check_, stream_);
    clock_.mark(PassClock::kEnd, check_, stream_);
  }

  void wrenches(std::span<Wrench> out) override {
    std::fill(out.begin(), out.end(), Wrench{});
    if (idle()) return;
    report_.wait(check_);
    clock_.read(check_);
    if (!check_.failed()) read_report(out);
  }

  void body_drags(std::span<BodyDrag> out) const override {
    std::fill(out.begin(), out.end(), BodyDrag{});
    if (idle()) return;
    if (constants_.plan.has(PassId::kImplicitViscosity)) return viscous_.drags(out);
    for (std::size_t i = 0; i < sums_.bodies().size(); ++i) out[sums_.bodies()[i]] = report_.got_drag(i);
  }

  void drag(std::span<const Twist> changes) override {
    if (idle()) return;
    sent_.send_twists(changes, check_, stream_);
    run(SubStepPart::kDrag, 0.0);
  }
  void solve_viscosity(double dt, std::span<const ViscousBody> bodies, std::span<Wrench> wrenches) override {
    if (idle()) return;
    asked_ = {bodies, wrenches};
    run(SubStepPart::kViscosity, dt);
  }
  void solve_pressure(double dt, std::span<const ViscousBody> bodies, std::span<Wrench> wrenches) override {
    if (idle()) return;
    asked_ = {bodies, wrenches};
    run(SubStepPart::kPressure, dt);
  }

  void damp(float keep) override {
    if (idle()) return;
    launch_damp(fluid_.state().v, fluid_.count(), keep, stream_);
    check_.launched("damping");
  }

  void set_constants(const RunConstants& constants) override {
    constants_ = constants;
    step_ = step_constants(constants_);
    if (check_.failed()) return;
    kinds_.write(constants_.kinds, check_, stream_);
    fluid_.allow_viscosities(constants_, check_);
  }
  void set_correction(const CorrectionConstants& correction) override { step_.correction = correction; }

  bool save(ParticleState& out, ImpulseSums& impulses) const override {
    const HostPacks packs = fetch_packs(fluid_, check_, stream_);
    impulses = fetch_impulses(guards_, check_, stream_);
    if (check_.failed()) return false;
    to_state(packs, constants_.grid, out);
    out.broken = broken_before_ + broken(packs, constants_.grid);
    return true;
  }

  void restore(const ParticleState& state, const ImpulseSums& impulses) override {
    if (check_.failed()) return;
    std::vector<std::uint32_t> slots(probes_.size());
    for (std::size_t p = 0; p < state.size(); ++p) {
      const std::uint32_t id = state.id[p];
      if (id >= fluid_count_) slots[id - fluid_count_] = static_cast<std::uint32_t>(p);
    }
    const HostPacks packs = from_state(state, constants_.grid, constants_.rest_volume, kinds_by_id_);
    const std::uint64_t among_them = broken(packs, constants_.grid);  // that the sort has not taken out yet
    broken_before_ = state.broken - std::min(state.broken, among_them);
    check_.ok(cudaStreamSynchronize(stream_), "waiting for the step");
    fluid_.write(packs, check_, stream_);
    sent_probes_.write_slots(slots, check_, stream_);
    guards_.write(impulses, check_, stream_);
    report_.clear_status(check_, stream_);
    sorted_ahead_ = false;
    status_ = 0;
  }

  std::uint32_t status() const override { return status_ | (check_.failed() ? kStatusDeviceLost : 0u); }
  std::uint32_t take_status() override {
    const std::uint32_t seen = status();
    status_ = 0;
    return seen;
  }

  void fill(std::span<glm::vec3> positions, std::span<std::uint8_t> fluid_index) const override {
    fill_by({by_id_.data(), kind_by_id_.data(), nullptr}, positions, fluid_index);
  }
  std::shared_ptr<const SharedParticles> fill_shared(std::span<glm::vec3> positions,
                                                     std::span<std::uint8_t> fluid_index) const override {
    const SharedSlots::Slot slot = shared_.take();
    if (!slot.particles || positions.empty()) {
      fill(positions, fluid_index);
      return nullptr;
    }
    fill_by(slot, positions, fluid_index);
    return check_.failed() ? nullptr : slot.particles;
  }
  Result<bool> share() override { return shared_.start(fluid_count_); }

  void add_to(Fingerprint& print) const override {
    const HostPacks packs = fetch_packs(fluid_, check_, stream_);
    for_each_present(packs, constants_.grid, [&](std::size_t p) {
      print.add(packs.id[p]);
      for_each_value(packs, p, [&](auto column, const auto& value) {
        if constexpr (info(column).hashed && column != FluidColumn::id) print.add(value);
      });
    });
  }

  Diagnostics diagnostics() const override {
    FluidSums sums(constants_);
    const HostPacks packs = fetch_packs(fluid_, check_, stream_);
    for_each_present(packs, constants_.grid, [&](std::size_t p) {
      const float4 x = packs.x[p], v = packs.v[p];
      sums.add(packs.kind[p], {x.x, x.y, x.z}, {v.x, v.y, v.z}, v.w);
    });
    sums.add(fetch_impulses(guards_, check_, stream_));
    return sums.finish(fluid_count_, broken_before_ + broken(packs, constants_.grid));
  }

  StepTimes times() const override { return clock_.times(); }
  std::string failure() const override { return check_.failure(); }
  std::string name() const override { return "CUDA, " + device_; }

 private:
  static std::span<const PassRow<CudaEngine>> table() {
    using enum PassId;
    // The wrenches come before the forces on the fluid: the bodies' solve on the CPU needs them alone, and
    // runs while the GPU goes on.
    static constexpr PassRow<CudaEngine> kTable[] = {
        {SubStepPart::kPrepare, {kSortFluid}, &CudaEngine::sort, nullptr},
        {SubStepPart::kPrepare, {kPlaceBodies}, &CudaEngine::place_bodies, nullptr},
        {SubStepPart::kForces, {kDensity, kFluidStress}, &CudaEngine::find_density, nullptr},
        {SubStepPart::kForces, {kWrenches}, &CudaEngine::sum_wrenches, nullptr},
        {SubStepPart::kForces,
         {kPressureForce, kOneViscosity, kPairViscosity, kWalls},
         &CudaEngine::find_forces,
         nullptr},
        {SubStepPart::kViscosity, {kImplicitViscosity}, &CudaEngine::find_implicit_viscosity, nullptr},
        {SubStepPart::kPressure, {kPressureSolve}, &CudaEngine::solve_for_pressure, nullptr},
        {SubStepPart::kDrag, {kBodyDrag}, &CudaEngine::drag_on_fluid, nullptr},
        {SubStepPart::kAdvance, {kIntegrateFluid}, &CudaEngine::integrate, nullptr},
    };
    static_assert(covers_all_particle_passes(kTable));
    return kTable;
  }
  void run(SubStepPart part, double dt) { run_passes(*this, table(), part, constants_.plan, dt, nullptr); }

  // A probe's force comes out of the last pass, and the report waits for it; not where the pressures' solve
  // fetches it.
  bool probes_report() const { return !probes_.empty() && !constants_.plan.has(PassId::kPressureSolve); }
  bool idle() const { return check_.failed() || fluid_.count() == 0; }

  void sort(double) {
    if (!sorted_ahead_) fluid_.sort(step_, space_, check_, stream_);
  }
  void place_bodies(double) { moving_.place(step_, sent_.bodies(), space_, check_, stream_); }

  void find_density(double) {
    if (check_.failed()) return;
    launch_density(step_, constants_.plan, kinds_.data(),
                   any_artificial_viscosity(constants_.kinds, constants_.correction.artificial_viscosity),
                   fluid_.sorted(), fixed_.sorted(), moving_.sorted(), report_.status(), stream_);
    check_.launched("density");
    clock_.mark(PassClock::kDensity, check_, stream_);
  }

  void find_forces(double dt) {
    if (!probes_report()) report_.fetch(check_, stream_);
    clock_.mark(PassClock::kWrench, check_, stream_);
    if (check_.failed()) return;
    launch_force(step_, constants_.plan, kinds_.data(), fluid_.sorted(), fixed_.sorted(), moving_.sorted(),
                 stream_);
    check_.launched("forces");
    // While the CPU sees where the bodies are going.
    if (constants_.plan.has(PassId::kImplicitViscosity))
      viscous_.write_rows(solve_sides(), static_cast<float>(dt), check_, stream_);
    if (constants_.plan.has(PassId::kPressureSolve)) pressure_.push_by_last(solve_sides(), check_, stream_);
  }

  SolveSides solve_sides() const {
    return {step_,           constants_.plan, kinds_,  constants_.kinds.front().viscosity,
            fluid_.sorted(), fixed_,          moving_, sent_.bodies()};
  }
  void find_implicit_viscosity(double dt) {
    viscous_.solve(solve_sides(), static_cast<float>(dt), asked_.bodies, prepared_, report_.status(),
                   asked_.wrenches, check_, stream_);
  }
  void solve_for_pressure(double dt) {
    pressure_.solve(solve_sides(), dt, asked_.bodies, prepared_, probes_, asked_.wrenches, check_, stream_);
  }

  void drag_on_fluid(double) {
    if (check_.failed()) return;
    launch_drag(step_, constants_.plan, kinds_.data(), fluid_.sorted(), moving_.sorted(), sent_.twists(),
                stream_);
    check_.launched("drag");
  }

  void integrate(double dt) {
    if (check_.failed()) return;
    const ProbeOutput probes{static_cast<std::uint32_t>(fluid_count_), report_.probes(),
                             sent_probes_.slots().data()};
    launch_integrate(step_, kinds_.data(), fluid_.sorted(), static_cast<float>(dt),
                     static_cast<float>(speed_limit(constants_.plan, dt)),
                     guards_.view(constants_.impulse_units), probes, report_.status(), stream_);
    check_.launched("integration");
  }

  /// By way of a place on the GPU that is its own by the time this returns.
  void fill_by(const SharedSlots::Slot& way, std::span<glm::vec3> positions,
               std::span<std::uint8_t> fluid_index) const {
    std::fill(fluid_index.begin(), fluid_index.end(), std::uint8_t{255});
    if (check_.failed() || positions.empty()) return;
    launch_scatter(step_, fluid_.state(), fluid_.count(), static_cast<std::uint32_t>(fluid_count_),
                   way.positions, way.kinds, stream_);
    check_.launched("scattering");
    fetch(way.positions, reinterpret_cast<float*>(positions.data()), 3 * positions.size(), check_, stream_);
    fetch(way.kinds, fluid_index.data(), fluid_index.size(), check_, stream_);
  }

  void sum_wrenches(double) {
    const bool with_drag = constants_.plan.has(PassId::kBodyDrag);
    const SurfaceSides sides{fixed_, moving_};
    sums_.find_forces(step_, constants_.plan, constants_.kinds.front().viscosity, fluid_.sorted(), sides,
                      with_drag, check_, stream_);
    sums_.sum_wrenches(sides, sent_.bodies(), report_.wrenches(), check_, stream_);
    if (with_drag) sums_.sum_drags(sides, sent_.bodies(), report_.drags(), check_, stream_);
  }

  void read_report(std::span<Wrench> wrenches) {
    status_ |= report_.got_status();
    for (std::size_t i = 0; i < sums_.bodies().size(); ++i) {
      const std::uint32_t b = sums_.bodies()[i];
      // Fixed ones are measured when all of the pressure is known.
      if (constants_.plan.has(PassId::kPressureSolve) && !prepared_[b].free) continue;
      wrenches[b] = wrenches[b] + report_.got_wrench(i).wrench();
    }
    if (guards_.size() > 0) {
      for (const std::uint32_t b : sums_.bodies()) {
        std::int64_t words[kImpulseWords];
        report_.got_impulses(b, words);
        wrenches[b] = wrenches[b] + impulse_wrench(words, constants_.impulse_units, forces_dt_);
      }
    }
    if (!constants_.plan.has(PassId::kWrenches) || !probes_report()) return;
    for (std::size_t i = 0; i < probes_.size(); ++i) {
      const float4 f = report_.got_probe(i);
      wrenches[probes_[i].body].force += glm::dvec3(f.x, f.y, f.z);
    }
  }

  struct Asked {  // of solve_viscosity() and solve_pressure()
    std::span<const ViscousBody> bodies;
    std::span<Wrench> wrenches;
  };

  RunConstants constants_;
  StepConstants step_;
  std::string device_;
  std::vector<Probe> probes_;
  std::vector<std::uint8_t> kinds_by_id_;
  std::size_t fluid_count_;  // without probes
  std::uint32_t status_ = 0;
  std::uint64_t broken_before_ = 0;  // of ParticleState's, those that restore() took over and dropped
  mutable CallCheck check_;
  cudaStream_t stream_ = nullptr;
  PassClock clock_;
  bool sorted_ahead_ = false;  // the particles are in order for the next step's density

  FluidBuffers fluid_;
  SurfaceBuffers fixed_, moving_;
  SortSpace space_;
  DeviceBuffer<ParticleKind> kinds_;
  WrenchSums sums_;
  WallGuards guards_;
  StepReport report_;
  ViscousSolver viscous_;
  PressureSolver pressure_;
  Asked asked_;

  SentBodies sent_;
  SentProbes sent_probes_;
  std::vector<RigidBody> prepared_;  // as they were in prepare()
  double forces_dt_ = 0.0;           // s, of the last forces()
  DeviceBuffer<float> by_id_;
  DeviceBuffer<std::uint8_t> kind_by_id_;
  SharedSlots shared_;
};

}  // namespace
}  // namespace cuda

Result<std::unique_ptr<ParticleEngine>> make_cuda_engine(const RunConstants& constants,
                                                         const ParticleStart& start,
                                                         std::span<const RigidBody> bodies) {
  const CudaDevice device = find_cuda_device();
  if (!device.available) return Error{"backend cuda", device.reason, "Use the CPU backend"};
  auto engine = std::make_unique<cuda::CudaEngine>(constants, start, bodies, device.name);
  if (!engine->failure().empty()) {
    const std::string failure = engine->failure();
    engine.reset();
    cudaGetLastError();
    return Error{"backend cuda", failure,
                 "Use the CPU backend, or a coarser spacing if the GPU's memory ran out"};
  }
  return std::unique_ptr<ParticleEngine>(std::move(engine));
}

}  // namespace slosh
