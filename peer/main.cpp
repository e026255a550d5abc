// The program `slosh`.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

#include "peer/app/program.h"

namespace slosh {
namespace {

constexpr std::array<std::string_view, 2> kLabVerbs{"report", "sweep"};

/// The laboratory's verbs are slosh-lab's, which lies beside this program. Returns only where it does not.
int run_lab(char** argv) {
  std::error_code code;
  const auto lab = std::filesystem::read_symlink("/proc/self/exe", code).parent_path() / "slosh-lab";
  execv(lab.c_str(), argv);
  return fail({argv[1], "is done by the program slosh-lab, which is not at " + lab.string(),
               "In the sources: ./slosh " + std::string(argv[1]) + " builds it"});
}

/// So that --help lists them.
void add_lab(CLI::App& app, VerbRun&) {
  app.add_subcommand("sweep", kSweepAbout);
  app.add_subcommand("report", kReportAbout);
}

}  // namespace
}  // namespace slosh

int main(int argc, char** argv) {
  using namespace slosh;
  if (argc > 1 && std::ranges::find(kLabVerbs, argv[1]) != kLabVerbs.end()) return run_lab(argv);
  constexpr AddVerb kVerbs[] = {add_play,    add_host,   add_join,  add_watch, add_replay, add_links,
                                add_devices, add_scenes, add_check, add_plan,  add_lab};
  return run_program(kVerbs, argc, argv);
}
