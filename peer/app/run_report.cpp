#include "peer/app/run_report.h"

#include "sim/math/format.h"

namespace slosh {

Spread spread_of(const Histogram& histogram, double unit) {
  return {histogram.percentile(0.5) * unit, histogram.percentile(0.99) * unit, histogram.max() * unit};
}

void report_stage(const Stage& stage, RunSummary& s) {
  s.scene = stage.scene.name;
  s.scene_file = stage.scene.source_file;
  s.machine = stage.machine;
  s.version = SLOSH_VERSION;
  s.folder = stage.folder.string();
}

void report_time(double simulated, double wall, RunSummary& s) {
  s.simulated = simulated;
  s.wall = wall;
  s.real_time_factor = wall > 0.0 ? simulated / wall : 0.0;
}

void report_steps(const StepTimes& total, const Histogram& step_time, RunSummary& s) {
  s.step_ms = spread_of(step_time, 1e3);
  const double all = total.total > 0.0 ? total.total : 1.0;
  for (std::size_t i = 0; i < kPassCount; ++i) {
    if (total.pass[i] > 0.0) s.step_share.emplace_back(name(static_cast<PassId>(i)), total.pass[i] / all);
  }
}

void report_left(const Diagnostics& end, const Diagnostics& start, const Plan& plan, RunSummary& s) {
  s.retired_particles = end.retired;
  s.lost_particles = end.lost;
  s.retired_settling = start.retired;
  s.lost_settling = start.lost;
  s.walls_hold = plan.walls_hold();
  s.fluid_came = start.particles + start.retired != end.particles + end.retired;
  s.fluid_mass_start = start.mass;
  s.fluid_mass_end = end.mass;
}

void report_task(const Scene& scene, const std::vector<TaskState::Done>& done, RunSummary& summary) {
  for (std::size_t i = 0; i < scene.task.size(); ++i) {
    TaskStepSummary step{scene.task[i].say, i < done.size(), false, 0.0};
    if (step.done) {
      step.late = done[i].late;
      step.took = done[i].took;
      const std::vector<const Goal*> leaves = leaves_of(scene.task[i].until);
      for (std::size_t k = 0; k < leaves.size() && k < done[i].measured.size(); ++k) {
        const char* unit = unit_of(leaves[k]->kind);
        step.measured.push_back(measured_in_words(*leaves[k], scene) +
                                format(" %.3g%s%s", done[i].measured[k], *unit ? " " : "", unit));
      }
    }
    summary.task.push_back(std::move(step));
  }
}

}  // namespace slosh
