// `slosh report speed`: the paper's Figure 6 and Table 1, shares of passes and a roofline.
#include <algorithm>
#include <cstdio>
#include <fstream>

#include "net/text/clean.h"
#include "peer/app/interrupt.h"
#include "peer/app/verbs.h"
#include "peer/output/child_process.h"
#include "peer/output/gnuplot.h"
#include "peer/output/machine.h"
#include "peer/output/whole_file.h"
#include "sim/math/format.h"
#include "sim/stopwatch.h"
#include "tests/lab/verbs/report.h"
#include "tests/lab/verbs/report_picture_stand.h"
#include "tests/lab/verbs/report_speed_charts.h"

namespace slosh {
namespace {

using report::SpeedPool;
using report::SpeedRow;
using report::SpeedRows;

constexpr const char* kSpeedTable = "speed.csv";
/// Of a picture, pixels: the paper's Figure 7.
constexpr glm::ivec2 kSpeedPicture{1024, 768};
/// Spheres of fewer particles are smaller than what they are made of.
constexpr double kMinOnSphere = 50.0;
constexpr int kFirstPictures = 2;    ///< not counted: shaders are compiled at their first use
constexpr double kSplitShare = 0.2;  ///< of Figure 6c's particles that are on spheres

struct PoolJob {
  const char* figure;
  std::size_t particles = 0;
  std::size_t on_spheres = 0;
  int spheres = 0;
};

std::vector<PoolJob> pool_jobs(const ReportOptions& options, const SpeedOptions& speed, Backend backend) {
  const bool gpu = backend == Backend::kCuda;
  std::vector<std::size_t> sizes = speed.particles;
  if (sizes.empty()) {
    sizes = options.quick
                ? std::vector<std::size_t>{2300, 9200, 32000, 100000}
                : std::vector<std::size_t>{2300, 4600, 9200, 18400, 32000, 64000, 100000, 200000, 400000};
    if (gpu && options.quick) sizes.push_back(400000);
    if (gpu && !options.quick) sizes.insert(sizes.end(), {1000000, 2000000});
  }
  std::vector<PoolJob> jobs;
  for (const std::size_t size : sizes) jobs.push_back({"6a", size});
  const std::size_t total = speed.total > 0 ? speed.total : report::kPaperTotal;
  const auto all = static_cast<double>(total);
  for (const double share :
       options.quick ? std::vector{0.0, 0.05, 0.2, 0.4} : std::vector{0.0, 0.02, 0.05, 0.1, 0.2, 0.3, 0.4}) {
    if (share == 0.0 || share * all >= kMinOnSphere)
      jobs.push_back({"6b", total, static_cast<std::size_t>(share * all), share > 0.0 ? 1 : 0});
  }
  for (const int spheres : options.quick ? std::vector{1, 4, 16} : std::vector{1, 4, 9, 16, 36, 64}) {
    if (kSplitShare * all >= kMinOnSphere * spheres)
      jobs.push_back({"6c", total, static_cast<std::size_t>(kSplitShare * all), spheres});
  }
  return jobs;
}

std::string pool_name(const PoolJob& job, Backend backend) {
  std::string text = format("%s, %zu particles", job.figure, job.particles);
  if (job.spheres > 0)
    text += format(", %zu of them on %d sphere%s", job.on_spheres, job.spheres, job.spheres == 1 ? "" : "s");
  return text + (backend == Backend::kCuda ? ", CUDA" : "");
}

/// ms, the median over `pictures` of them, a step between each and the next.
double time_pictures(Context& context, const SpeedPool& pool, World& world, int pictures) {
  auto stand = Stand::create(context, Surface::kOurs, pool.scene, pool.sampled.spacing, true, kSpeedPicture);
  if (!stand) throw report::Refused(stand.error());
  if (!context.is_software()) (void)world.share_particles();  // where it cannot, main memory is read
  Snapshot snapshot;
  std::vector<double> times;
  for (int i = 0; i < pictures + kFirstPictures; ++i) {
    if (interrupted_by() != 0) throw report::Stopped();
    world.step({});
    world.fill(snapshot);  // waits for the step
    Stopwatch watch;
    world.fill(snapshot);
    stand.value()->draw(snapshot);
    if (i >= kFirstPictures) times.push_back(1e3 * watch.lap());
  }
  return report::percentile(times, 0.5);
}

std::string device_of(const ReportOptions& options, Backend backend) {
  if (backend == Backend::kCuda) return find_cuda_device().name;
  const Machine machine = this_machine();
  const int threads = options.threads > 0 ? options.threads : machine.cores;
  return machine.cpu + format(" (%d thread%s)", threads, threads == 1 ? "" : "s");
}

Result<bool> write_parts(const SpeedRows& rows, const std::filesystem::path& folder) {
  std::string shares = std::string(report::kShareHeader) + '\n';
  for (const report::ShareRow& row : rows.shares) shares += report::csv_line(row) + '\n';
  std::string roofs = std::string(report::kRoofHeader) + '\n';
  for (const report::RoofRow& row : rows.roofs) roofs += report::csv_line(row) + '\n';
  const Result<bool> written = write_whole(folder / "shares.csv", shares);
  return written ? write_whole(folder / "roofline.csv", roofs) : written;
}

void print_speeds(const SpeedRows& rows) {
  std::printf("%-6s %-5s %9s %7s %7s %10s %8s %12s %10s\n", "figure", "on", "fluid", "bodies", "of them",
              "step, ms", "Hz", "picture, ms", "real time");
  for (const SpeedRow& row : rows.speeds) {
    std::printf("%-6s %-5s %9zu %7zu %7d %10.3f %8.1f %12s %9.2fx\n", row.figure.c_str(), row.backend.c_str(),
                row.fluid_particles, row.body_particles, row.bodies, row.step_ms, 1e3 / row.step_ms,
                row.picture_ms > 0.0 ? format("%.2f", row.picture_ms).c_str() : "-", row.real_time_factor());
  }
  std::printf("\n%-16s %9s %10s %9s %9s %12s   least traffic, each column once\n", "pass", "fluid", "ms",
              "GB/s", "GFLOP/s", "of its roof");
  for (const report::RoofRow& row : rows.roofs) {
    std::printf("%-16s %9zu %10.4f %9.3g %9.4g %10.0f %%\n", row.pass.c_str(), row.fluid_particles, row.ms,
                1e-9 * row.bytes_per_s(), 1e-9 * row.flops_per_s(), 100.0 * row.share_of_roof());
  }
  std::printf("\n");
}

int write_speeds(const SpeedRows& rows, const std::filesystem::path& folder, const std::string& origin) {
  print_speeds(rows);
  const std::string table = table_one(rows);
  std::printf("%s\n", table.c_str());
  Result<bool> written = write_parts(rows, folder);
  if (written) written = write_whole(folder / "table-1.md", table);
  std::string files = "speed.csv, shares.csv, roofline.csv, table-1.md";
  if (program_there("gnuplot")) {
    const auto picture = [&](const std::vector<ChartPanel>& panels, int columns, const char* title,
                             const char* file) {
      if (!written || panels.empty()) return;
      written = draw(chart_script(panels, columns, title + origin), folder / file);
      files += std::string(", ") + file;
    };
    picture(figure_six(rows), 3, "Computation time of a step, the paper's Figure 6", "figure-6.png");
    picture(pass_panels(rows), 3, "Passes of a step", "passes.png");
  }
  if (!written) return fail(written.error());
  std::printf("Written: %s/%s\n", clean_text(folder.string(), kMaxTextBytes).c_str(), files.c_str());
  return kExitOk;
}

}  // namespace

int report_speed(const ReportOptions& options, const SpeedOptions& speed) {
  if (options.from.empty()) {
    if (const std::optional<Error> missing = no_backend(options)) return fail(*missing);
  }
  SpeedRows rows;
  for (const std::string& file : options.from) {
    const Result<bool> read = report::read_speeds(file, rows);
    if (!read) return fail(read.error());
  }
  // The tables are worth having by themselves, and a machine with a GPU may have no gnuplot.
  const bool draws = program_there("gnuplot");
  const Result<std::filesystem::path> folder = report_folder(options, "speed", kSpeedTable, Draws::kNoPlots);
  if (!folder) return fail(folder.error());
  const std::filesystem::path file = folder.value() / kSpeedTable;
  std::ofstream out(file);
  out << report::kSpeedHeader << '\n';
  for (const SpeedRow& row : rows.speeds) out << report::csv_line(row) << '\n';
  if (!out.flush()) return fail({file.string(), "cannot be written", "Choose another folder with --out"});
  Progress progress;
  if (!draws)
    progress.note("slosh: gnuplot is not installed, so there are tables alone; --from draws them elsewhere");
  std::unique_ptr<Context> context;
  const int cores = std::min(64, options.threads > 0 ? options.threads : this_machine().cores);
  if (options.from.empty()) {
    Result<std::unique_ptr<Context>> made = make_headless_context({.software_threads = cores});
    if (made) {
      context = std::move(made.value());
    } else {
      progress.note("slosh: no picture can be drawn here, so the curve with one is left out: " +
                    made.error().text());
    }
  }
  catch_interrupts();
  const int pictures = options.quick ? 3 : 20;
  const report::PictureTimer picture = [&](const SpeedPool& pool, World& world) {
    return time_pictures(*context, pool, world, pictures);
  };
  std::vector<ReportJob> jobs;
  std::optional<report::Ceilings> ceilings;  // of the backend that is being measured
  for (const Backend backend : options.from.empty() ? backends_of(options) : std::vector<Backend>()) {
    report::PassOptions how;
    how.steps = options.quick ? 20 : 200;
    how.backend = backend;
    how.threads = options.threads;
    how.stopped = [] { return interrupted_by() != 0; };
    jobs.push_back({"the machine's ceilings", 2e6, [&, backend] {
                      const Result<report::Ceilings> found =
                          backend == Backend::kCuda
                              ? report::cuda_ceilings()
                              : Result<report::Ceilings>(report::cpu_ceilings(options.threads));
                      ceilings.reset();
                      if (found) ceilings = found.value();
                      if (!found) progress.note("slosh: no roofline: " + found.error().text());
                    }});
    for (const PoolJob& job : pool_jobs(options, speed, backend)) {
      // A GPU is quicker while the fluid still lies in rows
      // (tests/notebook/2026-11-29-bytes-for-candidates.md). Spheres would have drifted into each other by
      // then.
      const bool settles = backend == Backend::kCuda && job.spheres == 0 && !options.quick;
      how.warm_up = settles ? 1000 : report::PassOptions().warm_up;
      const double weight = static_cast<double>(job.particles) * how.steps + 1e6;
      const SpeedRow begun{
          .figure = job.figure, .backend = backend_name(backend), .device = device_of(options, backend)};
      jobs.push_back(
          {pool_name(job, backend), weight, [&, job, how, begun] {
             try {
               const SpeedPool pool = report::speed_pool(job.particles, job.on_spheres, job.spheres);
               report::measure_speed(begun, pool, how, context ? picture : nullptr,
                                     ceilings ? &*ceilings : nullptr, rows);
               out << report::csv_line(rows.speeds.back()) << '\n';
               (void)write_parts(rows, folder.value());  // the last says whether it could
             } catch (const report::Refused& refused) {
               progress.note("slosh: " + pool_name(job, how.backend) + ": " + refused.error.text());
             }
           }});
    }
  }
  if (const Result<bool> ran = run_jobs(jobs, out, file, progress); !ran) return fail(ran.error());
  if (rows.speeds.empty()) return kExitFailed;
  return write_speeds(rows, folder.value(), options.from.empty() ? ": " + machine_line(options) : "");
}

}  // namespace slosh
