#include "host/task_tap.h"

#include <cmath>

#include "sim/math/format.h"

namespace slosh {
namespace {

/// "fluid in pan_inside 0.06 kg, wanted at least 0.4".
std::string measured_text(const TaskState& state, const Scene& scene) {
  if (!state.asked || !std::isfinite(state.measured)) return {};
  const Goal& goal = *state.asked;
  const char* unit = unit_of(goal.kind);
  return measured_in_words(goal, scene) +
         format(" %.3g%s%s, wanted ", state.measured, *unit ? " " : "", unit) + limits_in_words(goal);
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
    lines.say = format("All %zu steps in %.1f s", steps, took);
    return lines;
  }
  const TaskStep& step = scene_.task[done];
  const double taken = state_.now - state_.begun;
  lines.title = format("step %zu of %zu", done + 1, steps);
  if (step.within > 0.0)
    lines.title +=
        format(", %.0f s %s", std::abs(step.within - taken), taken > step.within ? "late" : "left");
  lines.say = step.say;
  lines.now = measured_text(state_, scene_);
  if (state_.held > 0.0 && step.hold > 0.0)
    lines.now += format("%s%.1f of %.1f s held", lines.now.empty() ? "" : "; ", state_.held, step.hold);
  if (taken >= step.hint_after) lines.hint = step.hint;
  return lines;
}

std::vector<TaskState::Done> TaskTap::done() const {
  const std::lock_guard lock(mutex_);
  return state_.done;
}

}  // namespace slosh
