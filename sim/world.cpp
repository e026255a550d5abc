// What a world offers. What it is made of, and the sub-step, are in world_parts.h.
#include "sim/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "sim/hash.h"
#include "sim/shell.h"
#include "sim/steadiness.h"
#include "sim/step_limits.h"
#include "sim/stopwatch.h"
#include "sim/world_parts.h"

namespace slosh {

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
World::World(const Scene& scene, const SampledScene& sampled, Plan plan, WorldOptions options)
    : impl_(std::make_unique<Impl>(scene, sampled, std::move(plan), options)) {
  if (options.backend == Backend::kCuda) impl_->options.backend = Backend::kAuto;
  impl_->start(sampled);
}
Result<World> make_world(const Scene& scene, const SampledScene& sampled, Plan plan, WorldOptions options) {
  if (const std::optional<Error> error = refuse_endless(scene, plan)) return *error;
  if (const std::optional<Error> error = check_cut_bodies(scene)) return *error;
  auto impl = std::make_unique<World::Impl>(scene, sampled, std::move(plan), options);
  if (const std::optional<Error> error = impl->start(sampled)) return *error;
  return World(std::move(impl));
}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

void World::step(std::span<const HandleInput> handles) {
  Impl& w = *impl_;
  Stopwatch whole;
  w.begin_step();
  w.status |= w.bodies.begin_step(handles, w.plan().time_step);
  for (int i = 0; i < w.plan().sub_steps; ++i) {
    w.run(w.sub_step(i));
  }
  if (w.plan().has(PassId::kJoints)) w.bodies.change_joints(w.plan().time_step);
  ++w.tick;
  if (w.bodies.blades().any()) w.cut_through();
  w.times.total = whole.lap();
}

double World::settle(double seconds, std::span<const HandleInput> handles, bool (*stopped)(),
                     double longest) {
  // Where fluid comes to rest does not hang on its viscosity, only when.
  const std::vector<Fluid> fluids = impl_->scene.fluids;
  const bool thick = impl_->thin_fluids(kMaxSettlingViscosity);
  const double done = impl_->come_to_rest(seconds, handles, stopped, longest);
  if (!thick) return done;
  impl_->scene.fluids = fluids;
  impl_->take_parameters();
  return done;
}

double World::Impl::come_to_rest(double seconds, std::span<const HandleInput> handles, bool (*stopped)(),
                                 double longest) {
  Impl& w = *this;
  Steadiness felt;
  double done = 0.0;
  for (; done < seconds || (done < longest && !handles.empty() && !felt.steady());
       done += w.plan().time_step) {
    if (stopped && stopped()) return done;
    const bool with_bodies = !handles.empty() && done >= 0.5 * seconds;
    w.begin_step();
    if (with_bodies) w.status |= w.bodies.begin_step(handles, w.plan().time_step);
    for (int i = 0; i < w.plan().sub_steps; ++i) {
      SubStep step = w.sub_step(i);
      step.elapsed = 0.0;  // the hands stand still
      step.part = with_bodies ? TakePart::kHeld : TakePart::kFluid;
      w.run(step);
    }
    if (with_bodies) felt.feel(w.bodies.grips(), w.plan().time_step);
  }
  return done;
}

const Plan& World::plan() const {
  return impl_->constants.plan;
}
double World::time() const {
  return static_cast<double>(impl_->tick) * impl_->constants.plan.time_step;
}
std::uint64_t World::tick() const {
  return impl_->tick;
}
std::size_t World::fluid_count() const {
  return impl_->fluid_count;
}
MassProperties World::mass(std::size_t body) const {
  const std::vector<RigidBody>& bodies = impl_->bodies.bodies();
  if (body >= bodies.size() || !bodies[body].free) return {0.0, glm::dvec3(0.0), glm::dmat3(0.0)};
  const RigidBody& is = bodies[body];
  return {is.mass, is.local_center, is.inertia};
}
std::size_t World::boundary_count() const {
  return impl_->boundary_count;
}
const StepTimes& World::times() const {
  return impl_->times;
}

void World::fill(BodySnapshot& out) const {
  out.tick = impl_->tick;
  out.time = time();
  out.status = impl_->status | impl_->engine->status();
  const std::vector<RigidBody>& bodies = impl_->bodies.bodies();
  out.bodies.resize(bodies.size());
  for (std::size_t b = 0; b < out.bodies.size(); ++b) {
    const RigidBody& body = bodies[b];
    out.bodies[b] = {body.mesh_pose(),
                     {body.velocity, body.angular_velocity},
                     body.position,
                     impl_->wrenches[b],
                     body.gone};
  }
  out.grips = impl_->bodies.grips();
  for (std::size_t g = 0; g < out.grips.size(); ++g) {
    const Grip& grip = impl_->scene.grips[g];
    const RigidBody& body = bodies[grip.body];
    out.grips[g].pose = compose(body.mesh_pose(), grip.pose);
    out.grips[g].twist = {body.velocity_at(out.grips[g].pose.position), body.angular_velocity};
    out.grips[g].stiffness = impl_->bodies.grip_stiffness().acting[g];
  }
  impl_->bodies.joints().fill(bodies, out.joints);
  out.waiting = impl_->waiting;
  out.cuts = impl_->cuts_told;
}

void World::fill(Snapshot& out, bool with_shell) const {
  fill(out.rigid);
  out.positions.resize(impl_->fluid_count);
  out.fluid_index.resize(impl_->fluid_count);
  out.on_gpu = impl_->engine->fill_shared(out.positions, out.fluid_index);
  out.shell.clear();
  if (with_shell) find_shell(out.positions, out.fluid_index, impl_->constants.plan.spacing, out.shell);
}

void World::fill_later(Snapshot& out) const {
  fill(out.rigid);
  out.shell.clear();
  out.fetch = impl_->engine->fill_later(out.on_gpu);
  if (!out.fetch) return fill(out);
  out.to_come = impl_->fluid_count;
}

Result<bool> World::share_particles() {
  return impl_->engine->share();
}

namespace {

/// f(id, particles, i) for each fluid particle that is in the world; for none when the GPU failed.
template <class F>
void for_each_by_id(const World::Impl& w, F&& f) {
  ParticleState particles;
  ImpulseSums walls;
  if (!w.engine->save(particles, walls)) return;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const std::size_t id = particles.id[i];
    if (id >= w.fluid_count || particles.key[i] == w.constants.grid.retired_key()) continue;
    f(id, particles, i);
  }
}

constexpr float kNotThere = std::numeric_limits<float>::quiet_NaN();

}  // namespace

