// What is written of a world while it runs: its recording, its instruments, frames for other programs.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "host/host.h"
#include "host/keep/recording.h"
#include "peer/app/measurer.h"
#include "peer/app/prepare.h"
#include "peer/output/export/exporter.h"
#include "peer/output/summary.h"

namespace slosh {

/// Each only where it was asked for. A host tells it of its world (follow), or whoever steps one does (begin
/// and step).
class WorldFiles final : public HostTap {
 public:
  /// The instruments and frames of `stage`, which must outlive this, as `sampled` must. `waits` as in
  /// ExportOptions; who waits leaves all cores to it. Errors: a file cannot be written.
  static Result<std::unique_ptr<WorldFiles>> create(const Stage& stage, const SampledScene& sampled,
                                                    bool waits);

  /// Before `host` starts: listens to it, and records it in `file`; empty = nowhere. Must outlive the host.
  /// Errors: the recording cannot be begun.
  Result<bool> follow(Host& host, const std::filesystem::path& file, Backend backend);

  /// The world before the first step, and after each; `elapsed`: simulated s since the run began, over all
  /// resets. Some 0.1 µs a particle when a frame is due.
  void begin(const World& world, double elapsed);
  void step(const World& world, double elapsed);

  /// Writes what is left of instruments and frames. After the last step.
  void stop();
  /// Completes the recording. After the host's end.
  void finish_recording() {
    if (recording_) recorded_ = recording_->finish();
  }

  // Each null where it was not asked for.
  const keep::RecordingWriter* recording() const { return recording_.get(); }
  const Measurer* measurer() const { return measurer_.get(); }
  const Exporter* exporter() const { return exporter_.get(); }
  /// Where instruments and frames are written.
  const std::filesystem::path& folder() const { return stage_.folder; }
  const keep::RecordingReport& recorded() const { return recorded_; }  ///< after finish_recording()
  /// Frames that wait to be written; stop() writes them.
  std::size_t frames_waiting() const { return exporter_ ? exporter_->waiting() : 0; }
  /// Why instruments or frames end early; empty while all is well; any thread.
  std::string problem() const;
  /// What the summary says of them and, measured or not, of particles inside solids. `world` as it ended;
  /// after all was stopped.
  void report(const World& world, RunSummary& summary) const;

 private:
  WorldFiles(const Stage& stage, const SampledScene& sampled) : stage_(stage), sampled_(sampled) {}
  void on_start(const World& world, const HostState&) override { begin(world, world.time()); }
  void after_step(const World& world) override {
    time_ = world.time();
    step(world, before_ + time_);
  }
  void after_change(const World& world, const HostCommand& change, const HostState&) override {
    if (change.action != HostAction::kReset) return;
    before_ += time_ - world.time();
    time_ = world.time();
  }
  void show_frame(const World& world, double elapsed);

  const Stage& stage_;
  const SampledScene& sampled_;
  std::filesystem::path file_;  // of the recording
  std::unique_ptr<keep::RecordingWriter> recording_;
  keep::RecordingReport recorded_;
  std::unique_ptr<Measurer> measurer_;
  std::unique_ptr<Exporter> exporter_;
  double before_ = 0.0;  // s of the runs before a reset
  double time_ = 0.0;
  // Of the frame that is due, used again.
  Snapshot now_;
  std::vector<glm::vec3> velocities_;
  std::vector<float> pressures_;
};

}  // namespace slosh
