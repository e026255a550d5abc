// One step, as design: sort → passes of the plan → bodies with their couplings.
#include "sim/world.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "sim/bodies.h"
#include "sim/contacts.h"
#include "sim/hash.h"
#include "sim/particle_engine.h"
#include "sim/saved_state.h"
#include "sim/shell.h"
#include "sim/step_limits.h"
#include "sim/stopwatch.h"

namespace slosh {

namespace {

// Handles beyond these are broken devices, not hands.
constexpr double kFarthestHandle = 1.0e3;     // m
constexpr double kFastestHandle = 1.0e3;      // m/s
constexpr double kFastestHandleTurn = 1.0e4;  // rad/s

bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool usable(const HandleInput& input) {
  const glm::dquat& q = input.pose.orientation;
  const double norm = glm::dot(q, q);
  return finite(input.pose.position) && finite(input.twist.linear) && finite(input.twist.angular) &&
         glm::length(input.pose.position) < kFarthestHandle && std::isfinite(norm) &&
         glm::length(input.twist.linear) < kFastestHandle &&
         glm::length(input.twist.angular) < kFastestHandleTurn && std::abs(norm - 1.0) < 0.1 &&
         std::isfinite(input.scale);
}

Error too_much(const std::string& where, double value, double most, const char* unit) {
  char text[160];
  std::snprintf(text, sizeof text, "%.4g %s is too much for the time step of this run", value, unit);
  char mend[80];
  std::snprintf(mend, sizeof mend, "Up to %.4g %s will do", most, unit);
  return {where, text, mend};
}

}  // namespace

struct World::Impl {
  Impl(const Scene& scene_in, const SampledScene& sampled, Plan plan_in, WorldOptions options_in)
      : scene(scene_in), options(options_in), contact_finder(scene, sampled) {
    constants = make_run_constants(scene, sampled, std::move(plan_in));
    for (const Body& body : scene.bodies) bodies.push_back(make_rigid_body(body));
    wrenches.resize(bodies.size());
    solves.resize(bodies.size());
    grips.resize(scene.grips.size());
    for (const Fluid& fluid : scene.fluids) scene_viscosities.push_back(fluid.dynamic_viscosity);
    last_input.resize(scene.grips.size());
    scene.meshes.clear();  // the surface particles stand for them from here on
  }

  // Error: the backend that was asked for is not there.
  std::optional<Error> start(const SampledScene& sampled) {
    const ParticleStart particles = make_particle_start(scene, sampled, constants, bodies);
    frame = state_frame(scene, constants.plan, particles);
    fluid_count = particles.fluid_count;
    boundary_count = particles.fixed.size() + particles.moving.size();
    fluid_starts_moving =
        std::any_of(particles.velocities.begin(),
                    particles.velocities.begin() +
                        static_cast<std::ptrdiff_t>(std::min(fluid_count, sampled.fluid_velocities.size())),
                    [](const glm::vec3& v) { return v != glm::vec3(0.0f); });
    Result<std::unique_ptr<ParticleEngine>> made =
        make_particle_engine(constants, particles, bodies, options);
    if (!made) return made.error();
    engine = std::move(made.value());
    return std::nullopt;
  }

  Result<bool> allows_viscosity(std::size_t fluid, double value) const {
    const bool there = std::any_of(
        scene.fluid_volumes.begin(), scene.fluid_volumes.end(),
        [&](const auto& v) { return v.fluid >= 0 && static_cast<std::size_t>(v.fluid) == fluid; });
    if (!there || fluid >= scene.fluids.size())
      return Error{"viscosity", "there is no fluid " + std::to_string(fluid) + " in this world", ""};
    const std::string where = "viscosity of " + scene.fluids[fluid].name;
    if (!(value >= 0.0)) return Error{where, "it cannot be below 0", ""};
    // The scene's own value is what the step was chosen for, whatever rounding says.
    const double most = std::max(most_viscous_allowed(scene, constants.plan), scene_viscosities[fluid]);
    if (value <= most) return true;
    return too_much(where, value, most, "Pa·s");
  }

  Result<bool> allows_gravity(double scale) const {
    if (!(scale >= 0.0 && scale <= kMostGravityScale))
      return Error{"gravity", "it can be 0 to 2 times the scene's", ""};
    const double most = std::max(most_gravity_allowed(scene, constants.plan), 1.0);
    if (scale <= most) return true;
    return too_much("gravity", scale, most, "times the scene's");
  }

  // What a live change means for everybody who has a copy of it.
  void take_parameters() {
    plan_viscosity(scene, constants.plan);
    constants.kinds = particle_kinds(scene, constants.plan.spacing);
    constants.gravity = glm::vec3(gravity_scale * scene.gravity);
    engine->set_constants(constants);
  }

  void step_particles() {
    engine->step(bodies, wrenches);
    times = engine->times();
  }

