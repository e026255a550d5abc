// The verb `report`: error against run time, stability at the extremes, hands over a delay, what leaving
// passes out saves, what a step costs by size, pictures.
#include "tests/lab/verbs/report.h"

#include <array>
#include <ctime>
#include <memory>

#include "peer/app/common_options.h"
#include "peer/app/interrupt.h"
#include "peer/app/verbs.h"
#include "peer/output/child_process.h"
#include "peer/output/machine.h"
#include "peer/output/plot.h"
#include "sim/backend.h"
#include "sim/math/format.h"
#include "tests/lab/report/speed_pool.h"
#include "tests/lab/verbs/report_coupling.h"

namespace slosh {
namespace {

void add_machine_options(CLI::App& verb, ReportOptions& options) {
  verb.add_option("--backend", options.backend, "cpu, cuda, or both")
      ->check(CLI::IsMember({"cpu", "cuda", "both"}))
      ->capture_default_str();
  verb.add_option("--threads", options.threads, "Cores for the CPU backend (all)")->check(CLI::Range(1, 256));
  verb.add_flag("--overwrite", options.overwrite, "Lose the report that is in that folder");
}

void add_case_options(CLI::App& verb, ReportOptions& options, const std::string& kind,
                      const std::string& table) {
  verb.add_flag("--quick", options.quick, "Coarse particles and short runs: minutes instead of hours");
  verb.add_option("--out", options.out, "Folder for the tables and pictures (slosh-report-" + kind + ")");
  verb.add_option("--case", options.cases, "Only this case; may be given more than once");
  verb.add_option(
          "--model", options.models,
          "Only this particle model; may be given more than once (paper: the published one but for what\n"
          "sim/pressure/README.md lists: neighbours counted, no negative pressure, body particles' volumes "
          "from areas)")
      ->check(CLI::IsMember({"paper", "corrected", "incompressible"}));
  verb.add_option(
          "--from", options.from,
          "Draw these " + table + " of earlier reports, of any machine, and run nothing; again for more")
      ->check(CLI::ExistingFile);
  add_machine_options(verb, options);
}

}  // namespace

void add_report(CLI::App& app, VerbRun& chosen) {
  CLI::App* verb = app.add_subcommand("report", kReportAbout);
  verb->require_subcommand(1);
  auto options = std::make_shared<ReportOptions>();
  CLI::App* error = verb->add_subcommand("error", "Cases with a known answer: how far off, at what cost");
  add_case_options(*error, *options, "error", "errors.csv");
  error
      ->add_option(
          "--spacing", options->spacings,
          "These spacings, metres, in place of each case's own; may be given more than once. With --quick "
          "at these\nalone, without the wider support and the shorter step")
      ->check(CLI::Range(1e-4, 1.0));
  error
      ->add_option("--close", options->close,
                   "3, 5 or 7: each spacing is read at as many, 1.4 % from one to the next, and their mean "
                   "and scatter\n"
                   "are what is drawn and told: how a vessel fits the layers of particles moves one reading "
                   "by 1 to 3 %")
      ->check(CLI::IsMember({"3", "5", "7"}))
      ->excludes(error->get_option("--from"));
  error->footer(
      "Runs every case with every particle model and spacing; a full report also with a wider support and "
      "half\n"
      "the time step. Writes errors.csv, a row as soon as it is there; a picture a case: error against wall\n"
      "seconds a simulated second, and against the spacing; errors.md, the table; with all cases scenes.png, "
      "where\n"
      "each shipped scene's cases are judged together. Spacings within 2 % of each other, by --close or in "
      "what\n"
      "--from reads, are one mean with its scatter, \"+1.1 ± 1.9 (5)\". Ctrl-C draws what there is.\n\n"
      "Examples:\n  slosh report error --quick\n  slosh report error --case sloshing --backend both\n"
      "  slosh report error --case spin_up --spacing 0.003 --quick --model corrected --backend cuda\n"
      "  slosh report error --case couette --spacing 0.006 --close 5 --quick --model corrected\n"
      "  slosh report error --from here.csv --from there.csv --out both");
  error->callback([&chosen, options] { chosen = [options] { return report_error(*options); }; });
  CLI::App* stability =
      verb->add_subcommand("stability", "Stiff and extreme cases: what holds, what is refused");
  add_case_options(*stability, *options, "stability", "stability.csv");
  stability->footer(
      "Each case ends as one of: ran true; ran limited (finite, and a status said what was limited); refused "
      "(in\n"
      "words, before it ran); failed. Writes stability.csv and stability.png, a map. A full report soaks: a "
      "million\n"
      "steps at rest, ten minutes of stirring.\n\n"
      "Examples:\n  slosh report stability --quick\n  slosh report stability --case jerk --model corrected\n"
      "  slosh report stability --from here.csv --from there.csv --out both");
  stability->callback([&chosen, options] { chosen = [options] { return report_stability(*options); }; });
  CLI::App* picture = verb->add_subcommand(
      "picture", "Ways to make a surface of particles: how wrong, how restless, how long");
  picture->add_flag("--quick", options->quick, "Coarser particles and smaller pools: two minutes");
  picture->add_option("--out", options->out, "Folder for the table and pictures (slosh-report-picture)");
  picture->add_option("--threads", options->threads, "Cores for a renderer without a GPU (1)")
      ->check(CLI::Range(1, 256));
  picture->add_flag("--overwrite", options->overwrite, "Lose the report that is in that folder");
  picture->footer(
      "Draws an analytic pool, water at rest and a broken dam with the paper's section 5, with curvature "
      "flow and\n"
      "as play does. Then as play does what is outside of a vessel: a stream, a sheet, a string of batter, a "
      "puddle,\n"
      "a film, drops, each beside the same simulated finely and seen by ray. Writes picture.md, the tables, "
      "picture.png,\n"
      "the broken dam side by side, and shapes.png.\n\n"
      "Examples:\n  slosh report picture\n  slosh report picture --quick --out here");
  picture->callback([&chosen, options] { chosen = [options] { return report_picture(*options); }; });
  CLI::App* coupling = verb->add_subcommand("coupling", "Hands at several sites on one body, over a delay");
  coupling->add_flag("--quick", options->quick, "The cases that broke schemes, to 300 ms: a minute");
  coupling->add_option("--out", options->out, "Folder for the table and pictures (slosh-report-coupling)");
  coupling->add_option("--jobs", options->threads, "Runs at once (one a core)")->check(CLI::Range(1, 1024));
  CLI::Option* overwrite =
      coupling->add_flag("--overwrite", options->overwrite, "Lose the report that is in that folder");
  coupling
      ->add_flag("--resume", options->resume,
                 "Go on with the report in that folder: its rows are kept, what is missing is measured, all "
                 "is drawn")
      ->excludes(overwrite);
  auto link = std::make_shared<bool>(false);
  auto water = std::make_shared<bool>(false);
  CLI::Option* over_link = coupling->add_flag(
      "--link", *link,
      "In place of it a handful over the real link: two simulated people and the bucket over QUIC between "
      "network namespaces, 0 to 500 ms, 20 % lost; two minutes (--quick: two cases), one case after "
      "another, without --jobs and --resume. Writes coupling_link.csv and .png");
  coupling
      ->add_option(
          "--case", options->cases,
          "Of --link's cases those with this in their name, as \"replica, 500 ms\"; given again, those too, "
          "or once more; the force error needs \"replica, 0 ms\" first")
      ->needs(over_link);
  coupling
      ->add_flag(
          "--water", *water,
          "In place of it one hand on the shipped bucket's real water: how far off its force is by way of "
          "the hand and round trip, and what repeatability and the best models would leave; six minutes "
          "of a core (--quick: three ways and a person). Writes coupling_water.csv and .png")
      ->excludes(over_link);
  coupling->footer(
      "In virtual time, so that it is the same again on every machine of a kind: simulated operators hold a "
      "body of "
      "2.5 kg,\n"
      "six axes, over every round trip, jitter, loss, number of hands, stiffness, grip and packet rate; by "
      "the "
      "host's force\n"
      "(the published scheme), a spring at the peer, and the replica that peers use. Writes coupling.csv, a "
      "row as soon as\n"
      "it is there; a map a scheme of what is stable, with the energy generated; force_error.png, with "
      "theory's "
      "bounds;\n"
      "transparency.csv and .png: the impedance that a hand is rendered, 0.1 to 30 Hz, and what it should "
      "be;\n"
      "spectrum.csv and .png: a force in syrup with and without the host's model of it, host at 60 to 1000 "
      "Hz.\n"
      "bucket.csv and .png, in a full report: the shipped bucket with its water in the hands of 2, 4 and 8 "
      "at "
      "300 ms,\n"
      "with 40 ms of jitter and 20 % lost, together and apart.\n"
      "A core does all of it in about 15 minutes, and cores share it; needs no display and no network. "
      "Ctrl-C "
      "keeps\n"
      "the table so far, and --resume goes on from there.\n\n"
      "Examples:\n  slosh report coupling --quick\n  slosh report coupling --out here\n"
      "  slosh report coupling --out here --resume\n"
      "  slosh report coupling --link --out here\n"
      "  slosh report coupling --link --case \"replica, 500 ms\"\n"
      "  slosh report coupling --water --out here");
  coupling->callback([&chosen, options, link, water] {
    chosen = [options, link, water] {
      return *link ? report_coupling_link(*options)
                   : (*water ? report_coupling_water(*options) : report_coupling(*options));
    };
  });
  CLI::App* passes = verb->add_subcommand(
      "passes", "What each pass takes of a scene's step, and what it saves by what it leaves out");
  auto scene = std::make_shared<std::string>();
  auto spacing = std::make_shared<double>(0.0);
  passes->add_option("SCENE", *scene, "A shipped scene's name, or a .gltf or .glb file")->required();
  passes->add_option("--spacing", *spacing, "Metres between particles (the scene's own, else its coarsest)")
      ->check(in_range(1e-4, 1.0));
  passes->add_flag("--quick", options->quick, "20 timed steps instead of 200");
  passes->add_option("--out", options->out, "Also write passes.csv and shares.csv into this folder");
  add_machine_options(*passes, *options);
  passes->footer(
      "Tells each pass's share of a step as planned. Then times the scene as planned, with each pass\n"
      "forced in that its plan left out, and with what only a viewer or a recording needs; step by step\n"
      "in turns, so that the ratios hold on a machine that does other things too.\n\n"
      "Examples:\n  slosh report passes bucket\n  slosh report passes pour --spacing 0.008 --backend both");
  passes->callback([&chosen, options, scene, spacing] {
    chosen = [options, scene, spacing] { return report_passes(*options, *scene, *spacing); };
  });
  CLI::App* speed =
      verb->add_subcommand("speed", "The paper's Figure 6 and Table 1: what a step costs by size");
  auto sizes = std::make_shared<SpeedOptions>();
  speed->add_flag("--quick", options->quick,
                  "Fewer and smaller pools, 20 timed steps instead of 200: a minute at most");
  speed
      ->add_option("--particles", sizes->particles,
                   "Fluid particles of a pool of Figure 6a, in place of its own; may be given more than once")
      ->check(in_range(report::kMinSpeedParticles, 10'000'000));
  speed
      ->add_option("--total", sizes->total,
                   "Particles of fluid and spheres together in Figures 6b and 6c (25000)")
      ->check(in_range(report::kMinSpeedParticles, 10'000'000));
  speed->add_option("--out", options->out, "Folder for the tables and pictures (slosh-report-speed)");
  speed
      ->add_option(
          "--from", options->from,
          "Draw these speed.csv of earlier reports, of any machine, and run nothing; again for more. "
          "Reads\nshares.csv and roofline.csv beside each")
      ->check(CLI::ExistingFile);
  add_machine_options(*speed, *options);
  speed->footer(
      "Times steps of a pool of fluid over its particles, with and without a picture of 1024 x 768; of one "
      "with a\n"
      "floating sphere that grows while the total stays; and of one whose body particles are split over "
      "more\n"
      "spheres. Body particles lie on surfaces: a sphere of as many is larger than the paper's. Writes "
      "speed.csv,\n"
      "a row as soon as it is there; shares.csv, each pass's share of a step; roofline.csv, what the heavy "
      "passes\n"
      "reach of the memory's bandwidth and of the arithmetic, which are measured in the same run (their "
      "bytes and\n"
      "FLOP are estimates, each column once); figure-6.png, passes.png and table-1.md. Without OpenGL there "
      "is no\n"
      "curve with a picture, without gnuplot there are tables alone. Four minutes on two cores. Ctrl-C draws "
      "what\n"
      "there is.\n\n"
      "Examples:\n  slosh report speed --quick\n  slosh report speed --backend both --out here\n"
      "  slosh report speed --from here/speed.csv --from there/speed.csv --out both");
  speed->callback(
      [&chosen, options, sizes] { chosen = [options, sizes] { return report_speed(*options, *sizes); }; });
  CLI::App* task = verb->add_subcommand("task", "Learning over the runs of a guided task");
  auto scores = std::make_shared<std::array<std::string, 3>>();
  task->add_option("FILE", (*scores)[0], "The table that `slosh play --score FILE` wrote")->required();
  task->add_option("--scene", (*scores)[1], "Of this scene's runs (the last run's)");
  task->add_option("--out", (*scores)[2], "The picture (FILE with .png)");
  task->footer(
      "Draws time, time of each step, what was spilled and the forces on the hands over the runs, and lists "
      "the\n"
      "last twenty.\n\n"
      "Examples:\n  slosh play crepe --score crepe.csv\n  slosh report task crepe.csv");
  task->callback([&chosen, scores] {
    chosen = [scores] { return report_task((*scores)[0], (*scores)[1], (*scores)[2]); };
  });
  CLI::App* figure =
      verb->add_subcommand("figure", "A figure of the paper again, judged against the paper's words");
  auto which = std::make_shared<FigureOptions>();
  figure
      ->add_option("N", which->number,
                   "8 spoon, 9 pouring, 10 spinning glasses, 11 bucket in two hands, 12 and 13 the crêpe: "
                   "poured, and\nstirred and topped with syrup")
      ->required()
      ->check(CLI::IsMember({"8", "9", "10", "11", "12", "13"}));
  figure->add_option("--spacing", which->spacing, "Metres between particles (the scene's coarsest)")
      ->check(in_range(1e-4, 1.0));
  figure->add_flag("--tare", which->tare, "Figure 8 without what the hand carries at rest");
  figure->add_option("--plot", which->plot, "Format of the picture: png, svg or pdf")
      ->check(CLI::IsMember(plot_formats()))
      ->capture_default_str();
  figure->add_option("--out", options->out, "Folder for picture, words and table (slosh-report-figure)");
  add_machine_options(*figure, *options);
  figure->footer(
      "Plays the shipped scene's hands, every step kept: no peak is averaged away. Figure 10 runs the "
      "paper's model\n"
      "and the default one. Writes figure-N.png (or .svg, .pdf), phases shaded and named, with this command, "
      "the\n"
      "version and the machine in its corner; figure-N.md, each\n"
      "sentence of the paper with what was measured and whether it holds; figure-N.csv, the wrenches.\n\n"
      "Examples:\n  slosh report figure 10\n  slosh report figure 8 --tare --spacing 0.008 --plot pdf --out "
      "figures");
  figure->callback(
      [&chosen, options, which] { chosen = [options, which] { return report_figure(*options, *which); }; });
}

Result<std::filesystem::path> report_folder(const ReportOptions& options, const std::string& kind,
                                            const char* main_file, Draws draws) {
  // Before anything is measured: what cannot be drawn in the end would have been measured for nothing.
  if (draws == Draws::kPlots && !program_there("gnuplot"))
    return Error{"gnuplot", "is not installed, and draws what is measured", "apt-get install gnuplot-nox"};
  const std::filesystem::path folder = options.out.empty() ? "slosh-report-" + kind : options.out;
  std::error_code code;
  // A link leads elsewhere, perhaps to what is not there yet: never written through.
  const std::filesystem::file_status there = std::filesystem::symlink_status(folder / main_file, code);
  if (options.overwrite && std::filesystem::is_symlink(there))
    std::filesystem::remove(folder / main_file, code);
  if (!options.overwrite && std::filesystem::exists(there)) {
    return Error{folder.string(), std::string("holds an earlier report's ") + main_file,
                 "Choose another folder with --out, or give --overwrite to lose that report"};
  }
  std::filesystem::create_directories(folder, code);
  if (code)
    return Error{folder.string(), "cannot be made: " + code.message(), "Choose another folder with --out"};
  return folder;
}

std::string machine_line(const ReportOptions& options) {
  const Machine machine = this_machine();
  char date[32] = "";
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  if (localtime_r(&now, &local)) std::strftime(date, sizeof date, "%Y-%m-%d", &local);
  const int threads = options.threads > 0 ? options.threads : machine.cores;
  return machine.cpu + ", " + std::to_string(threads) + " of " + std::to_string(machine.cores) + " cores, " +
         machine.system + ", slosh " SLOSH_VERSION ", " + date;
}

std::optional<Error> no_backend(const ReportOptions& options) {
  std::string reason;
  if (options.backend == "cpu" || cuda_available(&reason)) return std::nullopt;
  return Error{"--backend", reason, "Measure on the CPU: --backend cpu"};
}

std::vector<Backend> backends_of(const ReportOptions& options) {
  if (options.backend == "both") return {Backend::kCpu, Backend::kCuda};
  return {options.backend == "cuda" ? Backend::kCuda : Backend::kCpu};
}

report::SweepOptions sweep_of(const ReportOptions& options) {
  return {options.quick, options.cases,        options.models,  options.spacings,
          options.close, backends_of(options), options.threads, [] { return interrupted_by() != 0; }};
}

std::string origin_line(const ReportOptions& options) {
  std::string names;
  for (const std::string& file : options.from)
    names += (names.empty() ? "" : ", ") + std::filesystem::path(file).filename().string();
  return names.empty() ? machine_line(options) : names;
}

Result<bool> run_jobs(const std::vector<ReportJob>& jobs, std::ofstream& out,
                      const std::filesystem::path& file, Progress& progress) {
  if (!jobs.empty()) progress.phase("measuring", format("%zu runs", jobs.size()));
  double whole = 0.0, done = 0.0;
  for (const ReportJob& job : jobs) whole += job.weight;
  for (const ReportJob& job : jobs) {
    progress.update(done / whole, job.name);
    try {
      job.run();
    } catch (const report::Stopped&) {
      if (interrupted_by() != 0) progress.note("interrupted: drawing what there is");
      break;
    }
    if (!out.flush()) break;
    done += job.weight;
  }
  if (out.flush()) return true;
  return Error{file.string(), "cannot be written", "Is the disk full? Rows so far are kept"};
}

}  // namespace slosh
