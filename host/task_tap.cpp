#include "host/task_tap.h"

#include <algorithm>
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

constexpr double kAskEvery = 0.5;  // simulated s, where something has to wait

}  // namespace

void TaskTap::carry_on(const std::vector<double>& took) {
  task_.carry_on(took);
  steps_acted_ = std::min(took.size(), scene_.task.size());
}

std::vector<double> TaskTap::took() const {
  const std::lock_guard lock(mutex_);
  std::vector<double> all;
  for (const TaskState::Done& step : state_.done) all.push_back(step.took);
  return all;
}

void TaskTap::follow(const World& world) {
  if (!task_.follow(world) && open_.empty()) return;
  std::unique_lock lock(mutex_);
  state_ = task_.state();
  const std::size_t done = state_.done.size();
  if (done < steps_acted_) {
    steps_acted_ = 0;
    open_.clear();
    hands_.clear();
    refused_.clear();
    asked_ = false;
    ask_again_ = 0.0;
    begun_ += 1;
  }
  for (; steps_acted_ < done; ++steps_acted_) {
    const std::vector<TaskAct>& then = scene_.task[steps_acted_].then;
    open_.insert(open_.end(), then.begin(), then.end());
  }
  while (!open_.empty() && open_.front().kind == TaskActKind::kHandTakes) {
    hands_.push_back(
        {static_cast<std::uint32_t>(open_.front().thing), static_cast<std::uint32_t>(open_.front().other)});
    open_.erase(open_.begin());
  }
  if (open_.empty() || asked_ || world.time() < ask_again_) return;
  // What is refused is asked for again: a place may come free.
  asked_ = true;
  ask_again_ = world.time() + kAskEvery;
  const TaskAct next = open_.front();
  lock.unlock();
  const HostAction action = next.kind == TaskActKind::kAppears ? HostAction::kAppear : HostAction::kTakeAway;
  ask_({action, static_cast<std::uint32_t>(next.thing), 1.0 + next.other},
       [this, of = begun_](const Result<bool>& answer) { answered(of, answer); });
}

void TaskTap::answered(std::uint32_t begun, const Result<bool>& answer) {
  const std::lock_guard lock(mutex_);
  if (begun != begun_ || open_.empty()) return;
  asked_ = false;
  // What cannot be taken away is not there, or stays for good: there is nothing to wait for.
  const bool waits = !answer && open_.front().kind == TaskActKind::kAppears;
  refused_ = waits ? answer.error().text() : std::string();
  if (waits) return;
  open_.erase(open_.begin());
  ask_again_ = 0.0;
}

TaskLines TaskTap::lines() const {
  const std::lock_guard lock(mutex_);
  const std::size_t steps = scene_.task.size();
  const std::size_t done = state_.done.size();
  TaskLines lines;
  lines.hands = hands_;
  lines.done = static_cast<std::uint32_t>(done);
  lines.hint = refused_;
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
  if (lines.hint.empty() && taken >= step.hint_after) lines.hint = step.hint;
  return lines;
}

std::vector<TaskState::Done> TaskTap::done() const {
  const std::lock_guard lock(mutex_);
  return state_.done;
}

}  // namespace slosh
