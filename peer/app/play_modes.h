// The two ways to watch a run: a film without a display, or a window.
#pragma once

#include <functional>
#include <memory>

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

/// Makes a run, also each time that the user starts again and the run cannot do that in place.
using MakeRun = std::function<Result<std::unique_ptr<LiveRun>>()>;
/// The same in a window, until it is closed or the run ends, or in a headset, beside which the window is a
/// mirror and may be missing; `headset` is null without one. Errors: no window, and what `make_run` has.
Result<bool> show_in_window(const Stage& stage, const MakeRun& make_run, const ShowOptions& options,
                            HeadsetView* headset, Progress& progress, RunSummary& summary);

/// A world in this process, as a film or in a window.
Result<bool> play_headless(const Prepared& prepared, const PlayOptions& options, Progress& progress,
                           RunSummary& summary);
Result<bool> play_in_window(const Prepared& prepared, const PlayOptions& options, HeadsetView* headset,
                            Progress& progress, RunSummary& summary);

/// What the renderer is asked for: the stage's size, the surface and the colours that were chosen. A colour
/// configuration that cannot be used is told, and the built-in transform goes on.
RenderOptions picture_options(const Stage& stage, const ShowOptions& options, Progress& progress);

/// Lines typed at a run go to it, their answers to stdout; nothing where the run hears none. Does not wait.
void hear_lines(LiveRun& run, LineInput* input, Progress& progress);

/// Tells once, when it begins and when it is over, what is wrong with the run's files or devices.
class TroubleTeller {
 public:
  void tell(const LiveRun& run, Progress& progress);

 private:
  std::string told_;
};

/// "3.20 s of 10.00 s, real time × 0.98, devices 1000 Hz".
std::string running_text(const Rates& rates, double seconds);

/// Plot and summary, from what the run left in the folder. Returns the exit code.
int finish_run(const Stage& stage, const ShowOptions& options, Progress& progress, RunSummary& summary);

}  // namespace slosh
