// One step: sub-steps of particles, then bodies, each by the passes of the plan.
#include "sim/world.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "sim/bodies/body_system.h"
#include "sim/hash.h"
#include "sim/live_changes.h"
#include "sim/particle_engine.h"
#include "sim/pressure/settled_packing.h"
#include "sim/saved_state.h"
#include "sim/shell.h"
#include "sim/step_limits.h"
#include "sim/stopwatch.h"

namespace slosh {

namespace {

// Who moves in a sub-step.
enum class TakePart { kFluid, kHeld, kAll };

}  // namespace

struct World::Impl {
  Impl(const Scene& scene_in, const SampledScene& sampled, Plan plan_in, WorldOptions options_in)
      : scene(scene_in),
        options(options_in),
        constants(make_run_constants(scene, sampled, std::move(plan_in))),
        bodies(scene, sampled),
        live(scene, constants.plan),
        found(scene.bodies.size()),
        drags(scene.bodies.size()),
        drag_matrices(scene.bodies.size()),
        viscous_bodies(scene.bodies.size()),
        wrenches(scene.bodies.size()) {
    scene.meshes.clear();  // the surface particles stand for them from here on
  }

  // Error: the backend that was asked for is not there.
  std::optional<Error> start(const SampledScene& sampled) {
    const ParticleStart particles = make_particle_start(scene, sampled, constants, bodies.bodies());
    frame = state_frame(scene, constants.plan, particles);
    fluid_count = particles.fluid_count;
    fluid_of = sampled.fluid_index;
    boundary_count = particles.fixed.size() + particles.moving.size();
    Result<std::unique_ptr<ParticleEngine>> made =
        make_particle_engine(constants, particles, bodies.bodies(), options);
    if (!made) return made.error();
    engine = std::move(made.value());
    return std::nullopt;
  }

  const Plan& plan() const { return constants.plan; }

  // What a live change means for everybody who has a copy of it.
  void take_parameters() {
    plan_viscosity(scene, constants.plan);
    constants.kinds = particle_kinds(scene, constants.plan.spacing);
    constants.gravity = glm::vec3(gravity_scale * scene.gravity);
    engine->set_constants(constants);
    packed = false;
  }

  // The fluid's age, and what it presses by at it.
  void grow_older(double dt) {
    if (packed) return;
    if (corrects_gradients(plan().model))
      engine->set_correction(settled(constants.correction, constants.load_compression, age));
    packed = age >= kSettlingTime;
    if (!packed) age += dt;
  }

  SubStep sub_step(int index) const {
    const double share = 1.0 / plan().sub_steps;
    const double dt = plan().time_step * share;
    return {dt, index * dt, share};
  }

  void begin_step() {
    std::fill(wrenches.begin(), wrenches.end(), Wrench{});
    times = StepTimes{};
  }

  // The fluid, and the bodies as far as they take part. Where the fluid is dragged by what the bodies' solve
  // finds, or must not pass walls that move, it waits for it; else it goes on while they are solved (on a
  // GPU).
  void run(const SubStep& step, TakePart part) {
    const bool fluid = plan().has_fluid();
    const bool moving = part != TakePart::kFluid;
    const bool implicit = fluid && plan().has(PassId::kImplicitDrag);
    const bool pressed = fluid && plan().has(PassId::kPressureSolve);
    const bool fluid_waits = implicit || pressed || (moving && plan().fluid_waits());
    if (fluid) {
      grow_older(step.dt);
      engine->prepare(bodies.bodies());
      engine->forces(step.dt);
      if (!fluid_waits) engine->advance(step.dt, expected(step, moving));
      engine->wrenches(found);
    }
    if (implicit) drag_implicitly(step, moving, part == TakePart::kHeld);
    const bool with_drag = moving && plan().has(PassId::kBodyDrag);
    if (pressed) solve_pressure(step, moving, part == TakePart::kHeld, with_drag);
    if (moving) solve_bodies(step, part == TakePart::kHeld, with_drag);
    if (with_drag) engine->drag(bodies.changes());
    if (moving) {
      Stopwatch watch;
      bodies.move(plan(), step);
      times.body += watch.lap();
    }
    if (fluid_waits) engine->advance(step.dt, bodies.bodies());
    if (fluid) report(step);
  }

  void drag_implicitly(const SubStep& step, bool moving, bool held_only) {
    bodies.predict(plan(), {found, {}, gravity_scale * scene.gravity}, step, moving, held_only, viscous_bodies);
    engine->solve_drag(step.dt, viscous_bodies, found);
    take_drags();
  }

