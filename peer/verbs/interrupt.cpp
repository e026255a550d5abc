#include "peer/verbs/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <initializer_list>

namespace slosh {
namespace {

volatile sig_atomic_t caught = 0;

extern "C" void note_signal(int signal_number) {
  caught = signal_number;
}

extern "C" void end_now(int signal_number) {
  constexpr char kWords[] = "\nslosh: interrupted before the run began: nothing was written.\n";
  const ssize_t written = write(STDERR_FILENO, kWords, sizeof kWords - 1);
  (void)written;
  raise(signal_number);  // the default is back: it ends the program as the signal does
}

void handle_by(void (*handler)(int), int flags) {
  struct sigaction action = {};
  action.sa_handler = handler;
  // The default comes back after the first, so that a second one is obeyed even if writing hangs.
  action.sa_flags = flags | SA_RESETHAND;
  sigemptyset(&action.sa_mask);
  for (const int signal_number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    // Under nohup a run outlives its terminal.
    if (signal_number == SIGHUP && sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler == SIG_IGN)
      continue;
    sigaction(signal_number, &action, nullptr);
  }
}

}  // namespace

void end_at_interrupts() {
  handle_by(end_now, SA_NODEFER);
}

void catch_interrupts() {
  handle_by(note_signal, SA_RESTART);
}

int interrupted_by() {
  return caught;
}

}  // namespace slosh
