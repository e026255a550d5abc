#include "sim/cuda/cuda_engine.h"

#include "sim/cuda/downloads.h"
#include "sim/cuda/shared_slots.h"
#include "sim/cuda/state.h"
#include "sim/fluid_sums.h"
#include "sim/math/format.h"

namespace slosh {

namespace passes {
#define SLOSH_OWN(id, name) void name##_on_cuda(cuda::CudaState& state, const PassInputs& inputs);
#define SLOSH_NONE(...)
SLOSH_PASSES(SLOSH_OWN, SLOSH_NONE, SLOSH_NONE)
#undef SLOSH_OWN
}  // namespace passes

namespace cuda {
namespace {

using CudaPass = void (*)(CudaState&, const PassInputs&);

CudaPass function_of(PassId id) {
  switch (id) {
#define SLOSH_OWN(id, name) \
  case PassId::id:          \
    return passes::name##_on_cuda;
    SLOSH_PASSES(SLOSH_OWN, SLOSH_NONE, SLOSH_NONE)
#undef SLOSH_OWN
#undef SLOSH_NONE
    default:
      return nullptr;
  }
}

/// An event that outlives the engine, for who waits for it later.
class OwnedEvent {
 public:
  OwnedEvent() = default;
  OwnedEvent(const OwnedEvent&) = delete;
  OwnedEvent& operator=(const OwnedEvent&) = delete;
  ~OwnedEvent() {
    if (event_) cudaEventDestroy(event_);
  }
  /// False after a failure.
  bool record(CallCheck& check, cudaStream_t stream) {
    if (!check.failed())
      check.ok(cudaEventCreateWithFlags(&event_, cudaEventDisableTiming), "cudaEventCreate");
    if (!check.failed()) check.ok(cudaEventRecord(event_, stream), "cudaEventRecord");
    return !check.failed();
  }
  void wait(CallCheck& check) const {
    if (!check.failed()) check.ok(cudaEventSynchronize(event_), "waiting for the picture's particles");
  }

 private:
  cudaEvent_t event_ = nullptr;
};

class CudaEngine final : public ParticleEngine {
 public:
  CudaEngine(const RunConstants& constants, const ParticleStart& start, std::span<const RigidBody> bodies,
             std::string device, int gpu)
      : s_(constants, start, bodies),
        device_(std::move(device)),
        gpu_(gpu),
        kinds_by_id_(start.particles.kind) {
    by_id_.allocate(3 * s_.fluid_count, s_.check);
    kind_by_id_.allocate(s_.fluid_count, s_.check);
    s_.check.ok(cudaDeviceSynchronize(),
                "setting up");  // the stream does not wait for what filled the buffers
    restore(start.particles, no_impulses(bodies.size()));
    status_ = start.status;
    if (s_.fixed.count() > 0) {
      s_.sent.send(bodies, s_.check, s_.stream);
      s_.fixed.place(s_.step, s_.sent.bodies(), s_.space, s_.check, s_.stream);
    }
    s_.check.ok(cudaDeviceSynchronize(), "setting up");
  }

  void begin(std::span<const RigidBody> bodies, double dt) override {
    use_gpu();
    if (s_.idle()) return;
    s_.clock.begin(s_.check, s_.stream);
    s_.sent.send(bodies, s_.check, s_.stream);
    s_.sent_probes.carry(s_.step, s_.constants.rest_volume, s_.probes, bodies, s_.fluid.state(), s_.check,
                         s_.stream);
    s_.prepared.assign(bodies.begin(), bodies.end());
    begun_dt_ = dt;
    // What walls took from particles when they moved last goes into this sub-step's report.
    s_.clamps.hand_over(s_.report.impulses(), s_.check, s_.stream);
  }
  void run(PassId id, const PassInputs& inputs) override {
    if (s_.idle()) return;
    function_of(id)(s_, inputs);
    s_.clock.ended(id, s_.check, s_.stream);
  }

  void wrenches(std::span<Wrench> out) override {
    std::fill(out.begin(), out.end(), Wrench{});
    if (s_.idle()) return;
    s_.report.wait(s_.check);
    s_.clock.read(s_.check);
    if (!s_.check.failed()) read_report(out);
  }

