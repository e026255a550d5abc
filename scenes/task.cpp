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

std::string limits(const Goal& goal) {
  const bool low = std::isfinite(goal.at_least);
  const bool high = std::isfinite(goal.at_most);
  const std::string unit = std::string(" ") + unit_of(goal.kind);
  if (low && high) return number(goal.at_least) + " to " + number(goal.at_most) + unit;
  return (low ? "at least " + number(goal.at_least) : "at most " + number(goal.at_most)) + unit;
}

std::string joined(const std::vector<Goal>& parts, const char* between, const Scene& scene) {
  std::string text;
  for (const Goal& part : parts) text += (text.empty() ? "" : between) + in_words(part, scene);
  return text;
}

}  // namespace

const char* unit_of(GoalKind kind) {
  switch (kind) {
    case GoalKind::kMass:
      return "kg";
    case GoalKind::kLevel:
    case GoalKind::kDistance:
      return "m";
    case GoalKind::kTilt:
      return "\xC2\xB0";
    case GoalKind::kSpeed:
      return "m/s";
    case GoalKind::kForce:
      return "N";
    case GoalKind::kAll:
    case GoalKind::kAny:
    case GoalKind::kNot:
      break;
  }
  return "";
}

std::string measured_in_words(const Goal& goal, const Scene& scene) {
  const auto other = static_cast<std::size_t>(std::max(goal.other, 0));
  switch (goal.kind) {
    case GoalKind::kMass:
      return (goal.other < 0 ? "fluid" : scene.fluids[other].name) + " in " + goal.name;
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
    case GoalKind::kAll:
    case GoalKind::kAny:
    case GoalKind::kNot:
      break;
  }
  return {};
}

std::string in_words(const Goal& goal, const Scene& scene) {
  if (goal.kind == GoalKind::kAll) return joined(goal.parts, ", and ", scene);
  if (goal.kind == GoalKind::kAny) return joined(goal.parts, ", or ", scene);
  if (goal.kind == GoalKind::kNot) return "not (" + joined(goal.parts, "", scene) + ")";
  return measured_in_words(goal, scene) + ": " + limits(goal);
}

}  // namespace slosh
