#include "host/task_tap.h"

#include <cmath>
#include <cstdio>

namespace slosh {
namespace {

/// "fluid in pan_inside 0.06 kg, wanted at least 0.4".
std::string measured_text(const TaskState& state, const Scene& scene) {
  if (!state.asked || !std::isfinite(state.measured)) return {};
  const Goal& goal = *state.asked;
  const bool low = std::isfinite(goal.at_least);
  const bool high = std::isfinite(goal.at_most);
  char value[48];
  std::snprintf(value, sizeof value, " %.3g %s, wanted ", state.measured, unit_of(goal.kind));
  char limits[64];
  if (low && high)
    std::snprintf(limits, sizeof limits, "%.3g to %.3g", goal.at_least, goal.at_most);
  else
    std::snprintf(limits, sizeof limits, "at %s %.3g", low ? "least" : "most",
                  low ? goal.at_least : goal.at_most);
  return measured_in_words(goal, scene) + value + limits;
}

}  // namespace

TaskLines TaskTap::lines() const {
  const std::lock_guard lock(mutex_);
  const std::size_t steps = scene_.task.size();
  const std::size_t done = state_.done.size();
  TaskLines lines;
  if (done == steps) {
    lines.title = "done";
    double took = 0.0;
    for (const TaskState::Done& step : state_.done) took += step.took;
    char text[64];
    std::snprintf(text, sizeof text, "All %zu steps in %.1f s", steps, took);
    lines.say = text;
    return lines;
  }
  const TaskStep& step = scene_.task[done];
  const double taken = state_.now - state_.begun;
  lines.title = "step " + std::to_string(done + 1) + " of " + std::to_string(steps);
  if (step.within > 0.0) {
    char text[48];
    std::snprintf(text, sizeof text, taken > step.within ? ", %.0f s late" : ", %.0f s left",
                  std::abs(step.within - taken));
    lines.title += text;
  }
  lines.say = step.say;
  lines.now = measured_text(state_, scene_);
  if (state_.held > 0.0 && step.hold > 0.0) {
    char text[48];
    std::snprintf(text, sizeof text, "%s%.1f of %.1f s held", lines.now.empty() ? "" : "; ", state_.held,
                  step.hold);
    lines.now += text;
  }
  if (taken >= step.hint_after) lines.hint = step.hint;
  return lines;
}

std::vector<TaskState::Done> TaskTap::done() const {
  const std::lock_guard lock(mutex_);
  return state_.done;
}

}  // namespace slosh
