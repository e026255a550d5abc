// What the reports share: where they write, and what they run on.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "peer/output/progress.h"
#include "peer/output/run_folder.h"
#include "tests/lab/report/sweep.h"

namespace slosh {

struct ReportOptions {
  bool quick = false;
  std::string out;  ///< empty: slosh-report-KIND
  bool overwrite = false;
  bool resume = false;  ///< keep what the folder has, measure the rest
  std::vector<std::string> cases, models;
  std::vector<double> spacings;  ///< m, of report error; empty: each case's own
  int close = 1;                 ///< of report error: runs at each spacing, close by
  std::string backend = "cpu";
  int threads = 0;
  std::vector<std::string> from;  ///< CSVs of earlier reports, drawn instead of running anything
};

int report_error(const ReportOptions& options);
int report_stability(const ReportOptions& options);
int report_coupling(const ReportOptions& options);
/// `spacing` m; 0: the scene's own, else its coarsest.
int report_passes(const ReportOptions& options, const std::string& scene_name, double spacing);

struct SpeedOptions {
  std::vector<std::size_t> particles;  ///< of Figure 6a's pools; empty: the report's own
  std::size_t total = 0;               ///< particles of Figures 6b and 6c; 0: the paper's
};
int report_speed(const ReportOptions& options, const SpeedOptions& speed);

/// Threads are the renderer's where a CPU draws.
int report_picture(const ReportOptions& options);

struct FigureOptions {
  int number = 8;            ///< of the paper, 8–13
  double spacing = 0.0;      ///< m; 0: the scene's coarsest
  bool tare = false;         ///< Figure 8 less what the hand carries at rest
  std::string plot = "png";  ///< of plot_formats()
};
int report_figure(const ReportOptions& options, const FigureOptions& figure);

/// Draws what scores (peer/output/score.h) came to, run after run. `wanted`: the scene, empty = the last
/// run's; `out`: the picture, empty = beside the table.
int report_task(const std::string& table, const std::string& wanted, const std::string& out);

/// Whether a report has plots, which gnuplot draws, or only tables and pictures of the renderer's.
enum class Draws : std::uint8_t { kPlots, kNoPlots };

/// The folder that a report writes to. Errors: another report is there; there are plots and no gnuplot.
Result<std::filesystem::path> report_folder(const ReportOptions& options, const std::string& kind,
                                            const char* main_file, Draws draws = Draws::kPlots);

/// One run of a report.
struct ReportJob {
  std::string name;           ///< for the bar
  double weight = 1.0;        ///< of all the work, for the bar alone
  std::function<void()> run;  ///< writes its rows; throws report::Stopped
};

/// Runs them in turn, each's rows in `file` before the next begins; an interrupt ends them early and keeps
/// what there is. Errors: `out` cannot be written.
Result<bool> run_jobs(const std::vector<ReportJob>& jobs, std::ofstream& out,
                      const std::filesystem::path& file, Progress& progress);

/// The settings' part of a report that the options choose.
report::SweepOptions sweep_of(const ReportOptions& options);

/// What the pictures say of where the numbers are from: the machine, or the tables that were given.
std::string origin_line(const ReportOptions& options);

/// "Intel Xeon, 2 of 2 cores, Debian GNU/Linux 12 (bookworm), 2026-11-21"
std::string machine_line(const ReportOptions& options);

/// Why --backend cannot be had, where it cannot.
std::optional<Error> no_backend(const ReportOptions& options);

/// The backends that --backend names.
std::vector<Backend> backends_of(const ReportOptions& options);

}  // namespace slosh
