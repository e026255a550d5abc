#include "scenes/task.h"

#include <algorithm>
#include <cmath>

#include "scenes/scene.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

std::string number(double value) {
  return format("%.4g", value);
}

std::string joined(const std::vector<Goal>& parts, const char* between, const Scene& scene) {
  std::string text;
  for (const Goal& part : parts) text += (text.empty() ? "" : between) + in_words(part, scene);
  return text;
}

}  // namespace

std::vector<const Goal*> leaves_of(const Goal& goal) {
  if (!of_parts(goal.kind)) return {&goal};
  std::vector<const Goal*> all;
  for (const Goal& part : goal.parts)
    for (const Goal* leaf : leaves_of(part)) all.push_back(leaf);
  return all;
}

const char* unit_of(GoalKind kind) {
  switch (kind) {
    case GoalKind::kMass:
      return "kg";
    case GoalKind::kTemperature:
      return "\xC2\xB0"
             "C";
    case GoalKind::kSpread:
      return "m\xC2\xB2";
    case GoalKind::kLevel:
    case GoalKind::kDistance:
      return "m";
    case GoalKind::kTilt:
      return "\xC2\xB0";
    case GoalKind::kSpeed:
      return "m/s";
    case GoalKind::kForce:
      return "N";
    case GoalKind::kPieces:
    case GoalKind::kSet:
    case GoalKind::kEvenness:
    case GoalKind::kMixing:
    case GoalKind::kAll:
    case GoalKind::kAny:
    case GoalKind::kNot:
      break;
  }
  return "";
}

std::string limits_in_words(const Goal& goal) {
  const bool low = std::isfinite(goal.at_least);
  const bool high = std::isfinite(goal.at_most);
  const char* unit = unit_of(goal.kind);
  const std::string behind = *unit ? std::string(" ") + unit : std::string();
  if (low && high) return number(goal.at_least) + " to " + number(goal.at_most) + behind;
  return (low ? "at least " + number(goal.at_least) : "at most " + number(goal.at_most)) + behind;
}

std::string measured_in_words(const Goal& goal, const Scene& scene) {
  const auto other = static_cast<std::size_t>(std::max(goal.other, 0));
  const std::string fluid = of_region(goal.kind) && goal.other >= 0 ? scene.fluids[other].name : "fluid";
  switch (goal.kind) {
    case GoalKind::kMass:
      return fluid + " in " + goal.name;
    case GoalKind::kTemperature:
      return "temperature of " + fluid + " in " + goal.name;
    case GoalKind::kSet:
      return "set share of " + fluid + " in " + goal.name;
    case GoalKind::kSpread:
      return "spread of " + fluid + " in " + goal.name;
    case GoalKind::kEvenness:
      return "evenness of " + fluid + " in " + goal.name;
    case GoalKind::kMixing:
      return "mixing of " + fluid + " in " + goal.name;
    case GoalKind::kLevel:
      return "level at " + goal.name;
    case GoalKind::kTilt:
      return "tilt of " + goal.name;
    case GoalKind::kSpeed:
      return "speed of " + goal.name;
    case GoalKind::kDistance:
      return goal.name + " from " + scene.bodies[other].name;
    case GoalKind::kForce:
      return "force on " + goal.name;
    case GoalKind::kPieces:
      return "pieces of " + goal.name;
    case GoalKind::kAll:
    case GoalKind::kAny:
    case GoalKind::kNot:
      break;
  }
  return {};
}

std::string in_words(const TaskAct& act, const Scene& scene) {
  const auto thing = static_cast<std::size_t>(std::max(act.thing, 0));
  if (act.kind == TaskActKind::kAppears) return thing_name(scene, thing) + " appears";
  if (act.kind == TaskActKind::kTakesAway)
    return thing_name(scene, thing) +
           (act.other < 0 ? "" : " in " + scene.regions[static_cast<std::size_t>(act.other)].name) +
           " is taken away";
  return "the hand at " + scene.grips[thing].name + " takes " +
         scene.grips[static_cast<std::size_t>(std::max(act.other, 0))].name;
}

std::string in_words(const Goal& goal, const Scene& scene) {
  if (goal.kind == GoalKind::kAll) return joined(goal.parts, ", and ", scene);
  if (goal.kind == GoalKind::kAny) return joined(goal.parts, ", or ", scene);
  if (goal.kind == GoalKind::kNot) return "not (" + joined(goal.parts, "", scene) + ")";
  return measured_in_words(goal, scene) + ": " + limits_in_words(goal);
}

}  // namespace slosh
