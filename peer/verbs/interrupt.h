// Ctrl-C and SIGTERM end a run in order: everything is written first. A second one ends it at once.
#pragma once

namespace slosh {

/// Installs the handlers, once, before any thread starts.
void catch_interrupts();
/// The signal that asked for the end, or 0.
int interrupted_by();

}  // namespace slosh
