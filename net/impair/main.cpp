// slosh-impair: a bad network between peers and a host, from the command line.
#include <CLI/CLI.hpp>
#include <csignal>
#include <iostream>
#include <string>
#include <thread>

#include "net/impair/relay.h"

namespace {

slosh::Impairment impairment;
double delay_ms = 0.0;
double jitter_ms = 0.0;
double rate_kbit = 0.0;
double queue_kb = 256.0;
double reorder_ms = 10.0;

/// Commands on standard input while it runs; false = end.
bool obey(slosh::Relay& relay, const std::string& line) {
  if (line == "dark") {
    relay.dark(true);
  } else if (line == "light") {
    relay.dark(false);
  } else if (line == "rebind") {
    relay.rebind();
  } else if (line == "quit") {
    return false;
  } else if (line == "stats") {
    const slosh::RelayStats s = relay.stats();
    std::cout << "up " << s.passed[0] << " passed " << s.dropped[0] << " dropped, down " << s.passed[1]
              << " passed " << s.dropped[1] << " dropped" << std::endl;
    return true;
  } else {
    std::cout << "commands: dark, light, rebind, stats, quit" << std::endl;
    return true;
  }
  std::cout << "ok" << std::endl;
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "Passes UDP between peers and a slosh host, as a bad network would. Give peers this program's "
      "address in place of the host's.",
      "slosh-impair"};
  slosh::RelayOptions options;
  bool down_only = false;
  bool up_only = false;
  app.add_option("--listen", options.listen, "where peers send to, e.g. 127.0.0.1:5000")
      ->capture_default_str();
  app.add_option("--to", options.to, "the host, e.g. 127.0.0.1:4433")->required();
  app.add_option("--delay-ms", delay_ms, "one way")->check(CLI::Range(0.0, 10000.0));
  app.add_option("--jitter-ms", jitter_ms, "0 to this much more delay, in order")
      ->check(CLI::Range(0.0, 10000.0));
  app.add_option("--loss", impairment.loss, "probability from 0 to 1")->check(CLI::Range(0.0, 1.0));
  app.add_option("--burst", impairment.burst, "packets lost in a row, on average")
      ->check(CLI::Range(1.0, 1e4));
  app.add_option("--duplicate", impairment.duplicate, "probability from 0 to 1")->check(CLI::Range(0.0, 1.0));
  app.add_option("--reorder", impairment.reorder, "probability from 0 to 1")->check(CLI::Range(0.0, 1.0));
  app.add_option("--reorder-ms", reorder_ms, "how late those come")->check(CLI::Range(0.0, 10000.0));
  app.add_option("--rate-kbit", rate_kbit, "kbit/s each way; 0 = no limit")->check(CLI::Range(0.0, 1e8));
  app.add_option("--queue-kb", queue_kb, "kB that wait for the rate")->check(CLI::Range(0.0, 1e6));
  app.add_option("--seed", options.seed, "of all random numbers");
  app.add_flag("--up-only", up_only, "impair only what peers send");
  app.add_flag("--down-only", down_only, "impair only what the host sends")->excludes("--up-only");
  CLI11_PARSE(app, argc, argv);
  impairment.delay = 1e-3 * delay_ms;
  impairment.jitter = 1e-3 * jitter_ms;
  impairment.reorder_delay = 1e-3 * reorder_ms;
  impairment.rate = 125.0 * rate_kbit;
  impairment.queue = 1e3 * queue_kb;
  if (!down_only) options.up = impairment;
  if (!up_only) options.down = impairment;

  sigset_t ends;
  sigemptyset(&ends);
  sigaddset(&ends, SIGINT);
  sigaddset(&ends, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &ends, nullptr);  // the relay's thread inherits it
  auto relay = slosh::Relay::start(options);
  if (!relay) {
    std::cerr << relay.error().text() << std::endl;
    return 1;
  }
  std::cout << "listening at " << relay.value()->address() << std::endl;
  std::thread([&] {
    std::string line;
    while (std::getline(std::cin, line))
      if (!obey(*relay.value(), line)) kill(getpid(), SIGTERM);
  }).detach();
  int signal = 0;
  sigwait(&ends, &signal);
  // The reader may sit in getline and cannot be joined: leave without tearing down what it uses.
  std::cout << std::flush;
  std::_Exit(0);
}
