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

/// What of a body only acts where it is.
struct BodyActs {
  std::optional<double> temperature;  ///< °C
  std::vector<PoseKey> keys;
  bool repeats = false;
};

/// The same of a scene that passes heat, drives bodies, joins them, or guides through a task.
struct ActingScene {
  TexturedScene textured;
  std::vector<Heat> heats;     ///< one a fluid
  std::vector<BodyActs> acts;  ///< one a body
  std::vector<Joint> joints;
  std::vector<TaskStep> task;   ///< without their goals
  std::vector<SentGoal> goals;  ///< of one step after the other
};

/// How a joint lets go and closes.
struct JointChanges {
  double breaks_force = 0.0, breaks_torque = 0.0, joins_within = 0.0, joins_turn = 0.0;
  bool starts_apart = false;
  std::optional<Pose> meets;
};

/// What of a fluid volume only matters where it is filled while the world runs.
struct VolumeComes {
  bool starts_away = false;
  int fillings = 1;
  int body = -1;
};

/// The same of a scene in which bodies or fluids come and go, joints let go or close, or steps of a task do
/// something.
struct ComingScene {
  ActingScene acting;
  std::vector<VolumeComes> volumes;             ///< one a fluid volume
  std::vector<std::uint8_t> starts_away;        ///< one a body
  std::vector<std::vector<TaskAct>> step_acts;  ///< one a step of the task
  std::vector<JointChanges> joint_changes;      ///< one a joint
};

/// How a body is cut, or cuts.
struct BodyCutting {
  int pieces = 0, piece_of = -1;
  double cut_n_m = 0.0;
  bool blade = false;
};

/// The same of a scene in which bodies may be cut.
struct CutScene {
  ComingScene coming;
  std::vector<BodyCutting> cutting;  ///< one a body
};

