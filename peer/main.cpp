// The program `slosh`: reads the command line and runs one verb.
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <exception>
#include <initializer_list>

#include "net/text/clean.h"
#include "peer/install/version.h"
#include "peer/verbs/settings_in_force.h"
#include "peer/verbs/uncaught.h"
#include "peer/verbs/verbs.h"

namespace slosh {
namespace {

int run(int argc, char** argv) {
  CLI::App app("Touch simulated fluids together.", "slosh");
  app.set_version_flag("--version", version_text);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  VerbRun chosen;
  const bool names_a_verb = argc > 1 && argv[1][0] != '-';
  add_play(app, chosen);
  add_host(app, chosen);
  add_join(app, chosen);
  add_watch(app, chosen);
  add_replay(app, chosen);
  add_links(app, chosen);
  add_devices(app, chosen);
  add_scenes(app, chosen);
  add_check(app, chosen);
  add_plan(app, chosen);
  add_sweep(app, chosen);
  add_report(app, chosen);
  SettingsFile settings = read_settings(settings_path());
  add_settings(app, settings, chosen);
  put_in_force(settings, app);
  if (names_a_verb &&
      app.get_subcommands([&](const CLI::App* sub) { return sub->check_name(argv[1]); }).empty()) {
    const std::string verb = clean_text(argv[1], kMostTextBytes);
    std::fprintf(stderr, "slosh: there is no verb '%s'. See `slosh --help`.\n", verb.c_str());
    return kExitUsage;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::string verb;
    for (const CLI::App* sub : app.get_subcommands()) verb = sub->get_name() + " ";
    const std::string what = clean_lines(error.what(), kMostTextBytes);
    std::fprintf(stderr, "slosh: %s. See `slosh %s--help`.\n", what.c_str(), verb.c_str());
    return kExitUsage;
  }
  // Wrong settings are said before anything is begun, and nothing is begun with half of them.
  if (!settings.errors.empty() && !app.got_subcommand("settings")) {
    for (const Error& error : settings.errors) fail(error);
    std::fprintf(
        stderr,
        "slosh: nothing was begun. `slosh settings` shows them all; SLOSH_SETTINGS=none goes without.\n");
    return kExitUsage;
  }
  return chosen();
}

}  // namespace
}  // namespace slosh

int main(int argc, char** argv) {
  slosh::say_uncaught_cleanly();
  // A child (ffmpeg) that dies must be an error to report, not the end of this program; so must a file that
  // may grow no further (ulimit -f).
  for (const int signal_number : {SIGPIPE, SIGXFSZ}) std::signal(signal_number, SIG_IGN);
  try {
    return slosh::run(argc, argv);
  } catch (const std::exception& error) {
    return slosh::fail_uncaught(error);
  }
}
