// The field lists of what acts in a scene besides fluid, bodies and hands: heat, driven bodies, joints,
// tasks, and what comes apart or together.
#pragma once

#include <algorithm>
#include <limits>

#include "net/wire/scene_fields.h"

namespace slosh::wire {

constexpr std::size_t kMaxSentGoals = 10'000;  ///< of all steps of a task

/// A goal of a task; those that it is made of come behind it, `parts` of them.
struct SentGoal {
  Goal goal;  ///< without its name and parts
  std::uint32_t parts = 0;
};

/// How much of a scene a package has: each version what those before it have, and more.
enum SceneVersion : std::uint8_t {
  kPlainScene = 1,
  kMeasuredScene,  ///< gauges and regions
  kSettledScene,   ///< settling before the run
  kLookedScene,    ///< how fluids look beyond their colour
  kTexturedScene,  ///< textures, and light of bodies' own
  kActingScene,    ///< heat, driven bodies, joints, a task
  kComingScene,  ///< bodies and fluids that come and go, joints that let go or close, steps that do something
  kCutScene,     ///< bodies that may be cut
};

/// What travels.
struct PackedScene {
  Scene scene;                    ///< on the way without the goals of its task
  double spacing = 0.01;          ///< m, of its particles
  std::vector<SentGoal> goals{};  ///< those of one step after the other's
};

/// The same in one version.
template <SceneVersion Version>
struct SceneAt {
  PackedScene packed;
};

constexpr double kNoLimit = 1e300;  ///< stands for none: an infinity is no number here
inline double finite_limit(double limit) {
  return std::clamp(limit, -kNoLimit, kNoLimit);
}
inline double open_limit(double limit) {
  const double none = std::numeric_limits<double>::infinity();
  return limit >= kNoLimit ? none : limit <= -kNoLimit ? -none : limit;
}

/// Where there may be none.
template <class V>
void visit_limit(V& v, const char* name, double& limit) {
  double sent = finite_limit(limit);
  v.real64(name, sent, -kNoLimit, kNoLimit);
  limit = open_limit(sent);
}

template <class V>
void visit(V& v, Heat& m) {
  v.real64("temperature", m.temperature, kColdest, kHottest);
  v.real64("capacity", m.capacity, 1.0, 1e5);
  v.real64("conductivity", m.conductivity, 0.0, 1e4);
  double before = -1e9;
  v.list("viscosity", m.viscosity, kMaxViscosityPoints, [&before](auto& each, Heat::Point& point) {
    each.real64("temperature", point.temperature, kColdest, kHottest);
    each.rule("temperature", point.temperature > before, "does not rise");
    before = point.temperature;
    each.real64("times", point.times, 1e-16, 1e16);
  });
  visit_limit(v, "sets_above", m.sets_above);
  visit_limit(v, "sets_below", m.sets_below);
  v.real64("sets_in", m.sets_in, 0.0, 86400.0);
  visit_limit(v, "melts_above", m.melts_above);
  v.real64("melts_in", m.melts_in, 0.0, 86400.0);
  v.real64("modulus", m.modulus, 0.0, 1e9);
  v.real64("tears_at", m.tears_at, 0.0, 10.0);
  v.real64("set_times", m.set_times, 1e-16, 1e16);
  v.flag("starts_set", m.starts_set);
}

inline constexpr std::array kGoalKindNames{"mass",   "temperature", "set",  "spread", "evenness",
                                           "mixing", "level",       "tilt", "speed",  "distance",
                                           "force",  "all",         "any",  "not",    "pieces"};

/// Whether an index names one of `count`.
inline bool below(int index, std::size_t count) {
  return index >= 0 && static_cast<std::size_t>(index) < count;
}

/// Whether what a goal names is in the scene.
inline bool has_thing(const Scene& scene, const Goal& goal) {
  if (of_region(goal.kind))
    return below(goal.thing, scene.regions.size()) &&
           (goal.other == -1 || below(goal.other, scene.fluids.size()));
  switch (goal.kind) {
    case GoalKind::kLevel:
      return below(goal.thing, scene.gauges.size());
    case GoalKind::kTilt:
    case GoalKind::kSpeed:
    case GoalKind::kPieces:
      return below(goal.thing, scene.bodies.size());
    case GoalKind::kDistance:
      return below(goal.thing, scene.bodies.size()) && below(goal.other, scene.bodies.size());
    case GoalKind::kForce:
      return below(goal.thing, scene.grips.size());
    default:
      return true;
  }
}

template <class V>
void visit(V& v, TaskStep& m) {
  v.text("say", m.say, kMaxText);
  v.text("hint", m.hint, kMaxText);
  v.real64("hold", m.hold, 0.0, 3600.0);
  v.real64("within", m.within, 0.0, 86400.0);
  v.real64("hint_after", m.hint_after, 0.0, 3600.0);
}

/// What of a body only acts where it is.
template <class V>
void visit_acts(V& v, Body& m) {
  bool given = m.temperature.has_value();
  double celsius = m.temperature.value_or(0.0);
  v.flag("keeps", given);
  v.real64("temperature", celsius, kColdest, kHottest);
  if (given) m.temperature = celsius;
  visit_keys(v, "keys", m.keys);
  v.flag("repeats", m.repeats);
}

/// At least one of the two is free, and none a probe.
inline bool can_be_joined(const Scene& scene, const Joint& joint) {
  bool any_free = false;
  for (const int index : {joint.body, joint.other}) {
    if (index < 0 || static_cast<std::size_t>(index) >= scene.bodies.size()) continue;
    const Body& body = scene.bodies[static_cast<std::size_t>(index)];
    if (body.point_probe) return false;
    any_free |= body.motion == BodyMotion::kFree;
  }
  return any_free;
}

template <class V>
void visit_acting(V& v, PackedScene& m) {
  Scene& scene = m.scene;
  v.each_of("heats", scene.fluids, "fluids", [](auto& each, Fluid& fluid) { visit(each, fluid.heat); });
  v.each_of("acts", scene.bodies, "bodies", [](auto& each, Body& body) { visit_acts(each, body); });
  const std::size_t bodies = scene.bodies.size();
  v.list("joints", scene.joints, kMaxJoints, [&scene, bodies](auto& each, Joint& joint) {
    each.text("name", joint.name, kMaxText);
    each.choice("kind", joint.kind, kJointKindNames);
    each.index("body", joint.body, "bodies", bodies, false);
    each.index("other", joint.other, "bodies", bodies, true);
    each.rule("other", joint.other != joint.body, "is the body itself");
    each.rule("body", can_be_joined(scene, joint), "is a probe's, or of two bodies that no joint moves");
    visit_exact(each, joint.pose);
    each.real64("lower", joint.lower, -kNoStop, 0.0);
    each.real64("upper", joint.upper, 0.0, kNoStop);
    each.real64("damping", joint.damping, 0.0, 1e6);
    each.real64("motor_speed", joint.motor_speed, -1000.0, 1000.0);
    each.real64("motor_limit", joint.motor_limit, 0.0, 1e6);
  });
  v.list("task", scene.task, kMaxTaskSteps, [](auto& each, TaskStep& step) { visit(each, step); });
  v.list("goals", m.goals, kMaxSentGoals, [&scene](auto& each, SentGoal& sent) {
    each.choice("kind", sent.goal.kind, kGoalKindNames);
    each.index("thing", sent.goal.thing, "bodies", kMaxBodies, true);
    each.index("other", sent.goal.other, "bodies", kMaxBodies, true);
    each.rule("thing", has_thing(scene, sent.goal), "is not in the scene");
    visit_limit(each, "at_least", sent.goal.at_least);
    visit_limit(each, "at_most", sent.goal.at_most);
    each.natural("parts", sent.parts, 0, kMaxGoalParts);
  });
}

/// How a joint lets go and closes.
template <class V>
void visit_changes(V& v, Joint& m) {
  v.real64("breaks_force", m.breaks_force, 0.0, 1e6);
  v.real64("breaks_torque", m.breaks_torque, 0.0, 1e6);
  v.real64("joins_within", m.joins_within, 0.0, 10.0);
  v.real64("joins_turn", m.joins_turn, 0.0, 3.15);
  v.flag("starts_apart", m.starts_apart);
  v.rule("starts_apart", !m.starts_apart || m.joins_within > 0.0, "is of a joint that never closes");
  bool given = m.meets.has_value();
  Pose meets = m.meets.value_or(Pose{});
  v.flag("meets_elsewhere", given);
  v.vec3_exact("meets_position", meets.position, kMaxPosition);
  v.rotation_exact("meets_orientation", meets.orientation);
  if (given) m.meets = meets;
}

inline constexpr std::array kTaskActKindNames{"appears", "takes_away", "hand_takes"};

/// Whether what comes, goes or is taken may.
inline bool can_act(const Scene& scene, const TaskAct& act) {
  if (act.kind == TaskActKind::kHandTakes)
    return below(act.thing, scene.grips.size()) && below(act.other, scene.grips.size());
  if (!below(act.thing, thing_count(scene))) return false;
  if (act.other != -1 && !below(act.other, scene.regions.size())) return false;
  if (static_cast<std::size_t>(act.thing) >= scene.bodies.size()) return true;
  const Body& body = scene.bodies[static_cast<std::size_t>(act.thing)];
  return moves(body.motion) && !body.point_probe;
}

template <class V>
void visit_coming(V& v, Scene& scene) {
  v.each_of("volumes", scene.fluid_volumes, "fluid_volumes", [&scene](auto& each, FluidVolume& volume) {
    each.flag("starts_away", volume.starts_away);
    auto fillings = static_cast<std::uint32_t>(volume.fillings);
    each.natural("fillings", fillings, 1, kMaxFillings);
    volume.fillings = static_cast<int>(fillings);
    each.index("body", volume.body, "bodies", scene.bodies.size(), true);
  });
  v.each_of("starts_away", scene.bodies, "bodies", [](auto& each, Body& body) {
    each.flag("away", body.starts_away);
    each.rule("away", !body.starts_away || moves(body.motion), "is of a fixed body");
  });
  v.each_of("step_acts", scene.task, "task", [&scene](auto& each, TaskStep& step) {
    each.list("acts", step.then, kMaxTaskActs, [&scene](auto& one, TaskAct& act) {
      one.choice("kind", act.kind, kTaskActKindNames);
      one.index("thing", act.thing, "things", kMaxBodies + kMaxFluidVolumes, false);
      one.index("other", act.other, "regions", kMaxInstruments, true);
      one.rule("thing", can_act(scene, act), "is not in the scene, or stays there for good");
    });
  });
  v.each_of("joint_changes", scene.joints, "joints",
            [](auto& each, Joint& joint) { visit_changes(each, joint); });
}

/// What World's cuts count on: a free body of a small mesh, whose pieces have the same one and come behind
/// it.
inline bool can_be_cut(const Scene& scene, const Body& body, std::size_t index) {
  if (body.pieces == 0 && body.piece_of < 0) return true;
  if (body.motion != BodyMotion::kFree || body.point_probe || !below(body.mesh, scene.meshes.size()))
    return false;
  if (body.piece_of < 0) return body.pieces >= 2;
  if (body.pieces > 0 || !below(body.piece_of, index)) return false;
  const Body& whole = scene.bodies[static_cast<std::size_t>(body.piece_of)];
  return whole.pieces > 0 && whole.mesh == body.mesh;
}

template <class V>
void visit_cutting(V& v, Scene& scene) {
  std::size_t at = 0;
  v.each_of("cutting", scene.bodies, "bodies", [&scene, &at](auto& each, Body& body) {
    auto pieces = static_cast<std::uint32_t>(body.pieces);
    each.natural("pieces", pieces, 0, kMaxPieces);
    body.pieces = static_cast<int>(pieces);
    each.index("piece_of", body.piece_of, "bodies", scene.bodies.size(), true);
    each.real64("cut_n_m", body.cut_n_m, 0.0, 1e6);
    each.flag("blade", body.blade);
    each.rule("pieces", can_be_cut(scene, body, at++), "is of a body that cannot be cut");
    each.rule("blade", !body.blade || moves(body.motion), "is a fixed body's");
  });
}

template <class V, SceneVersion Version>
void visit(V& v, SceneAt<Version>& m) {
  PackedScene& packed = m.packed;
  v.real64("particle_spacing", packed.spacing, 1e-5, 10.0);
  visit(v, packed.scene);
  if constexpr (Version >= kMeasuredScene) visit_instruments(v, packed.scene);
  if constexpr (Version >= kSettledScene) v.real64("settle", packed.scene.settle, 0.0, kMaxSettle);
  if constexpr (Version >= kLookedScene) visit_looks(v, packed.scene);
  if constexpr (Version >= kTexturedScene) visit_textures(v, packed.scene);
  if constexpr (Version >= kActingScene) visit_acting(v, packed);
  if constexpr (Version >= kComingScene) visit_coming(v, packed.scene);
  if constexpr (Version >= kCutScene) visit_cutting(v, packed.scene);
}

}  // namespace slosh::wire
