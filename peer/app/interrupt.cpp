#include "peer/app/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <initializer_list>

#include "peer/haptics/let_go.h"

namespace slosh {
namespace {

volatile sig_atomic_t caught = 0;

extern "C" void note_signal(int signal_number) {
  if (caught == 0) {
    caught = signal_number;
    return;
  }
  // The second ends the program even if writing hangs, but no hand is left with a force. All that is called
  // here may be called in a handler; what was raised comes with the return.
  let_go_of_all_hands(kLetGoWithin);
  signal(signal_number, SIG_DFL);
  raise(signal_number);
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
  action.sa_flags = flags;
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
  handle_by(end_now, SA_NODEFER | SA_RESETHAND);
}

void catch_interrupts() {
  handle_by(note_signal, SA_RESTART);
}

int interrupted_by() {
  return caught;
}

}  // namespace slosh
