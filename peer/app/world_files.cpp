#include "peer/app/world_files.h"

namespace slosh {
namespace {

constexpr std::uint8_t kRetired = 255;  // Snapshot::fluid_index

Result<std::unique_ptr<Exporter>> start_export(const Stage& stage, double spacing, bool waits) {
  ExportedFluids fluids;
  fluids.spacing = spacing;
  for (const Fluid& fluid : stage.scene.fluids) {
    fluids.names.push_back(fluid.name);
    fluids.colors.push_back(fluid.color);
  }
  ExportOptions options;
  options.kinds = stage.exports;
  options.rate = stage.export_rate;
  options.waits = waits;
  options.threads = waits ? stage.machine.cores : 1;
  return Exporter::create(fluids, options, stage.folder);
}

}  // namespace

Result<std::unique_ptr<WorldFiles>> WorldFiles::create(const Stage& stage, const SampledScene& sampled,
                                                       bool waits) {
  std::unique_ptr<WorldFiles> files(new WorldFiles(stage, sampled));
  if (stage.measure > 0.0) {
    Result<std::unique_ptr<Measurer>> measurer =
        Measurer::create(stage.scene, sampled, stage.folder, stage.measure);
    if (!measurer) return measurer.error();
    files->measurer_ = std::move(measurer.value());
  }
  if (!stage.exports.empty()) {
    Result<std::unique_ptr<Exporter>> exporter = start_export(stage, sampled.spacing, waits);
    if (!exporter) return exporter.error();
    files->exporter_ = std::move(exporter.value());
  }
  return files;
}

Result<bool> WorldFiles::follow(Host& host, const std::filesystem::path& file, Backend backend) {
  if (!file.empty()) {
    keep::RecordingOptions options;
    options.file = file_ = file;
    options.version = SLOSH_VERSION;
    options.backend = backend_name(backend);
    Result<std::unique_ptr<keep::RecordingWriter>> writer = keep::RecordingWriter::start(
        stage_.scene, sampled_.spacing, host.start_state(), host.world(), host.state(), options);
    if (!writer) return writer.error();
    recording_ = std::move(writer.value());
    host.add_tap(*recording_);
  }
  if (measurer_ || exporter_) host.add_tap(*this);
  return true;
}

void WorldFiles::begin(const World& world, double elapsed) {
  if (measurer_) measurer_->begin(world, elapsed);
  if (exporter_) show_frame(world, elapsed);
}

void WorldFiles::step(const World& world, double elapsed) {
  if (measurer_) measurer_->step(world, elapsed);
  if (exporter_) show_frame(world, elapsed);
}

void WorldFiles::show_frame(const World& world, double elapsed) {
  if (!exporter_->due(elapsed)) return;
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
  exporter_->add(std::move(frame));
}

void WorldFiles::stop() {
  if (measurer_) measurer_->stop();
  if (exporter_) exporter_->stop();
}

std::string WorldFiles::problem() const {
  const std::string problem = measurer_ ? measurer_->problem() : std::string();
  return problem.empty() && exporter_ ? exporter_->problem() : problem;
}

void WorldFiles::report(const World& world, RunSummary& s) const {
  if (recording_) {
    s.recording = file_.string();
    s.recording_problem = !recorded_.problem.empty() ? recorded_.problem : recorded_.totals.ended_early;
  }
  const auto tell = [&s](const std::string& problem) {
    if (!problem.empty()) s.problems.push_back(problem);
  };
  if (measurer_) {
    s.particles_in_solids = measurer_->in_solids();
    s.measured = measurer_->report();
    s.files.emplace_back("probes.csv");
    if (!s.measured.bodies.empty()) s.files.emplace_back("bodies.csv");
    tell(measurer_->problem());
  } else {
    // One look at the end, of a run that asked for nothing.
    s.particles_in_solids = Instruments(stage_.scene, sampled_).measure(world).in_solids;
  }
  if (!exporter_) return;
  const ExportReport exported = exporter_->report();
  s.export_frames = exported.frames;
  s.export_left_out = exported.left_out;
  s.export_seconds = exported.seconds;
  for (const std::string& file : exporter_->files()) s.files.push_back(file);
  tell(exporter_->problem());
}

}  // namespace slosh
