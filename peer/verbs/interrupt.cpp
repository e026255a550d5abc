#include "peer/verbs/interrupt.h"

#include <signal.h>

namespace slosh {
namespace {

volatile sig_atomic_t caught = 0;

extern "C" void note_signal(int signal_number) {
  caught = signal_number;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = note_signal;
  // The default comes back after the first, so that a second one is obeyed even if writing hangs.
  action.sa_flags = SA_RESTART | SA_RESETHAND;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int interrupted_by() {
  return caught;
}

}  // namespace slosh
