// What a world has for an exporter, as copies.
#pragma once

#include "host/tap.h"
#include "peer/app/prepare.h"
#include "peer/output/export/exporter.h"
#include "peer/output/summary.h"

namespace slosh {

/// Starts what `stage` exports. `waits` as in ExportOptions; who waits leaves all cores to it. Errors: its
/// files cannot be written.
Result<std::unique_ptr<Exporter>> start_export(const Stage& stage, double spacing, bool waits);

/// What the summary says of it; `exporter` may be null. After Exporter::stop().
void report_export(const Exporter* exporter, RunSummary& summary);

/// Hands an exporter the frames that are due.
class ExportSource {
 public:
  /// `exporter` must outlive it.
  explicit ExportSource(Exporter& exporter) : exporter_(exporter) {}
  /// The world at `elapsed` simulated s since the run began, over all resets. Some 0.1 µs a particle when a
  /// frame is due.
  void show(const World& world, double elapsed);

 private:
  Exporter& exporter_;
  Snapshot now_;
  std::vector<glm::vec3> velocities_;
  std::vector<float> pressures_;
};

/// The same told by a host.
class ExportTap final : public HostTap {
 public:
  explicit ExportTap(Exporter& exporter) : source_(exporter) {}

  void on_start(const World& world, const HostState&) override { source_.show(world, world.time()); }
  void after_step(const World& world) override {
    time_ = world.time();
    source_.show(world, before_ + time_);
  }
  void after_change(const World& world, const HostCommand& change, const HostState&) override {
    if (change.action != HostAction::kReset) return;
    before_ += time_ - world.time();
    time_ = world.time();
  }

 private:
  ExportSource source_;
  double before_ = 0.0;  // s of the runs before a reset
  double time_ = 0.0;
};

}  // namespace slosh
