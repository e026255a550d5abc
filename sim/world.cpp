// One step, as design: sort → passes of the plan → bodies with their couplings.
#include "sim/world.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "sim/bodies.h"
#include "sim/contacts.h"
#include "sim/cpu/passes.h"
#include "sim/hash.h"

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

// Σ of the density kernel's shape over a cubic lattice, the particle itself included.
double rest_number_density(ParticleModel model, double spacing, double support_radius) {
  const int reach = static_cast<int>(std::ceil(support_radius / spacing));
  double sum = 0.0;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) {
        const double r_squared = spacing * spacing * (x * x + y * y + z * z);
        sum += model == ParticleModel::kPaper
                   ? poly6_shape<double>(r_squared, support_radius * support_radius)
                   : spiky_shape<double>(r_squared, support_radius);
      }
    }
  }
  return sum;
}

struct Box {
  glm::dvec3 lower, upper;
};

// The scene's domain, or room around what there is when it names none.
Box domain_of(const Scene& scene, const SampledScene& sampled, double support_radius) {
  if (glm::all(glm::lessThan(scene.domain_min, scene.domain_max)))
    return {scene.domain_min, scene.domain_max};
  Box box{glm::dvec3(std::numeric_limits<double>::infinity()),
          glm::dvec3(-std::numeric_limits<double>::infinity())};
  const auto include = [&](const glm::dvec3& p) {
    box.lower = glm::min(box.lower, p);
    box.upper = glm::max(box.upper, p);
  };
  for (const glm::vec3& p : sampled.fluid_positions) include(glm::dvec3(p));
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    include(scene.bodies[b].pose.position);
    for (const glm::vec3& p : sampled.surfaces[b].positions) {
      include(transform_point(scene.bodies[b].pose, glm::dvec3(p)));
    }
  }
  const glm::dvec3 room = glm::max(0.5 * (box.upper - box.lower), glm::dvec3(4.0 * support_radius));
  return {box.lower - room, box.upper + room};
}

class Stopwatch {
 public:
  /// Seconds since the last call (or the start).
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace

struct World::Impl {
  Impl(const Scene& scene_in, const SampledScene& sampled, Plan plan_in, WorldOptions options)
      : scene(scene_in),
        team(options.threads),
        fixed(scene, sampled, plan_in, BodyMotion::kFixed),
        moving(scene, sampled, plan_in, BodyMotion::kFree),
        contact_finder(scene, sampled) {
    context.plan = std::move(plan_in);
    const Box domain = domain_of(scene, sampled, context.plan.support_radius);
    context.grid = CellGrid(domain.lower, domain.upper, context.plan.support_radius);
    context.kernels = make_kernel_constants(context.plan.support_radius);
    context.rest_number_density = static_cast<float>(
        rest_number_density(context.plan.model, context.plan.spacing, context.plan.support_radius));
    context.rest_volume = static_cast<float>(std::pow(context.plan.spacing, 3));
    context.gravity = glm::vec3(scene.gravity);
    for (const Body& body : scene.bodies) bodies.push_back(make_rigid_body(body));
    wrenches.resize(bodies.size());
    solves.resize(bodies.size());
    wrench_wanted.assign(bodies.size(), 0);
    for (const int b : context.plan.wrench_bodies) wrench_wanted[b] = 1;
    fixed_measured = std::any_of(context.plan.wrench_bodies.begin(), context.plan.wrench_bodies.end(),
                                 [&](int b) { return !bodies[b].free; });
    grips.resize(scene.grips.size());
    last_input.resize(scene.grips.size());
    place_fluid(sampled);
    fixed.place(context, bodies);
    scene.meshes.clear();  // the surface particles stand for them from here on
  }

