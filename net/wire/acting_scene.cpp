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
  const bool made_of_parts = goal.kind >= GoalKind::kAll;
  if (made_of_parts ? sent.parts == 0 : sent.parts > 0) return false;
  if (goal.kind == GoalKind::kNot && sent.parts != 1) return false;
  goal.parts.resize(sent.parts);
  for (Goal& part : goal.parts)
    if (!unflatten(goals, scene, at, part, depth + 1)) return false;
  return true;
}

}  // namespace

void fill_acting(const Scene& scene, ComingScene& coming) {
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

bool take_acting(ComingScene& coming, bool comes, Scene& scene) {
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
    if (!unflatten(acting.goals, scene, at, step.until)) return false;
  if (at != acting.goals.size()) return false;
  if (!comes) return true;
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
  return true;
}

}  // namespace slosh::wire