  void solve_pressure(const SubStep& step, bool moving, bool held_only, bool with_drag) {
    if (with_drag) take_drags();
    bodies.predict(plan(),
                   {found, with_drag ? std::span<const Matrix6>(drag_matrices) : std::span<const Matrix6>(),
                    gravity_scale * scene.gravity},
                   step, moving, held_only, viscous_bodies);
    engine->solve_pressure(step.dt, viscous_bodies, found);
  }

  void take_drags() {
    engine->body_drags(drags);
    for (std::size_t b = 0; b < drags.size(); ++b) drag_matrices[b] = drags[b].matrix();
  }

  // Where the bodies will be, as far as that is known before their solve.
  std::span<const RigidBody> expected(const SubStep& step, bool moving) {
    if (!moving || !plan().guards_walls() || !plan().has(PassId::kPlaceBodies)) return bodies.bodies();
    ahead = bodies.bodies();
    for (RigidBody& body : ahead) {
      if (!body.free) continue;
      body.position += step.dt * body.velocity;
      body.orientation = rotate_by(body.orientation, step.dt * body.angular_velocity);
    }
    return ahead;
  }

  void solve_bodies(const SubStep& step, bool held_only, bool with_drag) {
    Stopwatch watch;
    if (with_drag) take_drags();
    const std::span<const Matrix6> drag =
        with_drag ? std::span<const Matrix6>(drag_matrices) : std::span<const Matrix6>();
    status |= bodies.solve(plan(), {found, drag, gravity_scale * scene.gravity}, step, held_only);
    if (with_drag) {
      for (std::size_t b = 0; b < found.size(); ++b)
        found[b] = found[b] + drag_of(drag_matrices[b], bodies.changes()[b]);
    }
    times.body += watch.lap();
  }

  void report(const SubStep& step) {
    for (std::size_t b = 0; b < found.size(); ++b) {
      wrenches[b].force += step.share * found[b].force;
      wrenches[b].torque += step.share * found[b].torque;
    }
    const StepTimes passes = engine->times();
    times.sort += passes.sort;
    times.density += passes.density;
    times.force += passes.force;
  }

  Scene scene;
  WorldOptions options;
  RunConstants constants;
  BodySystem bodies;
  LiveChanges live;
  std::unique_ptr<ParticleEngine> engine;
  std::vector<RigidBody> ahead;  // expected()
  std::vector<Wrench> found;     // by the fluid in the last sub-step, one a body
  std::vector<BodyDrag> drags;   // with kBodyDrag, one a body
  std::vector<Matrix6> drag_matrices;
  std::vector<ViscousBody> viscous_bodies;  // with kImplicitDrag, one a body
  std::vector<Wrench> wrenches;  // their means over the last step
  std::size_t fluid_count = 0;   // without probes
  std::vector<std::uint8_t> fluid_of;  // index into scene.fluids, by id
  std::size_t boundary_count = 0;
  std::uint32_t status = 0;  // of bodies and inputs; the engine has its own
  std::uint64_t tick = 0;
  StepTimes times;
  double gravity_scale = 1.0;
  double age = 0.0;     // s, as pressure/settled_packing.h counts it; no further than kSettlingTime
  bool packed = false;  // the engine has what that age needs, and it needs nothing else any more
  StateFrame frame;
};

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
World::World(const Scene& scene, const SampledScene& sampled, Plan plan, WorldOptions options)
    : impl_(std::make_unique<Impl>(scene, sampled, std::move(plan), options)) {
  if (options.backend == Backend::kCuda) impl_->options.backend = Backend::kAuto;
  impl_->start(sampled);
}
Result<World> make_world(const Scene& scene, const SampledScene& sampled, Plan plan, WorldOptions options) {
  if (const std::optional<Error> error = refuse_endless(scene, plan)) return *error;
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
    w.run(w.sub_step(i), TakePart::kAll);
  }
  w.times.total = whole.lap();
  ++w.tick;
}