  void body_drags(std::span<BodyDrag> out) const override {
    std::fill(out.begin(), out.end(), BodyDrag{});
    if (s_.idle()) return;
    if (s_.constants.plan.has(PassId::kImplicitViscosity)) return s_.viscous.drags(out);
    for (std::size_t i = 0; i < s_.sums.bodies().size(); ++i)
      out[s_.sums.bodies()[i]] = s_.report.got_drag(i);
  }

  void damp(float keep) override {
    use_gpu();
    if (s_.idle()) return;
    launch_damp(s_.fluid.state().v, s_.fluid.count(), keep, s_.stream);
    s_.check.launched("damping");
  }

  void set_constants(const RunConstants& constants) override {
    use_gpu();
    s_.constants = constants;
    s_.step = step_constants(s_.constants);
    if (s_.check.failed()) return;
    s_.kinds.write(s_.constants.kinds, s_.check, s_.stream);
    s_.fluid.allow_viscosities(s_.constants, s_.check);
  }
  void set_correction(const CorrectionConstants& correction) override { s_.step.correction = correction; }

  bool save(ParticleState& out, ImpulseSums& impulses) const override {
    use_gpu();
    const HostPacks packs = fetch_packs(s_.fluid, s_.check, s_.stream);
    impulses = fetch_impulses(s_.clamps, s_.check, s_.stream);
    if (s_.check.failed()) return false;
    to_state(packs, s_.step.grid, s_.constants.grid, out);
    out.broken = broken_before_ + broken(packs, s_.step.grid);
    return true;
  }

  void restore(const ParticleState& state, const ImpulseSums& impulses) override {
    use_gpu();
    if (s_.check.failed()) return;
    std::vector<std::uint32_t> slots(s_.probes.size());
    for (std::size_t p = 0; p < state.size(); ++p) {
      const std::uint32_t id = state.id[p];
      if (id >= s_.fluid_count) slots[id - s_.fluid_count] = static_cast<std::uint32_t>(p);
    }
    const HostPacks packs =
        from_state(state, s_.constants.grid, s_.step.grid, s_.constants.rest_volume, kinds_by_id_);
    const std::uint64_t among_them = broken(packs, s_.step.grid);  // that the sort has not taken out yet
    broken_before_ = state.broken - std::min(state.broken, among_them);
    s_.check.ok(cudaStreamSynchronize(s_.stream), "waiting for the step");
    s_.fluid.write(packs, s_.check, s_.stream);
    s_.sent_probes.write_slots(slots, s_.check, s_.stream);
    s_.clamps.write(impulses, s_.check, s_.stream);
    s_.report.clear_status(s_.check, s_.stream);
    s_.sorted_ahead = false;
    status_ = 0;
  }

  void reshape(const ReshapedBody& as) override {
    use_gpu();
    if (s_.check.failed()) return;
    s_.check.ok(cudaStreamSynchronize(s_.stream), "waiting for the step");
    s_.moving.replace(as.first, as.particles, s_.check, s_.stream);
    s_.clamps.reshape(as.body, *as.clamp, s_.check, s_.stream);
    if (as.recentred == glm::dvec3(0.0)) return;
    ImpulseSums impulses = fetch_impulses(s_.clamps, s_.check, s_.stream);
    if (s_.check.failed()) return;
    const std::size_t at = kImpulseWords * as.body;
    recentre(std::span(impulses).subspan(at, kImpulseWords), as.recentred, s_.constants.impulse_units);
    s_.clamps.write(impulses, s_.check, s_.stream);
  }

  bool save_bonds(BondTable& out) const override {
    out = {};
    if (!s_.constants.plan.has(PassId::kBonds)) return true;
    use_gpu();
    out.resize(kinds_by_id_.size());
    const BondView view = s_.bonds.view();
    fetch(view.bonds, out.bonds.data(), out.bonds.size(), s_.check, s_.stream);
    fetch(view.count, out.count.data(), out.count.size(), s_.check, s_.stream);
    fetch(view.weight, out.weight.data(), out.weight.size(), s_.check, s_.stream);
    fetch(view.set, out.set.data(), out.set.size(), s_.check, s_.stream);
    return !s_.check.failed();
  }
  void restore_bonds(const BondTable& bonds) override {
    use_gpu();
    s_.bonds.write(bonds, s_.check, s_.stream);
  }

