#include "sim/saved_state.h"

#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "sim/saved_particles.h"

namespace slosh {

namespace {

constexpr std::uint32_t kMagic = 0x54535753;  // "SWST"
constexpr std::uint32_t kVersion = 9;
constexpr std::uint32_t kBeforeCuts = 8;     // without SavedState::planes, and read as well: nothing was cut
constexpr std::uint32_t kBeforeWaiting = 7;  // without SavedState::waiting and joints that let go, and read
                                             // as well: none waited, all held
constexpr std::uint32_t kBeforeJoints = 6;   // without SavedState::joints, and read as well: there were none
constexpr std::uint32_t kBeforeBroken = 5;   // without ParticleState::broken, and read as well: none was
constexpr std::uint32_t kBeforeGone = 4;     // without RigidBody::gone, and read as well: no body was
constexpr std::uint32_t kBeforeStiffness = 3;  // without grip_stiffness, and read as well: it was the scene's
constexpr std::int64_t kMaxOfImpulse = std::int64_t{1} << 62;
constexpr std::int64_t kMaxWaiting = std::int64_t{1} << 48;  // particles
const char kWhere[] = "saved world";

template <class S, class V>
void three(S& s, V& v) {
  for (int i = 0; i < 3; ++i) s.real(v[i]);
}
template <class S, class Q>
void rotation(S& s, Q& q) {
  for (auto* part : {&q.w, &q.x, &q.y, &q.z}) s.real(*part);
  if constexpr (S::kReads) {
    if (s.ok() && !(std::abs(glm::length(q) - 1.0) < 1e-3)) s.fail("it holds a rotation that is none");
  }
}
template <class S, class W>
void wrench(S& s, W& w) {
  three(s, w.force);
  three(s, w.torque);
}
template <class S, class B>
void body_state(S& s, B& b) {
  three(s, b.position);
  rotation(s, b.orientation);
  three(s, b.velocity);
  three(s, b.angular_momentum);
  three(s, b.angular_velocity);
}
template <class S, class G>
void grip_state(S& s, G& g) {
  three(s, g.handle.position);
  rotation(s, g.handle.orientation);
  wrench(s, g.on_hand);
}
template <class S, class I>
void hand_state(S& s, I& input) {
  three(s, input.pose.position);
  rotation(s, input.pose.orientation);
  three(s, input.twist.linear);
  three(s, input.twist.angular);
  s.real(input.scale);
}

template <class S, class K>
void kept_impulse(S& s, K& k) {
  s.raw(k.first);
  s.raw(k.second);
  three(s, k.point);
  three(s, k.impulse);
}

template <class S, class J, class M>
void joint_state(S& s, J& joint, M& mean) {
  s.real(joint.position);
  s.real(joint.motor);
  s.real(joint.stop);
  wrench(s, joint.impulse);
  s.real(mean.motor);
  wrench(s, mean.reaction);
}

/// A byte for one of the values up to `last`.
template <class S, class C, class E>
void choice(S& s, C& value, E last, const char* problem) {
  auto byte = static_cast<std::uint8_t>(value);
  s.raw(byte);
  if constexpr (S::kReads) {
    if (s.ok() && byte > static_cast<std::uint8_t>(last)) return s.fail(problem);
    value = static_cast<E>(byte);
  }
}

template <class S, class J>
void joint_hold(S& s, J& joint) {
  choice(s, joint.hold, JointHold::kOpen, "a joint in it neither holds nor is open");
  three(s, joint.rest.position);
  rotation(s, joint.rest.orientation);
}

template <class S, class P>
void cut_plane(S& s, P& plane) {
  three(s, plane.normal);
  s.real(plane.offset);
  if constexpr (S::kReads) {
    if (s.ok() && !(std::abs(glm::length(plane.normal) - 1.0) < 1e-6))
      s.fail("it holds the plane of a cut that is none");
  }
}

template <class S, class I>
void incision(S& s, I& i) {
  s.raw(i.blade);
  s.raw(i.body);
  cut_plane(s, i.plane);
  three(s, i.way);
  s.real(i.front);
  choice(s, i.stage, CutStage::kParting, "a blade in it neither cuts nor is through");
}

void write_cuts(StateSink& s, const SavedState& state) {
  for (const std::vector<CutPlane>& planes : state.planes) {
    s.raw(static_cast<std::uint8_t>(planes.size()));
    for (const CutPlane& plane : planes) cut_plane(s, plane);
  }
  s.raw(static_cast<std::uint32_t>(state.incisions.size()));
  for (const Incision& i : state.incisions) incision(s, i);
}

void read_cuts(StateSource& s, std::uint64_t bodies, SavedState& state) {
  state.planes.assign(bodies, {});
  for (std::vector<CutPlane>& planes : state.planes) {
    std::uint8_t count = 0;
    s.raw(count);
    if (count > kMaxCutPlanes) s.fail("a body in it has more cut faces than there can be");
    if (!s.ok()) return;
    planes.resize(count);
    for (CutPlane& plane : planes) cut_plane(s, plane);
  }
  std::uint32_t count = 0;
  s.raw(count);
  if (s.ok() && s.left() / (8 * sizeof(double)) < count) s.fail("it ends too early");
  if (!s.ok()) return;
  state.incisions.resize(count);
  for (Incision& i : state.incisions) {
    incision(s, i);
    if (!s.ok()) return;
    const auto is_body = [&](int b) { return b >= 0 && static_cast<std::uint64_t>(b) < bodies; };
    if (!is_body(i.blade) || !is_body(i.body)) return s.fail("a blade in it is in no body of this world");
    if (!(std::abs(glm::length(i.way) - 1.0) < 1e-6) || !(std::abs(glm::dot(i.way, i.plane.normal)) < 1e-6))
      return s.fail("it holds the way of a blade that is none");
  }
}

// Pairs of bodies that there are, in order: the solve looks them up.
void read_impulses(StateSource& s, std::uint64_t bodies, std::vector<KeptImpulse>& impulses) {
  std::uint32_t count = 0;
  s.raw(count);
  // What is there decides how much is allocated.
  if (s.ok() && s.left() / sizeof(KeptImpulse) < count) s.fail("it ends too early");
  if (!s.ok()) return;
  impulses.resize(count);
  std::pair<int, int> last{0, 0};
  for (KeptImpulse& k : impulses) {
    kept_impulse(s, k);
    const std::pair<int, int> now{k.first, k.second};
    if (!s.ok()) return;
    if (k.first < 0 || k.second <= k.first || static_cast<std::uint64_t>(k.second) >= bodies || now < last)
      return s.fail("a contact in it is not between two bodies of this world");
    last = now;
  }
}

void write_frame(StateSink& s, const StateFrame& f) {
  for (const std::uint64_t n :
       {f.fluid_particles, f.probes, f.body_particles, f.bodies, f.grips, f.fluids, f.scene}) {
    s.raw(n);
  }
  for (const double value : {f.spacing, f.time_step, f.stiffness}) s.raw(value);
}

std::string differs(const char* what, double saved, double here) {
  char text[160];
  std::snprintf(text, sizeof text, "it was saved with %s of %.10g, and here it is %.10g", what, saved, here);
  return text;
}

void read_frame(StateSource& s, const StateFrame& here) {
  const auto count = [&](const char* what, std::uint64_t wanted) {
    std::uint64_t n = 0;
    s.raw(n);
    if (s.ok() && n != wanted) s.fail(differs(what, static_cast<double>(n), static_cast<double>(wanted)));
  };
  count("a number of fluid particles", here.fluid_particles);
  count("a number of probes", here.probes);
  count("a number of body particles", here.body_particles);
  count("a number of bodies", here.bodies);
  count("a number of grips", here.grips);
  count("a number of fluids", here.fluids);
  std::uint64_t scene = 0;
  s.raw(scene);
  const auto value = [&](const char* what, double wanted) {
    double saved = 0.0;
    s.raw(saved);
    // Another compiler may round the plan's numbers otherwise.
    if (s.ok() && !(std::abs(saved - wanted) <= 1e-9 * std::abs(wanted)))
      s.fail(differs(what, saved, wanted));
  };
  value("a spacing", here.spacing);
  value("a time step", here.time_step);
  value("a stiffness", here.stiffness);
  if (s.ok() && scene != here.scene)
    s.fail("it was saved from another scene, or from this one before it was changed");
}

}  // namespace

void write_state(const StateFrame& frame, const RunConstants& constants, const SavedState& state,
                 std::vector<std::uint8_t>& out) {
  out.reserve(out.size() + bytes_a_particle(constants.plan) * state.particles.size() +
              400 * (state.bodies.size() + state.grips.size()) + 1024);
  StateSink s(out);
  s.raw(kMagic);
  s.raw(kVersion);
  write_frame(s, frame);
  s.raw(state.tick);
  s.raw(state.status);
  s.real(state.gravity_scale);
  s.real(state.age);
  s.raw(state.particles.broken);
  s.raw(state.waiting);
  for (const double viscosity : state.viscosities) s.real(viscosity);
  for (const RigidBody& body : state.bodies) {
    body_state(s, body);
    s.raw(static_cast<std::uint8_t>(body.gone));
  }
  if (frame.cuts) write_cuts(s, state);
  for (const Wrench& w : state.wrenches) wrench(s, w);
  for (const GripState& grip : state.grips) grip_state(s, grip);
  for (const HandleInput& input : state.last_input) {
    s.raw(static_cast<std::uint8_t>(input.engaged));
    // What a disengaged hand reads is never used, and need not even be a number.
    const HandleInput nothing;
    hand_state(s, input.engaged ? input : nothing);
  }
  for (const auto* scales : {&state.grip_stiffness.wanted, &state.grip_stiffness.acting})
    for (const double scale : *scales) s.real(scale);
  s.raw(static_cast<std::uint32_t>(state.impulses.size()));
  for (const KeptImpulse& k : state.impulses) kept_impulse(s, k);
  for (std::size_t j = 0; j < state.joints.size(); ++j) {
    joint_state(s, state.joints[j], state.joint_means[j]);
    joint_hold(s, state.joints[j]);
  }
  s.column(std::span<const std::int64_t>(state.walls));
  write_particles(s, constants, state);
}

Result<bool> read_state(std::span<const std::uint8_t> bytes, const StateFrame& frame,
                        const RunConstants& constants, SavedState& state) {
  StateSource s(bytes);
  std::uint32_t magic = 0;
  std::uint32_t version = 0;
  s.raw(magic);
  s.raw(version);
  if (magic != kMagic) s.fail("these are not the bytes of a saved world");
  if (version > kVersion || version < kBeforeStiffness) {
    s.fail("it has version " + std::to_string(version) + ", and this program reads version " +
           std::to_string(kVersion));
  }
  if (s.ok()) read_frame(s, frame);
  s.raw(state.tick);
  if (state.tick > kMaxTicks) s.fail("its tick is beyond all bounds");
  s.raw(state.status);
  s.real(state.gravity_scale);
  if (!(state.gravity_scale >= 0.0 && state.gravity_scale <= kMaxGravityScale))
    s.fail("its gravity is beyond all bounds");
  s.real(state.age);
  if (!(state.age >= 0.0)) s.fail("its age is negative");
  if (version > kBeforeBroken) s.raw(state.particles.broken);
  if (state.particles.broken > frame.fluid_particles)
    s.fail("more particles of it were broken than there are");
  if (version > kBeforeWaiting) s.raw(state.waiting);
  if (std::abs(state.waiting) > kMaxWaiting) s.fail("a number of particles in it is beyond all bounds");
  state.viscosities.resize(frame.fluids);
  for (double& viscosity : state.viscosities) {
    s.real(viscosity);
    if (!(viscosity >= 0.0)) s.fail("a viscosity in it is negative");
  }
  for (RigidBody& body : state.bodies) {
    RigidBody read = body;
    body_state(s, read);
    std::uint8_t gone = 0;
    if (version > kBeforeGone) s.raw(gone);
    if (gone > (body.is_fixed() ? 0 : 1)) s.fail("a body in it is neither in the world nor out of it");
    read.gone = gone != 0;
    if (!body.is_fixed()) body = read;
  }
  if (frame.cuts && version > kBeforeCuts) read_cuts(s, frame.bodies, state);
  state.wrenches.resize(frame.bodies);
  for (Wrench& w : state.wrenches) wrench(s, w);
  state.grips.resize(frame.grips);
  for (GripState& grip : state.grips) grip_state(s, grip);
  state.last_input.resize(frame.grips);
  for (HandleInput& input : state.last_input) {
    std::uint8_t engaged = 0;
    s.raw(engaged);
    hand_state(s, input);
    input.engaged = engaged == 1;
    if (engaged > 1) s.fail("a hand in it neither holds nor lets go");
  }
  for (auto* scales : {&state.grip_stiffness.wanted, &state.grip_stiffness.acting}) {
    scales->assign(frame.grips, 1.0);
    if (version == kBeforeStiffness) continue;
    for (double& scale : *scales) s.real(scale);  // whether it may be is World::restore's to say
  }
  read_impulses(s, frame.bodies, state.impulses);
  state.joints.resize(frame.joints);
  state.joint_means.resize(frame.joints);
  for (std::size_t j = 0; j < frame.joints && version > kBeforeJoints; ++j) {
    joint_state(s, state.joints[j], state.joint_means[j]);
    if (version > kBeforeWaiting) joint_hold(s, state.joints[j]);
  }
  state.walls = no_impulses(frame.bodies);
  s.column(std::span(state.walls));
  for (const std::int64_t word : state.walls) {
    if (word > kMaxOfImpulse || word < -kMaxOfImpulse) s.fail("an impulse in it is beyond all bounds");
  }
  read_particles(s, frame, constants, state);
  if (!s.ok()) return Error{kWhere, s.problem(), ""};
  return true;
}

}  // namespace slosh
