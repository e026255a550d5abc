#include "peer/app/export_source.h"

namespace slosh {
namespace {

constexpr std::uint8_t kRetired = 255;  // Snapshot::fluid_index

ExportedFluids exported_fluids(const Scene& scene, double spacing) {
  ExportedFluids fluids;
  fluids.spacing = spacing;
  for (const Fluid& fluid : scene.fluids) {
    fluids.names.push_back(fluid.name);
    fluids.colors.push_back(fluid.color);
  }
  return fluids;
}

}  // namespace

Result<std::unique_ptr<Exporter>> start_export(const Stage& stage, double spacing, bool waits) {
  ExportOptions options;
  options.kinds = stage.exports;
  options.rate = stage.export_rate;
  options.waits = waits;
  options.threads = waits ? stage.machine.cores : 1;
  return Exporter::create(exported_fluids(stage.scene, spacing), options, stage.folder);
}

void report_export(const Exporter* exporter, RunSummary& summary) {
  if (exporter == nullptr) return;
  const ExportReport report = exporter->report();
  summary.export_frames = report.frames;
  summary.export_left_out = report.left_out;
  summary.export_seconds = report.seconds;
  for (const std::string& file : exporter->files()) summary.files.push_back(file);
  if (const std::string problem = exporter->problem(); !problem.empty()) summary.problems.push_back(problem);
}

void ExportSource::show(const World& world, double elapsed) {
  if (!exporter_.due(elapsed)) return;
  world.fill(now_);
  world.fill_velocities(velocities_);
  world.fill_pressures(pressures_);
  ParticleFrame frame;
  frame.time = elapsed;
  const std::size_t count = now_.positions.size();
  frame.positions.reserve(count);
  frame.velocities.reserve(count);
  frame.pressures.reserve(count);
  frame.ids.reserve(count);
  frame.fluids.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (now_.fluid_index[i] == kRetired) continue;
    frame.positions.push_back(now_.positions[i]);
    frame.velocities.push_back(velocities_[i]);
    frame.pressures.push_back(pressures_[i]);
    frame.ids.push_back(static_cast<std::uint32_t>(i));
    frame.fluids.push_back(now_.fluid_index[i]);
  }
  exporter_.add(std::move(frame));
}

}  // namespace slosh
