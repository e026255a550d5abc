// What runs of every kind say of themselves in a summary: LocalRun, RemoteRun and ReplayRun add what is
// theirs.
#pragma once

#include "peer/app/prepare.h"
#include "peer/haptics/device_loop.h"
#include "peer/output/recorder.h"
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
/// A line for each hand whose device clips (budget_line); empty where none does.
std::string budget_lines(const Servo& servo, const Scene& scene);
/// The device loop, the devices and their files. All stopped; the recorder's and the servo's grips are
/// `scene`'s.
void report_hands(const DeviceLoop& loop, const Servo& servo, const Recorder& recorder, const Scene& scene,
                  RunSummary& summary);

}  // namespace slosh