  void take_input(std::span<const HandleInput> handles) {
    couplings.clear();
    for (std::size_t g = 0; g < grips.size(); ++g) {
      HandleInput input = g < handles.size() ? handles[g] : HandleInput{};
      if (input.engaged && !usable(input)) {
        status |= kStatusInputRejected;
        input = last_input[g];
        input.twist = {};
      }
      last_input[g] = input;
      if (!input.engaged) continue;
      const Grip& grip = scene.grips[g];
      const double scale = std::clamp(input.scale, 0.0, 1.0);
      ActiveCoupling coupling;
      coupling.grip = static_cast<int>(g);
      coupling.body = grip.body;
      coupling.gains = {scale * grip.stiffness, scale * grip.damping, scale * grip.rotational_stiffness,
                        scale * grip.rotational_damping};
      coupling.handle = input.pose;
      coupling.handle.orientation = glm::normalize(input.pose.orientation);
      coupling.handle_twist = input.twist;
      coupling.grip_pose = compose(bodies[grip.body].mesh_pose(), grip.pose);
      coupling.arm = coupling.grip_pose.position - bodies[grip.body].position;
      couplings.push_back(coupling);
    }
    std::stable_sort(couplings.begin(), couplings.end(),
                     [](const ActiveCoupling& a, const ActiveCoupling& b) { return a.body < b.body; });
  }

  std::span<const ActiveCoupling> couplings_of(int body) const {
    const auto first =
        std::find_if(couplings.begin(), couplings.end(), [&](const auto& c) { return c.body == body; });
    const auto last = std::find_if(first, couplings.end(), [&](const auto& c) { return c.body != body; });
    return {first, last};
  }

  // During settling only held bodies move.
  bool moves(std::size_t b) const {
    return bodies[b].free && (!settling || !couplings_of(static_cast<int>(b)).empty());
  }

  // A body that went non-finite is put back to rest where it last was, and the step goes on.
  void solve_all() {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      RigidBody& body = bodies[b];
      if (!moves(b)) {
        solves[b] = BodySolve{};
        continue;
      }
      Wrench external = wrenches[b];
      external.force += body.mass * gravity_scale * scene.gravity;
      const auto held = couplings_of(static_cast<int>(b));
      if (solve_body(body, external, held, constants.plan.time_step, solves[b])) continue;
      status |= kStatusNonFinite;
      body.velocity = body.angular_momentum = body.angular_velocity = glm::dvec3(0.0);
      if (!solve_body(body, {}, {}, constants.plan.time_step, solves[b])) solves[b] = BodySolve{};
    }
  }

  void step_bodies(std::span<const HandleInput> handles) {
    take_input(handles);
    solve_all();
    if (constants.plan.contacts) {
      contact_finder.find(bodies, 0.25 * constants.plan.spacing, contacts);
      if (!contacts.empty()) solve_contacts(contacts, scene, bodies, constants.plan.time_step, solves);
    }
    for (GripState& state : grips) state.on_hand = Wrench{};
    for (const ActiveCoupling& c : couplings) {
      const Wrench on_body = coupling_wrench(c, solves[c.body], constants.plan.time_step);
      grips[c.grip].on_hand = {-on_body.force, -on_body.torque};
      grips[c.grip].handle = c.handle;
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (solves[b].moves) advance_body(bodies[b], solves[b], constants.plan.time_step);
    }
  }

  // Bodies that no hand holds keep their initial motion for the run.
  void damp_held_bodies(double keep) {
    for (const ActiveCoupling& c : couplings) {
      RigidBody& body = bodies[c.body];
      body.velocity *= keep;
      body.angular_momentum *= keep;
      body.angular_velocity *= keep;
    }
  }

  Scene scene;
  WorldOptions options;
  RunConstants constants;
  std::vector<RigidBody> bodies;
  std::unique_ptr<ParticleEngine> engine;
  ContactFinder contact_finder;
  std::vector<Wrench> wrenches;  // by the fluid, one a body
  std::vector<BodySolve> solves;
  std::vector<Contact> contacts;
  std::vector<ActiveCoupling> couplings;
  std::vector<GripState> grips;
  std::vector<HandleInput> last_input;
  bool fluid_starts_moving = false;
  bool settling = false;
  std::size_t fluid_count = 0;  // without probes
  std::size_t boundary_count = 0;
  std::uint32_t status = 0;  // of bodies and inputs; the engine has its own
  std::uint64_t tick = 0;
  StepTimes times;
  double gravity_scale = 1.0;
  std::vector<double> scene_viscosities;  // Pa·s, one a fluid, as the scene has them
  StateFrame frame;
};

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
World::World(const Scene& scene, const SampledScene& sampled, Plan plan, WorldOptions options)
    : impl_(std::make_unique<Impl>(scene, sampled, std::move(plan), options)) {
  if (options.backend == Backend::kCuda) impl_->options.backend = Backend::kAuto;
  impl_->start(sampled);
}
Result<World> make_world(const Scene& scene, const SampledScene& sampled, Plan plan, WorldOptions options) {
  auto impl = std::make_unique<World::Impl>(scene, sampled, std::move(plan), options);
  if (std::optional<Error> error = impl->start(sampled)) return *error;
  return World(std::move(impl));
}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

