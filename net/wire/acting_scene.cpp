#include "net/wire/acting_scene.h"

#include <utility>

namespace slosh::wire {
namespace {

/// A goal and what it is made of, one behind the other.
void flatten(const Goal& goal, std::vector<SentGoal>& goals) {
  SentGoal sent{goal, static_cast<std::uint32_t>(goal.parts.size())};
  sent.goal.parts.clear();
  sent.goal.at_least = finite_limit(goal.at_least);
  sent.goal.at_most = finite_limit(goal.at_most);
  goals.push_back(std::move(sent));
  for (const Goal& part : goal.parts) flatten(part, goals);
}

std::string name_of(const Scene& scene, const Goal& goal) {
  const auto thing = static_cast<std::size_t>(std::max(goal.thing, 0));
  if (of_region(goal.kind)) return scene.regions[thing].name;
  switch (goal.kind) {
    case GoalKind::kLevel:
      return scene.gauges[thing].name;
    case GoalKind::kForce:
      return scene.grips[thing].name;
    case GoalKind::kTilt:
    case GoalKind::kSpeed:
    case GoalKind::kPieces:
    case GoalKind::kDistance:
      return scene.bodies[thing].name;
    default:
      return {};
  }
}

/// The goal at `at`, with its parts; false where it is not whole, or deeper than any may be.
bool unflatten(const std::vector<SentGoal>& goals, const Scene& scene, std::size_t& at, Goal& goal,
               int depth = 0) {
  if (at >= goals.size() || depth > kDeepestGoal) return false;
  const SentGoal& sent = goals[at++];
  goal = sent.goal;
  goal.at_least = open_limit(goal.at_least);
  goal.at_most = open_limit(goal.at_most);
  goal.name = name_of(scene, goal);
  if (of_parts(goal.kind) ? sent.parts == 0 : sent.parts > 0) return false;
  if (goal.kind == GoalKind::kNot && sent.parts != 1) return false;
  goal.parts.resize(sent.parts);
  for (Goal& part : goal.parts)
    if (!unflatten(goals, scene, at, part, depth + 1)) return false;
  return true;
}

std::string take_cutting(const std::vector<BodyCutting>& cutting, Scene& scene) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    Body& body = scene.bodies[i];
    body.pieces = cutting[i].pieces;
    body.piece_of = cutting[i].piece_of;
    body.cut_n_m = cutting[i].cut_n_m;
    body.blade = cutting[i].blade;
    if (body.piece_of >= 0 && scene.bodies[static_cast<std::size_t>(body.piece_of)].pieces == 0)
      return "a piece is of a body that cannot be cut";
  }
  return {};
}

}  // namespace

void fill_acting(const Scene& scene, CutScene& cut) {
  for (const Body& body : scene.bodies)
    cut.cutting.push_back({body.pieces, body.piece_of, body.cut_n_m, body.blade});
  ComingScene& coming = cut.coming;
  ActingScene& acting = coming.acting;
  for (const FluidVolume& volume : scene.fluid_volumes)
    coming.volumes.push_back({volume.starts_away, volume.fillings, volume.body});
  for (const Body& body : scene.bodies) coming.starts_away.push_back(body.starts_away);
  for (const TaskStep& step : scene.task) coming.step_acts.push_back(step.then);
  for (const Joint& joint : scene.joints)
    coming.joint_changes.push_back({joint.breaks_force, joint.breaks_torque, joint.joins_within,
                                    joint.joins_turn, joint.starts_apart, joint.meets});
  for (const Fluid& fluid : scene.fluids) {
    Heat heat = fluid.heat;
    for (double* limit : {&heat.sets_above, &heat.sets_below, &heat.melts_above})
      *limit = finite_limit(*limit);
    acting.heats.push_back(std::move(heat));
  }
  for (const Body& body : scene.bodies) acting.acts.push_back({body.temperature, body.keys, body.repeats});
  acting.joints = scene.joints;
  acting.task = scene.task;
  for (TaskStep& step : acting.task) {
    flatten(step.until, acting.goals);
    step.until = {};
  }
}

std::string take_acting(CutScene& cut, bool comes, bool is_cut, Scene& scene) {
  constexpr const char* kOddGoals = "goals of its task do not fit its steps";
  ComingScene& coming = cut.coming;
  ActingScene& acting = coming.acting;
  for (std::size_t i = 0; i < scene.fluids.size(); ++i) {
    Heat& heat = scene.fluids[i].heat = std::move(acting.heats[i]);
    for (double* limit : {&heat.sets_above, &heat.sets_below, &heat.melts_above}) *limit = open_limit(*limit);
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    scene.bodies[i].temperature = acting.acts[i].temperature;
    scene.bodies[i].keys = std::move(acting.acts[i].keys);
    scene.bodies[i].repeats = acting.acts[i].repeats;
  }
  scene.joints = std::move(acting.joints);
  scene.task = std::move(acting.task);
  std::size_t at = 0;
  for (TaskStep& step : scene.task)
    if (!unflatten(acting.goals, scene, at, step.until)) return kOddGoals;
  if (at != acting.goals.size()) return kOddGoals;
  if (!comes) return {};
  for (std::size_t i = 0; i < scene.fluid_volumes.size(); ++i) {
    scene.fluid_volumes[i].starts_away = coming.volumes[i].starts_away;
    scene.fluid_volumes[i].fillings = coming.volumes[i].fillings;
    scene.fluid_volumes[i].body = coming.volumes[i].body;
  }
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    scene.bodies[i].starts_away = coming.starts_away[i] != 0;
  for (std::size_t i = 0; i < scene.task.size(); ++i) scene.task[i].then = std::move(coming.step_acts[i]);
  for (std::size_t i = 0; i < scene.joints.size(); ++i) {
    const JointChanges& changes = coming.joint_changes[i];
    Joint& joint = scene.joints[i];
    joint.breaks_force = changes.breaks_force;
    joint.breaks_torque = changes.breaks_torque;
    joint.joins_within = changes.joins_within;
    joint.joins_turn = changes.joins_turn;
    joint.starts_apart = changes.starts_apart;
    joint.meets = changes.meets;
  }
  return is_cut ? take_cutting(cut.cutting, scene) : std::string();
}

}  // namespace slosh::wire
