#include "sim/world_parts.h"

#include <algorithm>
#include <utility>

#include "sim/pressure/rest_density.h"
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
}

std::optional<Error> World::Impl::start(const SampledScene& sampled) {
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

void World::Impl::take_parameters() {
  plan_viscosity(scene, constants.plan);
  constants.kinds = particle_kinds(scene, constants.plan.spacing);
  constants.gravity = glm::vec3(gravity_scale * scene.gravity);
  engine->set_constants(constants);
  packed = false;
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

void World::Impl::calibrate_rest_density(double dt) {
  if (packed) return;
  if (corrects_gradients(plan().model))
    engine->set_correction(settled(constants.correction, constants.load_compression, age));
  packed = age >= kSettlingTime;
  if (!packed) age += dt;
}

SubStep World::Impl::sub_step(int index) const {
  const double share = 1.0 / plan().sub_steps;
  const double dt = plan().time_step * share;
  return {dt, index * dt, share};
}

void World::Impl::begin_step() {
  std::fill(wrenches.begin(), wrenches.end(), Wrench{});
  times = StepTimes{};
}

void World::Impl::run(const SubStep& step, TakePart part) {
  const bool fluid = plan().has_fluid();
  const bool moving = part != TakePart::kFluid;
  const bool implicit = fluid && plan().has(PassId::kImplicitViscosity);
  const bool pressed = fluid && plan().has(PassId::kPressureSolve);
  const bool fluid_waits = implicit || pressed || (moving && plan().fluid_waits());
  if (fluid) {
    calibrate_rest_density(step.dt);
    engine->prepare(bodies.bodies());
    engine->forces(step.dt);
    if (!fluid_waits) engine->advance(step.dt, expected(step, moving));
    engine->wrenches(found);
  }
  if (implicit) solve_viscosity(step, moving, part == TakePart::kHeld);
  const bool with_drag = moving && plan().has(PassId::kBodyDrag);
  if (pressed) solve_pressure(step, moving, part == TakePart::kHeld, with_drag);
  if (moving) solve_bodies(step, part == TakePart::kHeld, with_drag);
  if (with_drag) engine->drag(bodies.changes());
  if (moving) {
    Stopwatch watch;
    bodies.move(plan(), step);
    status |= bodies.part_with_lost(gravity_scale * scene.gravity);
    times.body += watch.lap();
  }
  if (fluid_waits) engine->advance(step.dt, bodies.bodies());
  if (fluid) report(step);
}

void World::Impl::solve_viscosity(const SubStep& step, bool moving, bool held_only) {
  bodies.predict(plan(), {found, {}, gravity_scale * scene.gravity}, step, moving, held_only, viscous_bodies);
  engine->solve_viscosity(step.dt, viscous_bodies, found);
  take_drags();
}

void World::Impl::solve_pressure(const SubStep& step, bool moving, bool held_only, bool with_drag) {
  if (with_drag) take_drags();
  bodies.predict(plan(),
                 {found, with_drag ? std::span<const Matrix6>(drag_matrices) : std::span<const Matrix6>(),
                  gravity_scale * scene.gravity},
                 step, moving, held_only, viscous_bodies);
  engine->solve_pressure(step.dt, viscous_bodies, found);
}

void World::Impl::take_drags() {
  engine->body_drags(drags);
  for (std::size_t b = 0; b < drags.size(); ++b) drag_matrices[b] = drags[b].matrix();
}

std::span<const RigidBody> World::Impl::expected(const SubStep& step, bool moving) {
  if (!moving || !plan().guards_walls() || !plan().has(PassId::kPlaceBodies)) return bodies.bodies();
  ahead = bodies.bodies();
  for (RigidBody& body : ahead) {
    if (!body.moves()) continue;
    body.position += step.dt * body.velocity;
    body.orientation = rotate_by(body.orientation, step.dt * body.angular_velocity);
  }
  return ahead;
}

void World::Impl::solve_bodies(const SubStep& step, bool held_only, bool with_drag) {
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

void World::Impl::report(const SubStep& step) {
  for (std::size_t b = 0; b < found.size(); ++b) {
    wrenches[b].force += step.share * found[b].force;
    wrenches[b].torque += step.share * found[b].torque;
  }
  const StepTimes passes = engine->times();
  times.sort += passes.sort;
  times.density += passes.density;
  times.force += passes.force;
}

}  // namespace slosh