constexpr double kNoLimit = 1e300;  ///< stands for none: an infinity is no number here
inline double finite_limit(double limit) {
  return std::clamp(limit, -kNoLimit, kNoLimit);
}
inline double open_limit(double limit) {
  const double none = std::numeric_limits<double>::infinity();
  return limit >= kNoLimit ? none : limit <= -kNoLimit ? -none : limit;
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
  v.real64("sets_above", m.sets_above, -kNoLimit, kNoLimit);
  v.real64("sets_below", m.sets_below, -kNoLimit, kNoLimit);
  v.real64("sets_in", m.sets_in, 0.0, 86400.0);
  v.real64("melts_above", m.melts_above, -kNoLimit, kNoLimit);
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

template <class V>
void visit(V& v, BodyActs& m) {
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
void visit(V& v, ActingScene& m) {
  visit(v, m.textured);
  const Scene& scene = m.textured.looked.settled.measured.packed.scene;
  v.list_as_long("heats", m.heats, "fluids", scene.fluids.size(),
                 [](auto& each, Heat& heat) { visit(each, heat); });
  v.list_as_long("acts", m.acts, "bodies", scene.bodies.size(),
                 [](auto& each, BodyActs& body) { visit(each, body); });
  const std::size_t bodies = scene.bodies.size();
  v.list("joints", m.joints, kMaxJoints, [&scene, bodies](auto& each, Joint& joint) {
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
  v.list("task", m.task, kMaxTaskSteps, [](auto& each, TaskStep& step) { visit(each, step); });
  v.list("goals", m.goals, kMaxSentGoals, [&scene](auto& each, SentGoal& sent) {
    each.choice("kind", sent.goal.kind, kGoalKindNames);
    each.index("thing", sent.goal.thing, "bodies", kMaxBodies, true);
    each.index("other", sent.goal.other, "bodies", kMaxBodies, true);
    each.rule("thing", has_thing(scene, sent.goal), "is not in the scene");
    each.real64("at_least", sent.goal.at_least, -kNoLimit, kNoLimit);
    each.real64("at_most", sent.goal.at_most, -kNoLimit, kNoLimit);
    each.natural("parts", sent.parts, 0, kMaxGoalParts);
  });
}

template <class V>
void visit(V& v, JointChanges& m) {
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
void visit(V& v, ComingScene& m) {
  visit(v, m.acting);
  const Scene& scene = m.acting.textured.looked.settled.measured.packed.scene;
  v.list_as_long("volumes", m.volumes, "fluid_volumes", scene.fluid_volumes.size(),
                 [&scene](auto& each, VolumeComes& volume) {
                   each.flag("starts_away", volume.starts_away);
                   auto fillings = static_cast<std::uint32_t>(volume.fillings);
                   each.natural("fillings", fillings, 1, kMaxFillings);
                   volume.fillings = static_cast<int>(fillings);
                   each.index("body", volume.body, "bodies", scene.bodies.size(), true);
                 });
  std::size_t at = 0;
  v.list_as_long("starts_away", m.starts_away, "bodies", scene.bodies.size(),
                 [&scene, &at](auto& each, std::uint8_t& away) {
                   bool is_away = away != 0;
                   each.flag("away", is_away);
                   away = is_away;
                   if (at < scene.bodies.size())
                     each.rule("away", !is_away || moves(scene.bodies[at].motion), "is of a fixed body");
                   ++at;
                 });
  v.list_as_long("step_acts", m.step_acts, "task", m.acting.task.size(),
                 [&scene](auto& each, std::vector<TaskAct>& acts) {
                   each.list("acts", acts, kMaxTaskActs, [&scene](auto& one, TaskAct& act) {
                     one.choice("kind", act.kind, kTaskActKindNames);
                     one.index("thing", act.thing, "things", kMaxBodies + kMaxFluidVolumes, false);
                     one.index("other", act.other, "regions", kMaxInstruments, true);
                     one.rule("thing", can_act(scene, act), "is not in the scene, or stays there for good");
                   });
                 });
  v.list_as_long("joint_changes", m.joint_changes, "joints", m.acting.joints.size(),
                 [](auto& each, JointChanges& changes) { visit(each, changes); });
}

/// What World's cuts count on: a free body of a small mesh, whose pieces have the same one and come behind
/// it.
inline bool can_be_cut(const Scene& scene, std::size_t index, const BodyCutting& cutting) {
  if (cutting.pieces == 0 && cutting.piece_of < 0) return true;
  const Body& body = scene.bodies[index];
  if (body.motion != BodyMotion::kFree || body.point_probe || !below(body.mesh, scene.meshes.size()))
    return false;
  if (cutting.piece_of < 0) return cutting.pieces >= 2;
  return cutting.pieces == 0 && below(cutting.piece_of, index) &&
         scene.bodies[static_cast<std::size_t>(cutting.piece_of)].mesh == body.mesh;
}

template <class V>
void visit(V& v, CutScene& m) {
  visit(v, m.coming);
  const Scene& scene = m.coming.acting.textured.looked.settled.measured.packed.scene;
  std::size_t at = 0;
  v.list_as_long("cutting", m.cutting, "bodies", scene.bodies.size(),
                 [&scene, &at](auto& each, BodyCutting& body) {
                   auto pieces = static_cast<std::uint32_t>(body.pieces);
                   each.natural("pieces", pieces, 0, kMaxPieces);
                   body.pieces = static_cast<int>(pieces);
                   each.index("piece_of", body.piece_of, "bodies", scene.bodies.size(), true);
                   each.real64("cut_n_m", body.cut_n_m, 0.0, 1e6);
                   each.flag("blade", body.blade);
                   if (at < scene.bodies.size()) {
                     each.rule("pieces", can_be_cut(scene, at, body), "is of a body that cannot be cut");
                     each.rule("blade", !body.blade || moves(scene.bodies[at].motion), "is a fixed body's");
                   }
                   ++at;
                 });
}

}  // namespace slosh::wire
