#include "sim/bodies/body_system.h"

#include <algorithm>

namespace slosh {
namespace {

std::vector<RigidBody> make_rigid_bodies(const Scene& scene) {
  std::vector<RigidBody> bodies;
  for (const Body& body : scene.bodies) bodies.push_back(make_rigid_body(body));
  return bodies;
}

}  // namespace

BodySystem::BodySystem(const Scene& scene, const SampledScene& sampled)
    : bodies_(make_rigid_bodies(scene)),
      driven_(scene, sampled),
      joints_(scene, bodies_),
      room_(scene, sampled),
      finder_(scene, sampled),
      cuts_(scene, sampled),
      blades_(scene, sampled.spacing),
      hands_(scene),
      solves_(scene.bodies.size()),
      changes_(scene.bodies.size()),
      memory_(sampled.spacing),
      grips_(scene.grips.size()) {
  for (const Body& body : scene.bodies) materials_.push_back({body.friction, body.restitution});
  finder_.leave_out(joints_.connected());
}

std::uint32_t BodySystem::begin_step(std::span<const HandleInput> handles, double time_step) {
  for (GripState& state : grips_) state.on_hand = Wrench{};
  joints_.begin_step();
  return hands_.take(handles, time_step);
}

void BodySystem::drive(const SubStep& step) {
  if (step.part == TakePart::kAll)
    driven_.drive(bodies_, step.until, step.dt);
  else
    driven_.stand(bodies_);
}

std::uint32_t BodySystem::solve(const Plan& plan, const BodyForces& forces, const SubStep& step) {
  couplings_ = {};
  if (plan.has(PassId::kCouplings)) couplings_ = hands_.couple(bodies_, step.elapsed);
  const std::uint32_t status = solve_alone(forces, step);
  const bool joined = plan.has(PassId::kJoints);
  if (joined) joints_.begin(bodies_, driven_, step.dt, solves_);
  if (plan.has(PassId::kContacts)) find_contacts(plan, step.dt);
  if (joined || plan.has(PassId::kContacts))
    solve_contacts(contacts_, materials_, bodies_, step.dt, memory_, solves_, joined ? &joints_ : nullptr);
  if (joined) joints_.finish(bodies_, driven_, step.dt, step.share, solves_);
  report(step);
  for (std::size_t b = 0; b < bodies_.size(); ++b) changes_[b] = twist_change(bodies_[b], solves_[b]);
  return status;
}

void BodySystem::find_contacts(const Plan& plan, double dt) {
  const double margin = 0.25 * plan.spacing;
  if (!blades_.any() || !cuts_.any()) return finder_.find(bodies_, solves_, margin, dt, memory_, contacts_);
  std::vector<Contact> of_blades;
  blades_.find(bodies_, solves_, cuts_, dt, of_blades);
  finder_.find(bodies_, solves_, margin, dt, memory_, contacts_, blades_.pairs());
  blades_.push_aside(bodies_, contacts_);
  if (of_blades.empty()) return;
  contacts_.insert(contacts_.end(), of_blades.begin(), of_blades.end());
  // Pair by pair, as the memory wants them.
  std::ranges::stable_sort(
      contacts_, {}, [](const Contact& c) { return std::pair(std::min(c.a, c.b), std::max(c.a, c.b)); });
}

void BodySystem::become(int body, const RigidBody& as) {
  RigidBody& is = bodies_[static_cast<std::size_t>(body)];
  if (is.local_center != as.local_center) joints_.recentre(body, is.local_center - as.local_center);
  is = as;
}

void BodySystem::reshape(int body, const PieceShape& shape) {
  cuts_.set(body, shape);
  if (shape.planes.empty()) return finder_.set_shape(body, nullptr);
  ContactFinder::NewShape as{shape.surface.positions, shape.surface.normals, shape.field};
  const Corners corners = corners_of(shape.solid);
  as.points.insert(as.points.end(), corners.points.begin(), corners.points.end());
  as.normals.insert(as.normals.end(), corners.normals.begin(), corners.normals.end());
  finder_.set_shape(body, &as);
}

void BodySystem::part(int body, const PieceShape& rest, int piece, const PieceShape& off,
                      const CutPlane& plane) {
  const std::vector<RigidBody> before = bodies_;
  const RigidBody& whole = before[static_cast<std::size_t>(body)];
  become(body, part_of(whole, rest.mass));
  become(piece, part_of(whole, off.mass));
  reshape(body, rest);
  reshape(piece, off);
  memory_.part(body, piece, plane, before, bodies_);
  blades_.forget(body);
  blades_.forget(piece);
}

void BodySystem::predict(const Plan& plan, const BodyForces& forces, const SubStep& step,
                         std::span<ViscousBody> out) {
  const bool part = step.part != TakePart::kFluid, held_only = step.part == TakePart::kHeld;
  couplings_ = {};
  if (part && plan.has(PassId::kCouplings)) couplings_ = hands_.couple(bodies_, step.elapsed);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const RigidBody& body = bodies_[b];
    const auto held = couplings_of(static_cast<int>(b));
    if (body.driven && step.part == TakePart::kAll) {
      out[b] = driven_.as_heavy(body, static_cast<int>(b));
      continue;
    }
    out[b] = ViscousBody{};
    out[b].twist = {body.velocity, body.angular_velocity};
    out[b].moves = part && body.moves() && !(held_only && !is_held(static_cast<int>(b)));
    if (!out[b].moves) continue;
    Wrench external = forces.fluid[b];
    external.force += body.mass * forces.gravity;
    Matrix6 room;
    const Matrix6* drag = drag_on(static_cast<int>(b), forces, step.dt, room, external);
    assemble_body(body, external, held, step.dt, out[b].inertia, out[b].momentum, drag);
  }
  if (part && plan.has(PassId::kJoints)) joints_.predict(bodies_, out);
  if (!plan.has(PassId::kContacts)) return;
  for (const KeptImpulse& kept : memory_.kept()) {
    const glm::dvec3 place = kept.place(bodies_);
    const auto give = [&](int b, const glm::dvec3& impulse) {
      body_solve::add_vector(out[b].momentum, 0, impulse);
      body_solve::add_vector(out[b].momentum, 3, glm::cross(place - bodies_[b].position, impulse));
    };
    give(kept.first, kept.impulse);
    give(kept.second, -kept.impulse);
  }
}

