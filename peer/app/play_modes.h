// The two ways to watch a run: a film without a display, or a window.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "peer/app/live_run.h"
#include "peer/app/play_options.h"
#include "peer/app/prepare.h"
#include "peer/output/line_input.h"
#include "peer/output/progress.h"
#include "render/renderer.h"

namespace slosh {

/// Snapshots a second that a window asks for, for a smooth picture.
constexpr double kWindowSnapshotRate = 60.0;

/// Starts `run`, films it to its end and fills `summary`. Errors: no renderer, no file.
Result<bool> show_headless(const Stage& stage, LiveRun& run, const ShowOptions& options, Progress& progress,
                           RunSummary& summary);

/// Makes the run that is shown. Errors: as the run's own.
using MakeRun = std::function<Result<std::unique_ptr<LiveRun>>()>;
/// The same in a window, until it is closed or the run ends, or in a headset, beside which the window is a
/// mirror and may be missing; `headset` is null without one. The run is made once there is a window. Errors:
/// no window, and what `make_run` has.
Result<bool> show_in_window(const Stage& stage, const MakeRun& make_run, const ShowOptions& options,
                            HeadsetView* headset, Progress& progress, RunSummary& summary);

/// One of the two, then the run's plot and summary (finish_run). Returns the exit code.
int show_run(const Stage& stage, const MakeRun& make_run, const ShowOptions& options, bool headless,
             HeadsetView* headset, Progress& progress);

/// What the renderer is asked for: the stage's size, the surface and the colours that were chosen. A colour
/// configuration that cannot be used is told, and the built-in transform goes on.
RenderOptions picture_options(const Stage& stage, const ShowOptions& options, Progress& progress);

/// The terminal beside a run that is shown.
class RunTerminal {
 public:
  /// All must outlive it.
  RunTerminal(const Stage& stage, LiveRun& run, Progress& progress);
  ~RunTerminal() { progress_.typed(""); }
  RunTerminal(const RunTerminal&) = delete;
  RunTerminal& operator=(const RunTerminal&) = delete;

  /// Waits for lines where the run hears any; at most so long.
  void wait(std::chrono::milliseconds patience) const;
  /// Lines that were typed go to the run, their answers to stdout. What is wrong with its files or devices is
  /// told once, when it begins and when it is over. Last, how far the run is. Returns its rates; does not
  /// wait.
  Rates turn();

 private:
  const Stage& stage_;
  LiveRun& run_;
  Progress& progress_;
  std::optional<LineInput> input_;
  std::string trouble_;  // as it was told
};

/// Plot and summary, from what the run left in the folder. Returns the exit code.
int finish_run(const Stage& stage, const ShowOptions& options, Progress& progress, RunSummary& summary);

}  // namespace slosh