void World::settle(double seconds, std::span<const HandleInput> handles, bool (*stopped)()) {
  Impl& w = *impl_;
  constexpr double kDampingTime =
      0.05;  // s: past critical for a hand-sized vessel's slosh, so it creeps to its level
  const double keep = std::exp(-w.sub_step(0).dt / kDampingTime);
  for (double done = 0.0; done < seconds; done += w.plan().time_step) {
    if (stopped && stopped()) return;
    const bool with_bodies = !handles.empty() && done >= 0.5 * seconds;
    w.begin_step();
    if (with_bodies) w.status |= w.bodies.begin_step(handles, w.plan().time_step);
    for (int i = 0; i < w.plan().sub_steps; ++i) {
      SubStep step = w.sub_step(i);
      step.elapsed = 0.0;  // the hands stand still
      w.run(step, with_bodies ? TakePart::kHeld : TakePart::kFluid);
      w.engine->damp(static_cast<float>(keep));
      if (with_bodies) w.bodies.damp_held(keep);
    }
  }
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
    out.bodies[b] = {
        body.mesh_pose(), {body.velocity, body.angular_velocity}, body.position, impl_->wrenches[b]};
  }
  out.grips = impl_->bodies.grips();
  for (std::size_t g = 0; g < out.grips.size(); ++g) {
    const Grip& grip = impl_->scene.grips[g];
    const RigidBody& body = bodies[grip.body];
    out.grips[g].pose = compose(body.mesh_pose(), grip.pose);
    out.grips[g].twist = {body.velocity_at(out.grips[g].pose.position), body.angular_velocity};
  }
}

void World::fill(Snapshot& out, bool with_shell) const {
  fill(out.rigid);
  out.positions.resize(impl_->fluid_count);
  out.fluid_index.resize(impl_->fluid_count);
  impl_->engine->fill(out.positions, out.fluid_index);
  out.shell.clear();
  if (with_shell) find_shell(out.positions, out.fluid_index, impl_->constants.plan.spacing, out.shell);
}

void World::fill_pressures(std::vector<float>& out) const {
  const Impl& w = *impl_;
  out.assign(w.fluid_count, std::numeric_limits<float>::quiet_NaN());
  ParticleState particles;
  ImpulseSums walls;
  if (!w.engine->save(particles, walls)) return;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const std::size_t id = particles.id[i];
    if (id >= out.size() || particles.key[i] == w.constants.grid.retired_key()) continue;
    if (w.plan().has(PassId::kPressureSolve)) {
      out[id] = particles.solved[i];
      continue;
    }
    // The volume is what the density pass left; a bulk-damped pressure is not kept.
    const ParticleKind& kind = w.constants.kinds[w.fluid_of[id]];
    const float compression = w.constants.rest_volume / particles.volume[i] - 1.0f;
    out[id] = static_cast<float>(w.plan().stiffness) * kind.pressing_density * compression;
  }
}

void World::fill_velocities(std::vector<glm::vec3>& out) const {
  const Impl& w = *impl_;
  out.assign(w.fluid_count, glm::vec3(std::numeric_limits<float>::quiet_NaN()));
  ParticleState particles;
  ImpulseSums walls;
  if (!w.engine->save(particles, walls)) return;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const std::size_t id = particles.id[i];
    if (id >= out.size() || particles.key[i] == w.constants.grid.retired_key()) continue;
    out[id] = {particles.vx[i], particles.vy[i], particles.vz[i]};
  }
}

Result<bool> World::save(std::vector<std::uint8_t>& out) const {
  const Impl& w = *impl_;
  SavedState state;
  state.tick = w.tick;
  state.status = w.status | w.engine->status();
  state.gravity_scale = w.gravity_scale;
  state.age = w.age;
  for (const Fluid& fluid : w.scene.fluids) state.viscosities.push_back(fluid.dynamic_viscosity);
  state.bodies = w.bodies.bodies();
  state.wrenches = w.wrenches;
  state.grips = w.bodies.grips();
  state.last_input = w.bodies.last_inputs();
  state.grip_stiffness = w.bodies.grip_stiffness();
  state.impulses = w.bodies.kept_impulses();
  if (!w.engine->save(state.particles, state.walls))
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

  for (std::size_t f = 0; f < state.viscosities.size(); ++f)
    w.scene.fluids[f].dynamic_viscosity = state.viscosities[f];
  w.gravity_scale = state.gravity_scale;
  w.take_parameters();
  w.wrenches = std::move(state.wrenches);
  w.bodies.restore(std::move(state.bodies), std::move(state.grips), std::move(state.last_input),
                   std::move(state.grip_stiffness),                   std::move(state.impulses));
  w.engine->restore(state.particles, state.walls);
  std::fill(w.found.begin(), w.found.end(), Wrench{});
  std::fill(w.drag_matrices.begin(), w.drag_matrices.end(), Matrix6{});
  w.status = state.status & ~kStatusDeviceLost;
  w.tick = state.tick;
  w.age = state.age;
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
  if (!impl_->plan().runs.has_any_of({PassId::kBodyDrag, PassId::kImplicitDrag})) return {};
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
  return impl_->engine->diagnostics();
}
std::string World::failure() const {
  return impl_->engine->failure();
}
std::string World::backend() const {
  return impl_->engine->name();
}

}  // namespace slosh
