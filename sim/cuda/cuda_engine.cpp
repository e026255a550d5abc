#include "sim/cuda/cuda_engine.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>

#include "sim/cuda/device_particles.h"
#include "sim/cuda/pass_clock.h"
#include "sim/fluid_sums.h"
#include "sim/pass_table.h"

namespace slosh {

namespace cuda {
namespace {

constexpr std::uint32_t kChunk = 1024;  // body particles that one block sums

StepConstants step_constants(const RunConstants& c) {
  return {c.grid,
          c.support_radius,
          c.force_scale,
          c.rest_number_density,
          c.rest_volume,
          static_cast<float>(c.plan.stiffness),
          static_cast<float>(c.plan.tension),
          c.gravity,
          c.correction};
}

// The head of what comes back each step; the wrenches and the probes' forces follow it.
struct alignas(16) ReportHead {
  std::uint32_t status = 0;
};

// One column's part of a pack.
template <class T>
auto& lane(T& pack, int index) {
  if constexpr (std::is_same_v<std::remove_const_t<T>, float4>) {
    return (&pack.x)[index];
  } else {
    return pack;
  }
}

using HostState = MovingPacks<PlainColumn>;

// Calls f(column, value) for each column of one particle that outlives a step.
template <class Packs, class F>
void for_each_value(Packs& packs, std::size_t p, F&& f) {
  for_each_column([&](auto column) {
    constexpr ColumnInfo kInfo = info(decltype(column)::value);
    for_each_pack(
        [&](auto pack, auto& values) {
          if constexpr (decltype(pack)::value == kInfo.pack) f(column, lane(values[p], kInfo.lane));
        },
        packs);
  });
}

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
    check_.ok(cudaEventCreateWithFlags(&ready_, cudaEventDisableTiming), "cudaEventCreate");
    clock_.start(check_);
    fluid_.allocate(kinds_by_id_.size(), constants_, check_);
    fixed_.allocate(start.fixed, constants_, check_);
    moving_.allocate(start.moving, constants_, check_);
    const std::size_t largest = std::max({start.particles.size(), start.fixed.size(), start.moving.size()});
    space_.allocate(static_cast<std::uint32_t>(largest), std::bit_width(constants_.grid.retired_key()),
                    check_);
    kinds_.upload(constants_.kinds, check_);
    plan_wrenches(start, bodies);
    plan_guards(start);
    allocate_exchange(bodies.size());
    check_.ok(cudaDeviceSynchronize(), "setting up");  // the stream does not wait for what filled the buffers
    restore(start.particles, no_impulses(bodies.size()));
    status_ = start.status;
    if (fixed_.count() > 0) {
      send_bodies(bodies);
      fixed_.place(step_, bodies_.data(), space_, check_, stream_);
    }
    check_.ok(cudaDeviceSynchronize(), "setting up");
  }

  ~CudaEngine() override {
    if (stream_) cudaStreamSynchronize(stream_);
    if (ready_) cudaEventDestroy(ready_);
    if (stream_) cudaStreamDestroy(stream_);
  }

  void prepare(std::span<const RigidBody> bodies) override {
    if (idle()) return;
    clock_.begin(check_, stream_);
    send_bodies(bodies);
    carry_probes_in(bodies);
    prepared_.assign(bodies.begin(), bodies.end());
    run(SubStepPart::kPrepare, 0.0);
    clock_.mark(PassClock::kSorted, check_, stream_);
  }
  void forces(double dt) override {
    if (idle()) return;
    forces_dt_ = dt;
    take_impulses();
    run(SubStepPart::kForces, dt);
  }
  void advance(double dt, std::span<const RigidBody> after) override {
    if (idle()) return;
    send_guards(after);
    run(SubStepPart::kAdvance, dt);
    clock_.mark(PassClock::kForce, check_, stream_);
    // A probe's force comes out of the last pass, and its place changes before the next sort.
    sorted_ahead_ = probes_.empty();
    if (sorted_ahead_) {
      fluid_.sort(step_, space_, check_, stream_);
    } else {
      fetch_report();
    }
    clock_.mark(PassClock::kEnd, check_, stream_);
  }

  void wrenches(std::span<Wrench> out) override {
    std::fill(out.begin(), out.end(), Wrench{});
    if (idle()) return;
    check_.ok(cudaEventSynchronize(ready_), "waiting for the step");
    clock_.read(check_);
    if (!check_.failed()) read_report(out);
  }

