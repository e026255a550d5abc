#include "net/wire/sent_goals.h"

#include <algorithm>
#include <utility>

namespace slosh::wire {
namespace {

/// A goal and what it is made of, one behind the other.
void flatten(const Goal& goal, std::vector<SentGoal>& goals) {
  SentGoal sent{goal, static_cast<std::uint32_t>(goal.parts.size())};
  sent.goal.parts.clear();
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
  goal.name = name_of(scene, goal);
  if (of_parts(goal.kind) ? sent.parts == 0 : sent.parts > 0) return false;
  if (goal.kind == GoalKind::kNot && sent.parts != 1) return false;
  goal.parts.resize(sent.parts);
  for (Goal& part : goal.parts)
    if (!unflatten(goals, scene, at, part, depth + 1)) return false;
  return true;
}

}  // namespace

void send_goals(PackedScene& packed) {
  for (TaskStep& step : packed.scene.task) {
    flatten(step.until, packed.goals);
    step.until = {};
  }
}

bool take_goals(PackedScene& packed) {
  std::size_t at = 0;
  return std::ranges::all_of(
             packed.scene.task,
             [&](TaskStep& step) { return unflatten(packed.goals, packed.scene, at, step.until); }) &&
         at == packed.goals.size();
}

}  // namespace slosh::wire
