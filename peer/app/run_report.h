// What runs of every kind say of themselves in a summary, beside what each adds.
#pragma once

#include "host/guided_task.h"
#include "net/histogram.h"
#include "peer/app/prepare.h"
#include "peer/output/summary.h"
#include "sim/world.h"

namespace slosh {

/// Scene, machine, program and folder.
void report_stage(const Stage& stage, RunSummary& summary);
/// Simulated and wall s, and their ratio.
void report_time(double simulated, double wall, RunSummary& summary);
/// How long steps took and what they spent it on. `total` in any unit, `step_time` in s.
void report_steps(const StepTimes& total, const Histogram& step_time, RunSummary& summary);
/// What left the world, and the fluid's mass, from `start` of the run to its `end`.
void report_left(const Diagnostics& end, const Diagnostics& start, const Plan& plan, RunSummary& summary);
/// The steps of the scene's task, the first of which are `done`.
void report_task(const Scene& scene, const std::vector<TaskState::Done>& done, RunSummary& summary);
/// `unit`: how many of it are one of the histogram's.
Spread spread_of(const Histogram& histogram, double unit);

}  // namespace slosh