  void place_fluid(const SampledScene& sampled) {
    for (const Fluid& f : scene.fluids) add_kind(f.rest_density, f.dynamic_viscosity, false);
    std::vector<glm::vec3> positions = sampled.fluid_positions;
    std::vector<glm::vec3> velocities = sampled.fluid_velocities;
    velocities.resize(positions.size(), glm::vec3(0.0f));
    std::vector<std::uint8_t> kinds = sampled.fluid_index;
    snapshot_count = positions.size();
    fluid_starts_moving = std::any_of(velocities.begin(), velocities.end(),
                                      [](const glm::vec3& v) { return v != glm::vec3(0.0f); });
    // A probe is one more particle of the first fluid's kind (Eq 8), moved by its body.
    const Fluid reference = scene.fluids.empty() ? Fluid{} : scene.fluids.front();
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (!bodies[b].point) continue;
      const Body& body = scene.bodies[b];
      probes.push_back({static_cast<std::uint32_t>(positions.size()), static_cast<int>(b)});
      positions.emplace_back(bodies[b].position);
      velocities.emplace_back(bodies[b].velocity);
      kinds.push_back(static_cast<std::uint8_t>(context.kinds.size()));
      add_kind(body.particle_density > 0.0 ? body.particle_density : reference.rest_density,
               body.dynamic_viscosity > 0.0 ? body.dynamic_viscosity : reference.dynamic_viscosity, true);
    }
    fluid.resize(positions.size());
    scratch.resize(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i) {
      fluid.x[i] = positions[i].x;
      fluid.y[i] = positions[i].y;
      fluid.z[i] = positions[i].z;
      fluid.vx[i] = velocities[i].x;
      fluid.vy[i] = velocities[i].y;
      fluid.vz[i] = velocities[i].z;
      fluid.id[i] = static_cast<std::uint32_t>(i);
      fluid.kind[i] = kinds[i];
      const bool whole = finite(glm::dvec3(positions[i])) && finite(glm::dvec3(velocities[i]));
      const bool inside = whole && context.grid.contains(fluid.x[i], fluid.y[i], fluid.z[i]);
      fluid.key[i] =
          inside ? context.grid.cell_of(fluid.x[i], fluid.y[i], fluid.z[i]) : context.grid.retired_key();
      if (!inside) context.status |= whole ? kStatusEscaped : kStatusNonFinite;
    }
    fluid.active = positions.size();
  }

  void add_kind(double rest_density, double viscosity, bool probe) {
    context.kinds.push_back({static_cast<float>(rest_density), static_cast<float>(viscosity),
                             static_cast<float>(rest_density * std::pow(context.plan.spacing, 3)), probe});
  }

  // Probes are particles that their body carries: their state goes in before the passes, the force comes out
  // after.
  void carry_probes_in() {
    if (probes.empty()) return;
    for (std::size_t p = 0; p < fluid.active; ++p) {
      if (fluid.id[p] < snapshot_count) continue;
      const RigidBody& body = bodies[probes[fluid.id[p] - snapshot_count].body];
      fluid.x[p] = static_cast<float>(body.position.x);
      fluid.y[p] = static_cast<float>(body.position.y);
      fluid.z[p] = static_cast<float>(body.position.z);
      fluid.vx[p] = static_cast<float>(body.velocity.x);
      fluid.vy[p] = static_cast<float>(body.velocity.y);
      fluid.vz[p] = static_cast<float>(body.velocity.z);
      // A probe that a hand takes out of the domain comes back with it: it waits in the nearest cell.
      fluid.key[p] = context.grid.cell_of(fluid.x[p], fluid.y[p], fluid.z[p]);
    }
  }

  void carry_probe_forces_out() {
    if (probes.empty()) return;
    for (std::size_t p = 0; p < fluid.active; ++p) {
      if (fluid.id[p] < snapshot_count) continue;
      wrenches[probes[fluid.id[p] - snapshot_count].body].force +=
          glm::dvec3(fluid.fx[p], fluid.fy[p], fluid.fz[p]);
    }
  }