  void body_drags(std::span<BodyDrag> out) const override {
    std::fill(out.begin(), out.end(), BodyDrag{});
    if (idle()) return;
    for (std::size_t i = 0; i < wrench_bodies_.size(); ++i)
      std::memcpy(&out[wrench_bodies_[i]], got_report_.data() + drags_at_ + i * sizeof(BodyDrag),
                  sizeof(BodyDrag));
  }

  void drag(std::span<const Twist> changes) override {
    if (idle()) return;
    for (std::size_t b = 0; b < changes.size(); ++b) {
      sent_twists_[b] = sent_bodies_[b];
      sent_twists_[b].motion.velocity = glm::vec3(changes[b].linear);
      sent_twists_[b].motion.angular_velocity = glm::vec3(changes[b].angular);
    }
    check_.ok(cudaMemcpyAsync(twists_.data(), sent_twists_.data(), twists_.bytes(), cudaMemcpyHostToDevice,
                              stream_),
              "sending twists");
    run(SubStepPart::kDrag, 0.0);
  }
  // No plan for this backend has it (make_plan, make_particle_engine).
  void solve_drag(double, std::span<const ViscousBody>, std::span<Wrench>) override {}

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
    const HostState s = fetch_state();
    impulses = fetch_impulses();
    if (check_.failed()) return false;
    out.resize(s.id.size());
    std::size_t count = 0;
    for (std::size_t p = 0; p < s.id.size(); ++p) {
      if (s.key[p] >= constants_.grid.retired_key()) continue;  // what it leaves behind means nothing
      for_each_value(s, p, [&](auto column, const auto& value) {
        if constexpr (info(column).saved) column_of<column>(out)[count] = value;
      });
      ++count;
    }
    out.resize(count);
    return true;
  }

  void restore(const ParticleState& state, const ImpulseSums& impulses) override {
    if (check_.failed()) return;
    const std::size_t total = kinds_by_id_.size();
    HostState s;
    for_each_pack([total](auto, auto& values) { values.resize(total); }, s);
    std::vector<bool> seen(total, false);
    std::vector<std::uint32_t> slots(probes_.size());
    for (std::size_t p = 0; p < state.size(); ++p) {
      for_each_value(s, p, [&](auto column, auto& value) {
        if constexpr (info(column).saved) value = column_of<column>(state)[p];
      });
      const std::uint32_t id = state.id[p];
      if (id >= fluid_count_) slots[id - fluid_count_] = static_cast<std::uint32_t>(p);
      seen[id] = true;
    }
    std::size_t behind = state.size();
    for (std::uint32_t id = 0; id < total; ++id) {
      if (seen[id]) continue;
      s.id[behind] = id;
      s.key[behind] = constants_.grid.retired_key();
      s.v[behind++].w = constants_.rest_volume;
    }
    for (std::size_t p = 0; p < total; ++p) s.kind[p] = kinds_by_id_[s.id[p]];
    check_.ok(cudaStreamSynchronize(stream_), "waiting for the step");
    fluid_.write(s, check_, stream_);
    probe_slots_.write(slots, check_, stream_);
    impulses_.write(impulses, check_, stream_);
    check_.ok(cudaMemsetAsync(report_.data(), 0, sizeof(ReportHead), stream_), "clearing the status");
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
    std::fill(fluid_index.begin(), fluid_index.end(), std::uint8_t{255});
    if (check_.failed() || positions.empty()) return;
    launch_scatter(step_, fluid_.state(), fluid_.count(), static_cast<std::uint32_t>(fluid_count_),
                   by_id_.data(), kind_by_id_.data(), stream_);
    check_.launched("scattering");
    fetch(by_id_.data(), reinterpret_cast<float*>(positions.data()), 3 * positions.size());
    fetch(kind_by_id_.data(), fluid_index.data(), fluid_index.size());
  }

  void add_to(Fingerprint& print) const override {
    const HostState s = fetch_state();
    for (std::size_t p = 0; p < s.id.size(); ++p) {
      if (s.key[p] >= constants_.grid.retired_key()) continue;
      print.add(s.id[p]);
      for_each_value(s, p, [&](auto column, const auto& value) {
        if constexpr (info(column).hashed && column != FluidColumn::id) print.add(value);
      });
    }
  }