  std::uint32_t status() const override { return status_ | (s_.check.failed() ? kStatusDeviceLost : 0u); }
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
    return s_.check.failed() ? nullptr : slot.particles;
  }
  ParticleFetch fill_later(std::shared_ptr<const SharedParticles>& on_gpu) const override {
    const SharedSlots::Slot slot = shared_.take();
    on_gpu = slot.particles;
    if (!slot.particles || s_.fluid_count == 0) return {};
    use_gpu();
    scatter_to(slot);
    auto scattered = std::make_shared<OwnedEvent>();
    if (!scattered->record(s_.check, s_.stream)) return {};
    return
        [slot, scattered, gpu = gpu_](std::span<glm::vec3> positions, std::span<std::uint8_t> fluid_index) {
          CallCheck check;
          check.ok(cudaSetDevice(gpu), "choosing the GPU");
          scattered->wait(check);
          fetch(slot.positions, reinterpret_cast<float*>(positions.data()), 3 * positions.size(), check,
                cudaStreamPerThread);
          fetch(slot.kinds, fluid_index.data(), fluid_index.size(), check, cudaStreamPerThread);
          if (check.failed()) std::fill(fluid_index.begin(), fluid_index.end(), std::uint8_t{255});
        };
  }
  Result<bool> share() override {
    use_gpu();
    return shared_.start(s_.fluid_count);
  }

  void add_to(Fingerprint& print) const override {
    use_gpu();
    const HostPacks packs = fetch_packs(s_.fluid, s_.check, s_.stream);
    for_each_present(packs, s_.step.grid, [&](std::size_t p) {
      print.add(packs.id[p]);
      for_each_value(packs, p, [&](auto column, const auto& value) {
        if constexpr (info(column).hashed && column != FluidColumn::id) {
          if (needs(s_.constants.plan, info(column).need)) print.add(value);
        }
      });
    });
  }

  Diagnostics diagnostics() const override {
    use_gpu();
    FluidSums sums(s_.constants);
    const HostPacks packs = fetch_packs(s_.fluid, s_.check, s_.stream);
    for_each_present(packs, s_.step.grid, [&](std::size_t p) {
      const float4 x = packs.x[p], v = packs.v[p];
      sums.add(packs.kind[p], {x.x, x.y, x.z}, {v.x, v.y, v.z}, v.w);
      if (!s_.constants.plan.has(PassId::kHeat)) return;
      const float4 heat = packs.heat[p];
      sums.add_heat(packs.kind[p], heat.x, heat.y, heat.z);
    });
    sums.add(fetch_impulses(s_.clamps, s_.check, s_.stream));
    return sums.finish(s_.fluid_count, broken_before_ + broken(packs, s_.step.grid));
  }

  const StepTimes* times() const override { return &s_.clock.times(); }
  std::string failure() const override { return s_.check.failure(); }
  std::string name() const override { return "CUDA, " + device_; }

 private:
  /// CUDA keeps a thread's choice, and who steps the world may not be who made it.
  void use_gpu() const { s_.check.ok(cudaSetDevice(gpu_), "choosing the GPU"); }

  void scatter_to(const SharedSlots::Slot& way) const {
    if (s_.check.failed()) return;
    launch_scatter(s_.step, s_.fluid.state(), s_.fluid.count(), static_cast<std::uint32_t>(s_.fluid_count),
                   way.positions, way.kinds, s_.stream);
    s_.check.launched("scattering");
  }
  /// By way of a place on the GPU that is its own by the time this returns.
  void fill_by(const SharedSlots::Slot& way, std::span<glm::vec3> positions,
               std::span<std::uint8_t> fluid_index) const {
    use_gpu();
    std::fill(fluid_index.begin(), fluid_index.end(), std::uint8_t{255});
    if (s_.check.failed() || positions.empty()) return;
    scatter_to(way);
    fetch(way.positions, reinterpret_cast<float*>(positions.data()), 3 * positions.size(), s_.check,
          s_.stream);
    fetch(way.kinds, fluid_index.data(), fluid_index.size(), s_.check, s_.stream);
  }