void World::fill_pressures(std::vector<float>& out) const {
  const Impl& w = *impl_;
  out.assign(w.fluid_count, kNotThere);
  for_each_by_id(w, [&](std::size_t id, const ParticleState& particles, std::size_t i) {
    if (w.plan().has(PassId::kPressureSolve)) {
      out[id] = particles.solved[i];
      return;
    }
    // The volume is what the density pass left; a bulk-damped pressure is not kept.
    const ParticleKind& kind = w.constants.kinds[w.fluid_of[id]];
    const float compression = w.constants.rest_volume / particles.volume[i] - 1.0f;
    out[id] = static_cast<float>(w.plan().stiffness) * kind.pressing_density * compression;
  });
}

void World::fill_heat(std::vector<float>& temperatures, std::vector<float>& cures) const {
  const Impl& w = *impl_;
  for (std::vector<float>* out : {&temperatures, &cures}) out->assign(w.fluid_count, kNotThere);
  const bool passed = w.plan().has(PassId::kHeat);
  for_each_by_id(w, [&](std::size_t id, const ParticleState& particles, std::size_t i) {
    const Heat& start = w.scene.fluids[w.fluid_of[id]].heat;
    temperatures[id] = passed ? particles.temperature[i] : static_cast<float>(start.temperature);
    cures[id] = passed ? particles.cure[i] : start.starts_set ? 1.0f : 0.0f;
  });
}

void World::fill_velocities(std::vector<glm::vec3>& out) const {
  out.assign(impl_->fluid_count, glm::vec3(kNotThere));
  for_each_by_id(*impl_, [&](std::size_t id, const ParticleState& particles, std::size_t i) {
    out[id] = {particles.vx[i], particles.vy[i], particles.vz[i]};
  });
}

Result<bool> World::save(std::vector<std::uint8_t>& out) const {
  const Impl& w = *impl_;
  SavedState state;
  state.tick = w.tick;
  state.status = w.status | w.engine->status();
  state.gravity_scale = w.gravity_scale;
  state.age = w.age;
  state.waiting = w.waiting;
  for (const Fluid& fluid : w.scene.fluids) state.viscosities.push_back(fluid.dynamic_viscosity);
  state.bodies = w.bodies.bodies();
  state.planes = w.bodies.cuts().all_planes();
  state.incisions = w.bodies.blades().kept();
  state.wrenches = w.wrenches;
  state.grips = w.bodies.grips();
  state.last_input = w.bodies.last_inputs();
  state.grip_stiffness = w.bodies.grip_stiffness();
  state.impulses = w.bodies.kept_impulses();
  state.joints = w.bodies.joints().kept();
  state.joint_means = w.bodies.joints().means();
  if (!w.engine->save(state.particles, state.walls) || !w.engine->save_bonds(state.bonds))
    return Error{"the world", "cannot be saved: " + w.engine->failure(), "Run again with the CPU backend"};
  write_state(w.frame, w.constants, state, out);
  return true;
}