void World::step(std::span<const HandleInput> handles) {
  Stopwatch whole;
  Stopwatch watch;
  impl_->times = StepTimes{};
  if (impl_->constants.plan.has_fluid) impl_->step_particles();
  watch.lap();
  impl_->step_bodies(handles);
  impl_->times.body = watch.lap();
  impl_->times.total = whole.lap();
  ++impl_->tick;
}

void World::settle(double seconds, std::span<const HandleInput> handles) {
  Impl& w = *impl_;
  if (w.fluid_starts_moving) return;
  constexpr double kDampingTime =
      0.05;  // s: past critical for a hand-sized vessel's slosh, so it creeps to its level
  const double keep = std::exp(-w.constants.plan.time_step / kDampingTime);
  for (double done = 0.0; done < seconds; done += w.constants.plan.time_step) {
    if (w.constants.plan.has_fluid) w.step_particles();
    w.engine->damp(static_cast<float>(keep));
    if (handles.empty() || done < 0.5 * seconds) continue;
    w.settling = true;
    w.step_bodies(handles);
    w.settling = false;
    w.damp_held_bodies(keep);
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
  out.bodies.resize(impl_->bodies.size());
  for (std::size_t b = 0; b < out.bodies.size(); ++b) {
    const RigidBody& body = impl_->bodies[b];
    out.bodies[b] = {
        body.mesh_pose(), {body.velocity, body.angular_velocity}, body.position, impl_->wrenches[b]};
  }
  out.grips.resize(impl_->grips.size());
  for (std::size_t g = 0; g < out.grips.size(); ++g) {
    const Grip& grip = impl_->scene.grips[g];
    const RigidBody& body = impl_->bodies[grip.body];
    out.grips[g] = impl_->grips[g];
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

Result<bool> World::save(std::vector<std::uint8_t>& out) const {
  const Impl& w = *impl_;
  SavedState state;
  state.tick = w.tick;
  state.status = w.status | w.engine->status();
  state.gravity_scale = w.gravity_scale;
  for (const Fluid& fluid : w.scene.fluids) state.viscosities.push_back(fluid.dynamic_viscosity);
  state.bodies = w.bodies;
  state.wrenches = w.wrenches;
  state.grips = w.grips;
  state.last_input = w.last_input;
  if (!w.engine->save(state.particles))
    return Error{"the world", "cannot be saved: " + w.engine->failure(), "Run again with the CPU backend"};
  write_state(w.frame, w.constants, state, out);
  return true;
}

Result<bool> World::restore(std::span<const std::uint8_t> saved) {
  Impl& w = *impl_;
  SavedState state;
  state.bodies = w.bodies;
  const Result<bool> read = read_state(saved, w.frame, w.constants, state);
  if (!read) return read;
  for (std::size_t f = 0; f < state.viscosities.size(); ++f) {
    if (state.viscosities[f] == w.scene_viscosities[f]) continue;
    const Result<bool> allowed = w.allows_viscosity(f, state.viscosities[f]);
    if (!allowed) return allowed;
  }
  if (const Result<bool> allowed = w.allows_gravity(state.gravity_scale); !allowed) return allowed;

  for (std::size_t f = 0; f < state.viscosities.size(); ++f)
    w.scene.fluids[f].dynamic_viscosity = state.viscosities[f];
  w.gravity_scale = state.gravity_scale;
  w.take_parameters();
  w.bodies = std::move(state.bodies);
  w.wrenches = std::move(state.wrenches);
  w.grips = std::move(state.grips);
  w.last_input = std::move(state.last_input);
  w.engine->restore(state.particles);
  w.status = state.status & ~kStatusDeviceLost;
  w.tick = state.tick;
  return true;
}

Result<bool> World::set_viscosity(std::size_t fluid, double pascal_seconds) {
  const Result<bool> allowed = impl_->allows_viscosity(fluid, pascal_seconds);
  if (!allowed) return allowed;
  impl_->scene.fluids[fluid].dynamic_viscosity = pascal_seconds;
  impl_->take_parameters();
  return true;
}

Result<bool> World::set_gravity_scale(double scale) {
  const Result<bool> allowed = impl_->allows_gravity(scale);
  if (!allowed) return allowed;
  impl_->gravity_scale = scale;
  impl_->take_parameters();
  return true;
}

double World::viscosity(std::size_t fluid) const {
  return fluid < impl_->scene.fluids.size() ? impl_->scene.fluids[fluid].dynamic_viscosity : 0.0;
}
double World::gravity_scale() const {
  return impl_->gravity_scale;
}

std::uint32_t World::take_status() {
  return std::exchange(impl_->status, 0u) | impl_->engine->take_status();
}

std::uint64_t World::hash() const {
  Fingerprint print;
  impl_->engine->add_to(print);
  for (const RigidBody& body : impl_->bodies) {
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