  void read_report(std::span<Wrench> wrenches) {
    status_ |= s_.report.got_status();
    for (std::size_t i = 0; i < s_.sums.bodies().size(); ++i) {
      const std::uint32_t b = s_.sums.bodies()[i];
      // Fixed ones are measured when all of the pressure is known.
      if (s_.constants.plan.has(PassId::kPressureSolve) && s_.prepared[b].is_fixed()) continue;
      wrenches[b] = wrenches[b] + s_.report.got_wrench(i).wrench();
    }
    if (s_.clamps.size() > 0) {
      for (const std::uint32_t b : s_.sums.bodies()) {
        std::int64_t words[kImpulseWords];
        s_.report.got_impulses(b, words);
        wrenches[b] = wrenches[b] + impulse_wrench(words, s_.constants.impulse_units, begun_dt_);
      }
    }
    if (!s_.constants.plan.has(PassId::kWrenches) || !s_.probes_report()) return;
    for (std::size_t i = 0; i < s_.probes.size(); ++i) {
      const float4 f = s_.report.got_probe(i);
      wrenches[s_.probes[i].body].force += glm::dvec3(f.x, f.y, f.z);
    }
  }

  CudaState s_;
  std::string device_;
  int gpu_ = 0;
  std::vector<std::uint8_t> kinds_by_id_;
  std::uint32_t status_ = 0;
  std::uint64_t broken_before_ = 0;  // of ParticleState's, those that restore() took over and dropped
  double begun_dt_ = 0.0;            // s, of the sub-step
  DeviceBuffer<float> by_id_;
  DeviceBuffer<std::uint8_t> kind_by_id_;
  SharedSlots shared_;
};

}  // namespace
}  // namespace cuda

Result<std::unique_ptr<ParticleEngine>> make_cuda_engine(const RunConstants& constants,
                                                         const ParticleStart& start,
                                                         std::span<const RigidBody> bodies, int gpu) {
  const CudaDevice device = find_cuda_device(gpu);
  if (!device.available) return Error{"backend cuda", device.reason, "Use the CPU backend"};
  cudaSetDevice(gpu);
  auto engine = std::make_unique<cuda::CudaEngine>(constants, start, bodies, device.name, gpu);
  if (!engine->failure().empty()) {
    const std::string failure = engine->failure();
    engine.reset();
    cudaGetLastError();
    return Error{"backend cuda", failure,
                 "Use the CPU backend, or a coarser spacing if the GPU's memory ran out"};
  }
  return std::unique_ptr<ParticleEngine>(std::move(engine));
}

std::string cuda_variant(const Plan& plan, std::uint32_t fluid, int gpu) {
  int major = 0, minor = 0;
  cudaSetDevice(gpu);
  cudaDeviceGetAttribute(&major, cudaDevAttrComputeCapabilityMajor, gpu);
  cudaDeviceGetAttribute(&minor, cudaDevAttrComputeCapabilityMinor, gpu);
  const auto threads = [&](const cuda::TeamSizes& sizes, const char* pass) {
    const std::uint32_t lanes = sizes.lanes(fluid);
    const std::uint32_t most = lanes == 4 ? sizes.four : lanes == 2 ? sizes.two : 0;
    return format("%u thread%s a particle%s (%s than %u thousand fluid particles)", lanes,
                  lanes == 1 ? "" : "s", pass, most > 0 ? "no more" : "more",
                  (most > 0 ? most : std::max(sizes.four, sizes.two)) / 1000);
  };
  return (corrects_gradients(plan.model) ? threads(cuda::kTensorTeams, "")
                                         : threads(cuda::kDensityTeams, " in density") + ", " +
                                               threads(cuda::kForceTeams, " in forces")) +
         (cuda::launches_early() ? ", a kernel comes up while the last one ends"
                                 : ", a kernel comes up when the last one has ended") +
         format(" (compute capability %d.%d)", major, minor);
}

}  // namespace slosh