  void step_particles(Stopwatch& watch) {
    const Plan& plan = context.plan;
    carry_probes_in();
    sort_fluid(context, team, fluid, sorter, scratch);
    if (moving.size() > 0) moving.place(context, bodies);
    times.sort = watch.lap();
    compute_density(context, team, fluid, fixed.sorted(), moving.sorted());
    times.density = watch.lap();
    compute_fluid_forces(context, team, fluid, fixed.sorted(), moving.sorted());
    std::fill(wrenches.begin(), wrenches.end(), Wrench{});
    if (plan.body_wrench) {
      sum_body_wrenches(context, team, fluid, moving.sorted(), bodies, wrench_wanted, body_scratch, wrenches);
      if (fixed_measured) {
        sum_body_wrenches(context, team, fluid, fixed.sorted(), bodies, wrench_wanted, body_scratch,
                          wrenches);
      }
      carry_probe_forces_out();
    }
    integrate_fluid(context, team, fluid);
    times.force = watch.lap();
  }

  void take_input(std::span<const HandleInput> handles) {
    couplings.clear();
    for (std::size_t g = 0; g < grips.size(); ++g) {
      HandleInput input = g < handles.size() ? handles[g] : HandleInput{};
      if (input.engaged && !usable(input)) {
        context.status |= kStatusInputRejected;
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
      external.force += body.mass * scene.gravity;
      const auto held = couplings_of(static_cast<int>(b));
      if (solve_body(body, external, held, context.plan.time_step, solves[b])) continue;
      context.status |= kStatusNonFinite;
      body.velocity = body.angular_momentum = body.angular_velocity = glm::dvec3(0.0);
      if (!solve_body(body, {}, {}, context.plan.time_step, solves[b])) solves[b] = BodySolve{};
    }
  }

  void step_bodies(std::span<const HandleInput> handles) {
    take_input(handles);
    solve_all();
    if (context.plan.contacts) {
      contact_finder.find(bodies, 0.25 * context.plan.spacing, contacts);
      if (!contacts.empty()) solve_contacts(contacts, scene, bodies, context.plan.time_step, solves);
    }
    for (GripState& state : grips) state.on_hand = Wrench{};
    for (const ActiveCoupling& c : couplings) {
      const Wrench on_body = coupling_wrench(c, solves[c.body], context.plan.time_step);
      grips[c.grip].on_hand = {-on_body.force, -on_body.torque};
      grips[c.grip].handle = c.handle;
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (solves[b].moves) advance_body(bodies[b], solves[b], context.plan.time_step);
    }
  }

  void damp_fluid(float keep) {
    for (Column<float>* column : {&fluid.vx, &fluid.vy, &fluid.vz}) {
      for (std::size_t p = 0; p < fluid.active; ++p) (*column)[p] *= keep;
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
  PassContext context;
  ThreadTeam team;
  FluidParticles fluid, scratch;
  KeySorter sorter;
  BodySurface fixed, moving;
  ContactFinder contact_finder;
  std::vector<RigidBody> bodies;
  std::vector<Wrench> wrenches;     // by the fluid, one a body
  std::vector<char> wrench_wanted;  // one a body
  bool fixed_measured = false;
  std::vector<BodySolve> solves;
  std::vector<Contact> contacts;
  std::vector<ActiveCoupling> couplings;
  std::vector<GripState> grips;
  std::vector<HandleInput> last_input;
  struct Probe {
    std::uint32_t id;
    int body;
  };
  std::vector<Probe> probes;
  bool fluid_starts_moving = false;
  bool settling = false;
  std::size_t snapshot_count = 0;  // fluid particles without probes
  std::vector<glm::vec3> body_scratch;
  std::uint64_t tick = 0;
  StepTimes times;
};

World::World(const Scene& scene, const SampledScene& sampled, Plan plan, WorldOptions options)
    : impl_(std::make_unique<Impl>(scene, sampled, std::move(plan), options)) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

void World::step(std::span<const HandleInput> handles) {
  Stopwatch whole;
  Stopwatch watch;
  impl_->times = StepTimes{};
  if (impl_->context.plan.has_fluid) impl_->step_particles(watch);
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
  const double keep = std::exp(-w.context.plan.time_step / kDampingTime);
  Stopwatch watch;
  for (double done = 0.0; done < seconds; done += w.context.plan.time_step) {
    if (w.context.plan.has_fluid) w.step_particles(watch);
    w.damp_fluid(static_cast<float>(keep));
    if (handles.empty() || done < 0.5 * seconds) continue;
    w.settling = true;
    w.step_bodies(handles);
    w.settling = false;
    w.damp_held_bodies(keep);
  }
}

const Plan& World::plan() const {
  return impl_->context.plan;
}
double World::time() const {
  return static_cast<double>(impl_->tick) * impl_->context.plan.time_step;
}
std::uint64_t World::tick() const {
  return impl_->tick;
}
std::size_t World::fluid_count() const {
  return impl_->snapshot_count;
}
std::size_t World::boundary_count() const {
  return impl_->fixed.size() + impl_->moving.size();
}
const StepTimes& World::times() const {
  return impl_->times;
}

void World::fill(BodySnapshot& out) const {
  out.tick = impl_->tick;
  out.time = time();
  out.status = impl_->context.status.load(std::memory_order_relaxed);
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

void World::fill(Snapshot& out) const {
  fill(out.rigid);
  out.positions.resize(impl_->snapshot_count);
  out.fluid_index.assign(impl_->snapshot_count, 255);
  const FluidParticles& fluid = impl_->fluid;
  for (std::size_t p = 0; p < fluid.active; ++p) {
    const std::uint32_t id = fluid.id[p];
    if (id >= impl_->snapshot_count || fluid.key[p] >= impl_->context.grid.retired_key()) continue;
    out.positions[id] = glm::vec3(fluid.x[p], fluid.y[p], fluid.z[p]);
    out.fluid_index[id] = fluid.kind[p];
  }
}

std::uint32_t World::take_status() {
  return impl_->context.status.exchange(0);
}

std::uint64_t World::hash() const {
  const FluidParticles& fluid = impl_->fluid;
  // Particles are in cell order, which the state itself fixes, so their order need not be undone.
  Fingerprint print;
  for (std::size_t p = 0; p < fluid.active; ++p) {
    print.add(fluid.id[p]);
    for (const Column<float>* column : {&fluid.x, &fluid.y, &fluid.z, &fluid.vx, &fluid.vy, &fluid.vz}) {
      print.add((*column)[p]);
    }
  }
  for (const RigidBody& body : impl_->bodies) {
    print.add(body.position);
    print.add(body.orientation);
    print.add(body.velocity);
    print.add(body.angular_momentum);
  }
  return print.value();
}

Diagnostics World::diagnostics() const {
  Diagnostics d;
  const FluidParticles& fluid = impl_->fluid;
  const PassContext& context = impl_->context;
  for (std::size_t p = 0; p < fluid.active; ++p) {
    const ParticleKind& kind = context.kinds[fluid.kind[p]];
    if (kind.probe || fluid.key[p] >= context.grid.retired_key()) continue;
    const glm::dvec3 x(fluid.x[p], fluid.y[p], fluid.z[p]);
    const glm::dvec3 v(fluid.vx[p], fluid.vy[p], fluid.vz[p]);
    const double mass = kind.mass;
    ++d.particles;
    d.mass += mass;
    d.momentum += mass * v;
    d.center += mass * x;
    d.kinetic_energy += 0.5 * mass * glm::dot(v, v);
    d.max_speed = std::max(d.max_speed, glm::length(v));
    d.max_compression = std::max<double>(d.max_compression, context.rest_volume / fluid.volume[p] - 1.0);
  }
  if (d.mass > 0.0) d.center /= d.mass;
  d.retired = impl_->snapshot_count - d.particles;
  return d;
}

}  // namespace slosh
