// Ctrl-C, SIGTERM and a terminal that closes (SIGHUP) end a run in order: everything is written first. A
// second one ends it at once, when every device has been sent a wrench of zero. Before there is anything to
// write, the first one does.
#pragma once

namespace slosh {

/// While a run is prepared (loading, measuring, sampling and settling may take minutes): a signal says that
/// nothing was written and ends the program at once.
void end_at_interrupts();
/// From when there is something to save: a signal asks for the end, interrupted_by() tells. Call it before
/// the run's threads start.
void catch_interrupts();
/// The signal that asked for the end, or 0.
int interrupted_by();

}  // namespace slosh
