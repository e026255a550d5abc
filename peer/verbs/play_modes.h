// The two ways to watch a run: a film without a display, or a window.
#pragma once

#include "peer/hud/rates.h"
#include "peer/output/progress.h"
#include "peer/output/summary.h"
#include "peer/verbs/play_options.h"
#include "peer/verbs/prepare.h"

namespace slosh {

/// Each runs the world to its end and fills `summary`. Errors: no renderer, no device, no file.
Result<bool> play_headless(const Prepared& prepared, const PlayOptions& options, Progress& progress,
                           RunSummary& summary);
Result<bool> play_in_window(const Prepared& prepared, const PlayOptions& options, Progress& progress,
                            RunSummary& summary);

/// "3.20 s of 10.00 s, real time × 0.98, devices 1000 Hz".
std::string running_text(const Rates& rates, double seconds);

/// Plot and summary, from what the run left in the folder. Returns the exit code.
int finish_run(const Prepared& prepared, Progress& progress, RunSummary& summary);

}  // namespace slosh