Result<bool> World::restore(std::span<const std::uint8_t> saved) {
  Impl& w = *impl_;
  SavedState state;
  state.bodies = w.bodies.bodies();
  const Result<bool> read = read_state(saved, w.frame, w.constants, state);
  if (!read) return read;
  for (std::size_t f = 0; f < state.viscosities.size(); ++f) {
    if (state.viscosities[f] == w.live.first_viscosity(f)) continue;
    const Result<bool> allowed = w.live.allow_viscosity(w.scene, w.plan(), f, state.viscosities[f]);
    if (!allowed) return allowed;
  }
  const Result<bool> gravity = w.live.allow_gravity(w.scene, w.plan(), state.gravity_scale);
  if (!gravity) return gravity;
  for (std::size_t g = 0; g < state.grip_stiffness.wanted.size(); ++g) {
    for (const double scale : {state.grip_stiffness.wanted[g], state.grip_stiffness.acting[g]}) {
      const Result<bool> allowed = allow_grip_stiffness(w.scene, g, scale);
      if (!allowed) return allowed;
    }
  }

  Result<std::vector<World::Impl::Reshaping>> cut = w.shapes_of(state);
  if (!cut) return cut.error();

  for (std::size_t f = 0; f < state.viscosities.size(); ++f)
    w.scene.fluids[f].dynamic_viscosity = state.viscosities[f];
  w.gravity_scale = state.gravity_scale;
  w.take_parameters();
  w.wrenches = std::move(state.wrenches);
  w.bodies.restore(std::move(state.bodies), std::move(state.grips), std::move(state.last_input),
                   std::move(state.grip_stiffness), std::move(state.impulses));
  w.bodies.restore_joints(std::move(state.joints), std::move(state.joint_means));
  w.engine->restore(state.particles, state.walls);
  for (const World::Impl::Reshaping& each : cut.value()) {
    w.bodies.reshape(static_cast<int>(each.body), each.shape);
    w.reshape(each.body, each.shape, each.particles, glm::dvec3(0.0));
  }
  w.bodies.restore(std::move(state.incisions));
  w.cuts_told = w.bodies.cuts().told(state.tick);
  if (w.plan().has(PassId::kBonds)) w.engine->restore_bonds(state.bonds);
  std::fill(w.found.begin(), w.found.end(), Wrench{});
  std::fill(w.drag_matrices.begin(), w.drag_matrices.end(), Matrix6{});
  w.status = state.status & ~kStatusDeviceLost;
  w.tick = state.tick;
  w.age = state.age;
  w.waiting = state.waiting;
  w.packed = false;
  return true;
}

Result<bool> World::set_viscosity(std::size_t fluid, double pascal_seconds) {
  const Result<bool> allowed =
      impl_->live.allow_viscosity(impl_->scene, impl_->plan(), fluid, pascal_seconds);
  if (!allowed) return allowed;
  impl_->scene.fluids[fluid].dynamic_viscosity = pascal_seconds;
  impl_->take_parameters();
  return true;
}

Result<bool> World::set_gravity_scale(double scale) {
  const Result<bool> allowed = impl_->live.allow_gravity(impl_->scene, impl_->plan(), scale);
  if (!allowed) return allowed;
  impl_->gravity_scale = scale;
  impl_->take_parameters();
  return true;
}

Result<bool> World::set_grip_stiffness(std::size_t grip, double scale) {
  const Result<bool> allowed = allow_grip_stiffness(impl_->scene, grip, scale);
  if (!allowed) return allowed;
  impl_->bodies.want_grip_stiffness(grip, scale);
  return true;
}

std::span<const double> World::grip_stiffness() const {
  return impl_->bodies.grip_stiffness().wanted;
}

double World::viscosity(std::size_t fluid) const {
  return fluid < impl_->scene.fluids.size() ? impl_->scene.fluids[fluid].dynamic_viscosity : 0.0;
}
double World::gravity_scale() const {
  return impl_->gravity_scale;
}

std::span<const Wrench> World::fluid_wrenches() const {
  return impl_->found;
}
std::span<const Matrix6> World::drags() const {
  if (!impl_->plan().runs.has_any_of({PassId::kBodyDrag, PassId::kImplicitViscosity})) return {};
  return impl_->drag_matrices;
}

std::uint32_t World::take_status() {
  return std::exchange(impl_->status, 0u) | impl_->engine->take_status();
}

std::uint64_t World::hash() const {
  Fingerprint print;
  impl_->engine->add_to(print);
  for (const RigidBody& body : impl_->bodies.bodies()) {
    print.add(body.position);
    print.add(body.orientation);
    print.add(body.velocity);
    print.add(body.angular_momentum);
  }
  return print.value();
}

Diagnostics World::diagnostics() const {
  Diagnostics d = impl_->engine->diagnostics();
  if (impl_->waiting == 0) return d;
  d.retired = static_cast<std::uint64_t>(
      std::max<std::int64_t>(0, static_cast<std::int64_t>(d.retired) - impl_->waiting));
  if (!impl_->plan().walls_hold()) d.lost = d.retired;
  d.lost = std::min(d.lost, d.retired);
  d.spilled = d.retired - d.lost;
  return d;
}
std::string World::failure() const {
  return impl_->engine->failure();
}
std::string World::backend() const {
  return impl_->engine->name();
}

}  // namespace slosh