  Diagnostics diagnostics() const override {
    FluidSums sums(constants_);
    const HostState s = fetch_state();
    for (std::size_t p = 0; p < s.id.size(); ++p) {
      if (s.key[p] >= constants_.grid.retired_key()) continue;
      sums.add(s.kind[p], {s.x[p].x, s.x[p].y, s.x[p].z}, {s.v[p].x, s.v[p].y, s.v[p].z}, s.v[p].w);
    }
    sums.add(fetch_impulses());
    return sums.finish(fluid_count_);
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
        {SubStepPart::kForces, {kDensity}, &CudaEngine::find_density, nullptr},
        {SubStepPart::kForces, {kWrenches}, &CudaEngine::sum_wrenches, nullptr},
        {SubStepPart::kForces,
         {kPressureForce, kOneViscosity, kPairViscosity, kWalls},
         &CudaEngine::find_forces,
         nullptr},
        {SubStepPart::kDrag, {kBodyDrag}, &CudaEngine::drag_on_fluid, nullptr},
        {SubStepPart::kAdvance, {kIntegrateFluid}, &CudaEngine::integrate, nullptr},
    };
    static_assert(covers_all_particle_passes(kTable, {kImplicitDrag}));
    return kTable;
  }
  void run(SubStepPart part, double dt) { run_passes(*this, table(), part, constants_.plan, dt, nullptr); }

  bool idle() const { return check_.failed() || fluid_.count() == 0; }

  void sort(double) {
    if (!sorted_ahead_) fluid_.sort(step_, space_, check_, stream_);
  }
  void place_bodies(double) { moving_.place(step_, bodies_.data(), space_, check_, stream_); }

  void find_density(double) {
    if (check_.failed()) return;
    launch_density(step_, constants_.plan, kinds_.data(), fluid_.sorted(), fixed_.sorted(), moving_.sorted(),
                   status_word(), stream_);
    check_.launched("density");
    clock_.mark(PassClock::kDensity, check_, stream_);
  }

  void find_forces(double) {
    if (probes_.empty()) fetch_report();
    clock_.mark(PassClock::kWrench, check_, stream_);
    if (check_.failed()) return;
    launch_force(step_, constants_.plan, kinds_.data(), fluid_.sorted(), fixed_.sorted(), moving_.sorted(),
                 stream_);
    check_.launched("forces");
  }

  void drag_on_fluid(double) {
    if (check_.failed()) return;
    launch_drag(step_, constants_.plan, kinds_.data(), fluid_.sorted(), moving_.sorted(), twists_.data(),
                stream_);
    check_.launched("drag");
  }

  void integrate(double dt) {
    if (check_.failed()) return;
    const ProbeOutput probes{static_cast<std::uint32_t>(fluid_count_),
                             reinterpret_cast<float4*>(report_.data() + probes_at_), probe_slots_.data()};
    launch_integrate(step_, kinds_.data(), fluid_.sorted(), static_cast<float>(dt),
                     static_cast<float>(speed_limit(constants_.plan, dt)), guard_view(), probes, status_word(),
                     stream_);
    check_.launched("integration");
  }

  template <class T>
  void fetch(const T* from, T* to, std::size_t count) const {
    if (check_.failed() || count == 0) return;
    check_.ok(cudaMemcpyAsync(to, from, count * sizeof(T), cudaMemcpyDeviceToHost, stream_), "download");
    check_.ok(cudaStreamSynchronize(stream_), "download");
  }

  HostState fetch_state() const {
    HostState s;
    if (check_.failed()) return s;
    for_each_pack(
        [&](auto, auto& values, const auto* from) {
          values.resize(fluid_.count());
          fetch(from, values.data(), values.size());
        },
        s, fluid_.state());
    if (check_.failed()) return {};
    return s;
  }

  ImpulseSums fetch_impulses() const {
    ImpulseSums sums(impulses_.size());
    fetch(impulses_.data(), sums.data(), sums.size());
    return sums;
  }

  void plan_guards(const ParticleStart& start) {
    if (!constants_.plan.guards_walls()) return;
    std::vector<float> values;
    for (const DistanceField& field : start.guarded)
      values.insert(values.end(), field.distance.begin(), field.distance.end());
    fields_.upload(values, check_);
    const float* at = fields_.data();
    for (const DistanceField& field : start.guarded) {
      views_.push_back({field.origin, field.cell, field.size, field.distance.empty() ? nullptr : at});
      at += field.distance.size();
    }
    guards_.allocate(views_.size(), check_);
    sent_guards_.allocate(views_.size(), check_);
  }

  // The copy before has been made: wrenches() was waited for since, or the bodies stood still.
  void send_guards(std::span<const RigidBody> after) {
    if (guards_.size() == 0 || check_.failed()) return;
    guard_bodies(views_, constants_.plan, prepared_, after, guarded_);
    any_fast_ = false;
    for (std::size_t b = 0; b < guarded_.size(); ++b) {
      sent_guards_[b] = {guarded_[b], after[b].position};
      any_fast_ |= guarded_[b].fast;
    }
    check_.ok(cudaMemcpyAsync(guards_.data(), sent_guards_.data(), guards_.bytes(), cudaMemcpyHostToDevice,
                              stream_),
              "sending walls");
  }

  GuardView guard_view() const {
    return {static_cast<std::uint32_t>(guards_.size()), any_fast_ ? 1u : 0u, guards_.data(),
            reinterpret_cast<unsigned long long*>(impulses_.data()), constants_.impulse_units};
  }

  // What walls took from particles when they moved last goes into this sub-step's report.
  void take_impulses() {
    if (guards_.size() == 0 || check_.failed()) return;
    const std::size_t bytes = guards_.size() * kImpulseWords * sizeof(std::int64_t);
    check_.ok(cudaMemcpyAsync(report_.data() + impulses_at_, impulses_.data(), bytes,
                              cudaMemcpyDeviceToDevice, stream_),
              "handing impulses over");
    check_.ok(cudaMemsetAsync(impulses_.data(), 0, bytes, stream_), "clearing impulses");
  }

  // Cuts each measured body's particles into chunks; local order is body by body.
  void plan_wrenches(const ParticleStart& start, std::span<const RigidBody> bodies) {
    std::vector<std::uint8_t> wanted(bodies.size(), 0);
    for (const int b : constants_.plan.wrench_bodies) wanted[b] = 1;
    std::vector<WrenchChunk> chunks;
    std::vector<WrenchRange> ranges;
    const auto cut = [&](const std::vector<SurfaceParticle>& particles, bool moving) {
      const std::uint32_t count = static_cast<std::uint32_t>(particles.size());
      for (std::uint32_t begin = 0; begin < count;) {
        const std::uint16_t body = particles[begin].body;
        std::uint32_t end = begin;
        while (end < count && particles[end].body == body) ++end;
        if (wanted[body]) {
          const std::uint32_t first = static_cast<std::uint32_t>(chunks.size());
          for (std::uint32_t i = begin; i < end; i += kChunk) {
            chunks.push_back({i, std::min(i + kChunk, end), body, moving ? 1u : 0u});
          }
          ranges.push_back({first, static_cast<std::uint32_t>(chunks.size()), body});
          (moving ? moving_measured_ : fixed_measured_) = true;
        }
        begin = end;
      }
    };
    if (constants_.plan.has(PassId::kWrenches)) {
      cut(start.moving, true);
      cut(start.fixed, false);
    }
    for (const WrenchRange& range : ranges) wrench_bodies_.push_back(range.body);
    wanted_.upload(wanted, check_);
    chunks_.upload(chunks, check_);
    ranges_.upload(ranges, check_);
    partial_.allocate(chunks.size(), check_);
    partial_drags_.allocate(chunks.size(), check_);
  }

  void allocate_exchange(std::size_t body_count) {
    bodies_.allocate(body_count, check_);
    sent_bodies_.allocate(body_count, check_);
    twists_.allocate(body_count, check_);
    sent_twists_.allocate(body_count, check_);
    device_probes_.allocate(probes_.size(), check_);
    sent_probes_.allocate(probes_.size(), check_);
    std::vector<std::uint32_t> slots;
    for (const Probe& probe : probes_) slots.push_back(probe.id);
    probe_slots_.upload(slots, check_);
    wrenches_at_ = sizeof(ReportHead);
    drags_at_ = wrenches_at_ + wrench_bodies_.size() * sizeof(DeviceWrench);
    impulses_at_ = drags_at_ + wrench_bodies_.size() * sizeof(BodyDrag);
    impulses_.allocate(no_impulses(body_count).size(), check_);
    const std::size_t impulses = guards_.size() * kImpulseWords * sizeof(std::int64_t);
    // Whole packs of 16 bytes, as the probes' forces are.
    probes_at_ = (impulses_at_ + impulses + 15) / 16 * 16;
    report_.allocate(probes_at_ + probes_.size() * sizeof(float4), check_);
    got_report_.allocate(report_.size(), check_);
    by_id_.allocate(3 * fluid_count_, check_);
    kind_by_id_.allocate(fluid_count_, check_);
  }

  std::uint32_t* status_word() const { return reinterpret_cast<std::uint32_t*>(report_.data()); }

  void send_bodies(std::span<const RigidBody> bodies) {
    if (bodies.empty() || check_.failed()) return;
    for (std::size_t b = 0; b < bodies.size(); ++b)
      sent_bodies_[b] = {surface_motion(bodies[b]), bodies[b].position};
    check_.ok(cudaMemcpyAsync(bodies_.data(), sent_bodies_.data(), bodies_.bytes(), cudaMemcpyHostToDevice,
                              stream_),
              "sending bodies");
  }

  void carry_probes_in(std::span<const RigidBody> bodies) {
    if (probes_.empty() || check_.failed()) return;
    for (std::size_t i = 0; i < probes_.size(); ++i) {
      const glm::vec3 x(bodies[probes_[i].body].position);
      const glm::vec3 v(bodies[probes_[i].body].velocity);
      sent_probes_[i] = {{x.x, x.y, x.z, 0.0f}, {v.x, v.y, v.z, constants_.rest_volume}};
    }
    check_.ok(cudaMemcpyAsync(device_probes_.data(), sent_probes_.data(), device_probes_.bytes(),
                              cudaMemcpyHostToDevice, stream_),
              "sending probes");
    launch_carry_probes(step_, device_probes_.data(), probe_slots_.data(),
                        static_cast<std::uint32_t>(probes_.size()), fluid_.state(), stream_);
    check_.launched("placing probes");
  }

  void sum_wrenches(double) {
    if (wrench_bodies_.empty() || check_.failed()) return;
    const float first_viscosity = constants_.kinds.front().viscosity;
    const bool with_drag = constants_.plan.has(PassId::kBodyDrag);
    const auto forces = [&](const SurfaceBuffers& surface, bool drag) {
      launch_surface_forces(step_, constants_.plan, first_viscosity, fluid_.sorted(), surface.sorted(),
                            wanted_.data(), surface.local(), drag, stream_);
      check_.launched("forces on bodies");
    };
    if (moving_measured_) forces(moving_, with_drag);
    if (fixed_measured_) forces(fixed_, false);
    launch_wrenches(fixed_.local(), moving_.local(), bodies_.data(), chunks_.data(),
                    static_cast<std::uint32_t>(chunks_.size()), partial_.data(), ranges_.data(),
                    static_cast<std::uint32_t>(ranges_.size()),
                    reinterpret_cast<DeviceWrench*>(report_.data() + wrenches_at_), stream_);
    check_.launched("wrenches");
    if (!with_drag) return;
    launch_body_drags(moving_.local(), bodies_.data(), chunks_.data(),
                      static_cast<std::uint32_t>(chunks_.size()), partial_drags_.data(), ranges_.data(),
                      static_cast<std::uint32_t>(ranges_.size()),
                      reinterpret_cast<BodyDrag*>(report_.data() + drags_at_), stream_);
    check_.launched("drag on bodies");
  }

  void fetch_report() {
    if (check_.failed()) return;
    check_.ok(
        cudaMemcpyAsync(got_report_.data(), report_.data(), report_.bytes(), cudaMemcpyDeviceToHost, stream_),
        "fetching the report");
    check_.ok(cudaEventRecord(ready_, stream_), "cudaEventRecord");
    check_.ok(cudaMemsetAsync(report_.data(), 0, sizeof(ReportHead), stream_), "clearing the status");
  }

  void read_report(std::span<Wrench> wrenches) {
    ReportHead head;
    std::memcpy(&head, got_report_.data(), sizeof head);
    status_ |= head.status;
    for (std::size_t i = 0; i < wrench_bodies_.size(); ++i) {
      DeviceWrench w;
      std::memcpy(&w, got_report_.data() + wrenches_at_ + i * sizeof w, sizeof w);
      wrenches[wrench_bodies_[i]].force += glm::dvec3(w.force[0], w.force[1], w.force[2]);
      wrenches[wrench_bodies_[i]].torque += glm::dvec3(w.torque[0], w.torque[1], w.torque[2]);
    }
    if (guards_.size() > 0) {
      for (const std::uint32_t b : wrench_bodies_) {
        std::int64_t words[kImpulseWords];
        std::memcpy(words, got_report_.data() + impulses_at_ + b * sizeof words, sizeof words);
        wrenches[b] = wrenches[b] + impulse_wrench(words, constants_.impulse_units, forces_dt_);
      }
    }
    if (!constants_.plan.has(PassId::kWrenches)) return;
    for (std::size_t i = 0; i < probes_.size(); ++i) {
      float4 f;
      std::memcpy(&f, got_report_.data() + probes_at_ + i * sizeof f, sizeof f);
      wrenches[probes_[i].body].force += glm::dvec3(f.x, f.y, f.z);
    }
  }

  RunConstants constants_;
  StepConstants step_;
  std::string device_;
  std::vector<Probe> probes_;
  std::vector<std::uint8_t> kinds_by_id_;
  std::size_t fluid_count_;  // without probes
  std::uint32_t status_ = 0;
  mutable CallCheck check_;
  cudaStream_t stream_ = nullptr;
  cudaEvent_t ready_ = nullptr;
  PassClock clock_;
  bool sorted_ahead_ = false;  // the particles are in order for the next step's density

  FluidBuffers fluid_;
  SurfaceBuffers fixed_, moving_;
  SortSpace space_;
  DeviceBuffer<ParticleKind> kinds_;
  DeviceBuffer<std::uint8_t> wanted_;
  DeviceBuffer<WrenchChunk> chunks_;
  DeviceBuffer<WrenchRange> ranges_;
  DeviceBuffer<DeviceWrench> partial_;
  DeviceBuffer<BodyDrag> partial_drags_;
  bool fixed_measured_ = false, moving_measured_ = false;
  std::vector<std::uint32_t> wrench_bodies_;  // body of each range

  DeviceBuffer<DeviceBody> bodies_;
  PinnedBuffer<DeviceBody> sent_bodies_;
  DeviceBuffer<DeviceBody> twists_;  // by which bodies end a step with another velocity
  PinnedBuffer<DeviceBody> sent_twists_;
  DeviceBuffer<DeviceProbe> device_probes_;
  PinnedBuffer<DeviceProbe> sent_probes_;
  DeviceBuffer<std::uint32_t> probe_slots_;
  DeviceBuffer<unsigned char> report_;
  PinnedBuffer<unsigned char> got_report_;
  std::size_t wrenches_at_ = 0, drags_at_ = 0, impulses_at_ = 0, probes_at_ = 0;  // in the report

  std::vector<RigidBody> prepared_;  // as they were in prepare()
  DeviceBuffer<float> fields_;       // of the bodies that particles are guarded against, one after the other
  std::vector<DistanceFieldView> views_;
  std::vector<GuardedBody> guarded_;
  DeviceBuffer<DeviceGuard> guards_;
  PinnedBuffer<DeviceGuard> sent_guards_;
  bool any_fast_ = false;
  DeviceBuffer<std::int64_t> impulses_;  // as ImpulseSums
  double forces_dt_ = 0.0;               // s, of the last forces()
  DeviceBuffer<float> by_id_;
  DeviceBuffer<std::uint8_t> kind_by_id_;
};

}  // namespace
}  // namespace cuda

CudaDevice find_cuda_device() {
  cuda::CallCheck check;
  int count = 0;
  cudaDeviceProp properties{};
  if (check.ok(cudaGetDeviceCount(&count), "no GPU") && count > 0) {
    check.ok(cudaGetDeviceProperties(&properties, 0), "cudaGetDeviceProperties");
    // Runs something: a GPU that this program has no code for is found here.
    cuda::DeviceBuffer<std::uint32_t> probe;
    probe.allocate(1, check);
    if (!check.failed()) {
      cuda::launch_identity(probe.data(), 1, nullptr);
      check.launched("the GPU cannot run this program's code");
      check.ok(cudaDeviceSynchronize(), "the GPU does not answer");
    }
  }
  cudaGetLastError();  // what was asked here is no one else's error
  if (check.failed()) return {false, "", check.failure()};
  if (count == 0) return {false, "", "no GPU"};
  return {true, properties.name, ""};
}

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
