#include "sim/world_parts.h"

#include <algorithm>
#include <utility>

#include "sim/passes/rest_density/rest_density.h"
#include "sim/stopwatch.h"

namespace slosh {

World::Impl::Impl(const Scene& scene_in, const SampledScene& sampled, Plan plan_in, WorldOptions options_in)
    : scene(scene_in),
      options(options_in),
      constants(make_run_constants(scene, sampled, std::move(plan_in))),
      bodies(scene, sampled),
      live(scene, constants.plan),
      found(scene.bodies.size()),
      drags(scene.bodies.size()),
      drag_matrices(scene.bodies.size()),
      viscous_bodies(scene.bodies.size()),
      wrenches(scene.bodies.size()),
      age(options.settled ? kSettlingTime : 0.0) {
  scene.meshes.clear();  // the surface particles stand for them from here on
  make_schedules();
}

std::optional<Error> World::Impl::start(const SampledScene& sampled) {
  const ParticleStart particles = make_particle_start(scene, sampled, constants, bodies.bodies());
  frame = state_frame(scene, constants.plan, particles);
  fluid_count = particles.fluid_count;
  fluid_of = sampled.fluid_index;
  waiting = static_cast<std::int64_t>(particles.waiting);
  fillings = sampled.fillings;
  if (!fillings.empty()) filling_places = sampled.fluid_positions;
  region_fields = sampled.region_fields;
  boundary_count = particles.fixed.size() + particles.moving.size();
  if (bodies.cuts().any()) {
    drags_from = drag_layer(scene, plan());
    piece_slots.resize(scene.bodies.size());
    for (std::size_t i = particles.moving.size(); i-- > 0;) {
      Slots& slots = piece_slots[particles.moving[i].body];
      slots = {i, slots.count + 1};
    }
  }
  Result<std::unique_ptr<ParticleEngine>> made =
      make_particle_engine(constants, particles, bodies.bodies(), options);
  if (!made) return made.error();
  engine = std::move(made.value());
  return std::nullopt;
}

void World::Impl::take_parameters() {
  plan_viscosity(scene, constants.plan);
  make_schedules();
  constants.kinds = particle_kinds(scene, constants.plan.spacing);
  constants.gravity = glm::vec3(gravity_scale * scene.gravity);
  engine->set_constants(constants);
  packed = false;
  if (plan().has(PassId::kHeat)) run_on_engine(PassId::kHeat, {}, {});  // viscosities follow at once
}

bool World::Impl::thin_fluids(double most) {
  bool thick = false;
  for (Fluid& fluid : scene.fluids) {
    thick |= fluid.dynamic_viscosity > most;
    fluid.dynamic_viscosity = std::min(fluid.dynamic_viscosity, most);
  }
  if (thick) take_parameters();
  return thick;
}

void World::Impl::make_schedules() {
  for (const TakePart part : {TakePart::kFluid, TakePart::kHeld, TakePart::kAll})
    schedules[static_cast<std::size_t>(part)] = schedule_of(part);
}

SubStep World::Impl::sub_step(int index) const {
  const double share = 1.0 / plan().sub_steps;
  const double dt = plan().time_step * share;
  return {dt, index * dt, share, TakePart::kAll,
          static_cast<double>(tick) * plan().time_step + (index + 1) * dt};
}

void World::Impl::begin_step() {
  std::fill(wrenches.begin(), wrenches.end(), Wrench{});
  times = StepTimes{};
}

void World::Impl::run(const SubStep& step) {
  bodies.drive(step);
  if (plan().has_fluid()) engine->begin(bodies.bodies(), step.dt);
  const StepTimes* later = engine->times();
  Stopwatch watch;
  for (const PassId id : schedules[static_cast<std::size_t>(step.part)]) {
    const PassEntry& pass = entry(id);
    if (pass.run)
      pass.run(*this, step);
    else
      run_on_engine(id, step);
    const double took = watch.lap();
    if (later == nullptr || !on_engine(id)) times[id] += took;
  }
  if (later != nullptr) times += *later;
  if (plan().has_fluid()) report(step);
}

std::vector<PassId> World::Impl::schedule_of(TakePart part) const {
  constexpr PassSet kOfBodies{PassId::kSolveBodies, PassId::kBodyDrag, PassId::kMoveBodies};
  std::vector<PassId> schedule;
  for (std::size_t i = 0; i < kPassCount; ++i) {
    const PassId id = static_cast<PassId>(i);
    const bool left_out = part == TakePart::kFluid && kOfBodies.has(id);
    if (runs_in(id) == id && plan().has(id) && !left_out) schedule.push_back(id);
  }
  // Each solve finds the bodies under what the one before put on them.
  if (plan().has(PassId::kImplicitViscosity) && plan().has(PassId::kPressureSolve))
    schedule.insert(std::find(schedule.begin(), schedule.end(), PassId::kPressureSolve),
                    PassId::kPredictBodies);
  // Else the fluid goes on while the bodies are solved (on a GPU).
  if (plan().has_fluid() && !plan().fluid_waits(part != TakePart::kFluid)) {
    std::erase(schedule, PassId::kIntegrateFluid);
    schedule.insert(std::find(schedule.begin(), schedule.end(), PassId::kReadWrenches),
                    PassId::kIntegrateFluid);
  }
  if (part != TakePart::kAll) schedule.push_back(PassId::kDamp);
  return schedule;
}

void World::Impl::run_on_engine(PassId id, const SubStep& step, std::span<const RigidBody> after) {
  engine->run(id, {step.dt, after, bodies.changes(), viscous_bodies, found});
}

void World::Impl::take_drags() {
  engine->body_drags(drags);
  for (std::size_t b = 0; b < drags.size(); ++b) drag_matrices[b] = drags[b].matrix();
}

BodyForces World::Impl::body_forces(const SubStep& step) const {
  const bool with_drag = step.part != TakePart::kFluid && plan().has(PassId::kBodyDrag);
  return {found, with_drag ? std::span<const Matrix6>(drag_matrices) : std::span<const Matrix6>(), gravity()};
}

std::span<const RigidBody> World::Impl::bodies_after(const SubStep& step) {
  if (step.part == TakePart::kFluid || plan().fluid_waits(true) || !plan().clamps_penetration() ||
      !plan().has(PassId::kPlaceBodies))
    return bodies.bodies();
  ahead = bodies.bodies();
  for (RigidBody& body : ahead) {
    if (body.is_fixed() || body.gone) continue;
    body.position += step.dt * body.velocity;
    body.orientation = rotate_by(body.orientation, step.dt * body.angular_velocity);
  }
  return ahead;
}

void World::Impl::report(const SubStep& step) {
  for (std::size_t b = 0; b < found.size(); ++b) {
    // Solves with the fluid give only their part of what nobody asked for.
    if (scene.bodies[b].motion == BodyMotion::kDriven && !scene.bodies[b].measured) continue;
    wrenches[b].force += step.share * found[b].force;
    wrenches[b].torque += step.share * found[b].torque;
  }
}

}  // namespace slosh