void BodySystem::move(const SubStep& step) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    if (solves_[b].moves) advance_body(bodies_[b], solves_[b], step.dt);
  }
  driven_.move(bodies_);
}

std::uint32_t BodySystem::part_with_lost(const glm::dvec3& gravity) {
  std::uint32_t status = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    RigidBody& body = bodies_[b];
    if (!body.moves() || !room_.lost(body.position, gravity) || is_held(static_cast<int>(b))) continue;
    body.gone = true;
    body.velocity = body.angular_momentum = body.angular_velocity = glm::dvec3(0.0);
    status |= kStatusBodyGone;
  }
  return status;
}

std::span<const ActiveCoupling> BodySystem::couplings_of(int body) const {
  const auto first =
      std::find_if(couplings_.begin(), couplings_.end(), [&](const auto& c) { return c.body == body; });
  const auto last = std::find_if(first, couplings_.end(), [&](const auto& c) { return c.body != body; });
  return {first, last};
}

// What a body loses of `external` for each unit of twist, where that is anything; `room` for it.
const Matrix6* BodySystem::drag_on(int body, const BodyForces& forces, double dt, Matrix6& room,
                                   Wrench& external) const {
  const Matrix6* drag = forces.drags.empty() ? nullptr : &forces.drags[static_cast<std::size_t>(body)];
  if (joints_.empty()) return drag;
  room = drag ? *drag : Matrix6{};
  return joints_.add_stiffness(body, bodies_, dt, room, external) ? &room : drag;
}

// By a hand, itself or by joints.
bool BodySystem::is_held(int body) const {
  const int group = joints_.group_of(body);
  if (group < 0) return !couplings_of(body).empty();
  return std::any_of(couplings_.begin(), couplings_.end(),
                     [&](const ActiveCoupling& c) { return joints_.group_of(c.body) == group; });
}

// A body that went non-finite is put back to rest where it last was, and the step goes on.
std::uint32_t BodySystem::solve_alone(const BodyForces& forces, const SubStep& step) {
  const bool held_only = step.part == TakePart::kHeld;
  std::uint32_t status = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    RigidBody& body = bodies_[b];
    const auto held = couplings_of(static_cast<int>(b));
    if (!body.moves() || (held_only && !is_held(static_cast<int>(b)))) {
      solves_[b] = BodySolve{};
      solves_[b].driven = body.driven;
      if (body.driven) solves_[b].velocity = solves_[b].travel = body_solve::twist_of(body);
      continue;
    }
    Wrench external = forces.fluid[b];
    external.force += body.mass * forces.gravity;
    Matrix6 room;
    const Matrix6* drag = drag_on(static_cast<int>(b), forces, step.dt, room, external);
    if (solve_body(body, external, held, step.dt, solves_[b], drag)) continue;
    status |= kStatusNonFinite;
    body.velocity = body.angular_momentum = body.angular_velocity = glm::dvec3(0.0);
    if (!solve_body(body, {}, {}, step.dt, solves_[b])) solves_[b] = BodySolve{};
  }
  return status;
}

// What the couplings did in a sub-step adds to the step's mean by the sub-step's share of its time.
void BodySystem::report(const SubStep& step) {
  for (const ActiveCoupling& c : couplings_) {
    const Wrench on_body = coupling_wrench(c, solves_[c.body], step.dt);
    grips_[c.grip].on_hand.force -= step.share * on_body.force;
    grips_[c.grip].on_hand.torque -= step.share * on_body.torque;
    grips_[c.grip].handle = c.handle;
  }
}

void BodySystem::damp_held(double keep) {
  const auto damp = [&](RigidBody& body) {
    body.velocity *= keep;
    body.angular_momentum *= keep;
    body.angular_velocity *= keep;
  };
  for (const ActiveCoupling& c : couplings_) damp(bodies_[c.body]);
  if (joints_.empty()) return;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const int body = static_cast<int>(b);
    if (bodies_[b].moves() && couplings_of(body).empty() && is_held(body)) damp(bodies_[b]);
  }
}

void BodySystem::restore(std::vector<RigidBody> bodies, std::vector<GripState> grips,
                         std::vector<HandleInput> inputs, Hands::Stiffness stiffness,
                         std::vector<KeptImpulse> impulses) {
  for (std::size_t b = 0; b < bodies.size(); ++b) become(static_cast<int>(b), bodies[b]);
  grips_ = std::move(grips);
  hands_.restore(std::move(inputs));
  hands_.restore(std::move(stiffness));
  memory_.restore(std::move(impulses));
}

}  // namespace slosh
