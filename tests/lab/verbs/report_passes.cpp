// `slosh report passes SCENE`: what a scene's step costs, and what it would cost with what the plan left out.
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "peer/app/interrupt.h"
#include "peer/app/prepare.h"
#include "peer/app/verbs.h"
#include "peer/output/summary.h"
#include "scenes/load.h"
#include "sim/math/format.h"
#include "sim/passes/pass.h"
#include "tests/lab/report/passes.h"
#include "tests/lab/verbs/report.h"

namespace slosh {
namespace {

constexpr const char* kPassesTable = "passes.csv";
constexpr const char* kSharesTable = "shares.csv";

std::string agrees(const report::PassRow& row) {
  return row.same_bits ? "bitwise identical" : format("%.2g mm apart", 1e3 * row.off);
}

/// On a GPU its passes go on while the processor has its own, so that each have a sum of their own.
void print_shares(const report::PassTable& found, Backend backend) {
  const bool gpu = backend == Backend::kCuda;
  std::printf("\n%-32s %10s %10s   of %.4f ms, steps in a row\n", "within a step as planned", "ms", "share",
              found.alone.ms);
  const auto line = [](const char* what, double ms, double share, const char* note) {
    std::printf("%-32s %10.4f %9.1f%%%s\n", what, ms, 100.0 * share, note);
  };
  const auto list = [&](const char* all, auto&& belongs) {
    double ms = 0.0, share = 0.0;
    for (const report::PassShare& each : found.alone.shares) {
      if (!belongs(each.pass)) continue;
      line(name(each.pass), each.ms, each.share,
           gpu && each.pass == PassId::kReadWrenches ? "   waits for the GPU" : "");
      ms += each.ms;
      share += each.share;
    }
    line(all, ms, share, "");
  };
  if (gpu) {
    list("all on the GPU", [](PassId id) { return on_engine(id); });
    list("all on the processor", [](PassId id) { return !on_engine(id); });
  } else {
    list("all passes", [](PassId) { return true; });
  }
  std::printf("\n");
}

}  // namespace

int report_passes(const ReportOptions& options, const std::string& scene_name, double spacing) {
  if (const std::optional<Error> missing = no_backend(options)) return fail(*missing);
  Result<Scene> loaded = load_named_scene(scene_name);
  if (!loaded) return fail(loaded.error());
  const Scene& scene = loaded.value();
  if (spacing <= 0.0) spacing = scene.spacing > 0.0 ? scene.spacing : scene.spacing_max;
  const Result<SampledScene> sampled = sample_scene(scene, spacing);
  if (!sampled) return fail(sampled.error());
  // Before anything is measured: what cannot be written in the end would have been measured for nothing.
  std::error_code code;
  const bool was_there = std::filesystem::exists(options.out, code);
  if (!options.out.empty()) {
    const Result<std::filesystem::path> folder =
        report_folder(options, "passes", kPassesTable, Draws::kNoPlots);
    if (!folder) return fail(folder.error());
  }
  const auto end_without = [&](int with) {
    if (!was_there) std::filesystem::remove(options.out, code);  // it is empty
    return with;
  };
  std::printf("%s at %.3g mm, %s fluid particles; %s\n\n", scene.name.c_str(), 1e3 * spacing,
              grouped(sampled.value().fluid_positions.size()).c_str(), machine_line(options).c_str());
  std::string shares = "backend,pass,ms,share\n";
  std::string csv = "backend,what,step_ms,slower,bytes_a_particle,same_bits,off_m\n";
  for (const Backend backend : backends_of(options)) {
    report::PassOptions how;
    how.steps = options.quick ? 20 : 200;
    how.backend = backend;
    how.threads = options.threads;
    how.stopped = [] { return interrupted_by() != 0; };
    report::PassTable found;
    try {
      found = report::measure_passes(scene, sampled.value(), how);
    } catch (const report::Refused& refused) {
      return end_without(fail(refused.error));
    } catch (const report::Stopped&) {
      return end_without(kExitFailed);
    }
    std::printf("%-32s %10s %10s %16s   after %d steps\n", backend_name(backend), "step, ms", "slower",
                "bytes a particle", report::kComparedSteps);
    for (const report::PassRow& row : found.rows) {
      std::printf("%-32s %10.3f %10.3f %16.0f   %s\n", row.what.c_str(), row.step_ms, row.slower,
                  row.bytes_a_particle, agrees(row).c_str());
      csv += format("%s,%s,%.5g,%.4f,%.0f,%d,%.4g\n", backend_name(backend), row.what.c_str(), row.step_ms,
                    row.slower, row.bytes_a_particle, row.same_bits ? 1 : 0, row.off);
    }
    print_shares(found, backend);
    for (const report::PassShare& each : found.alone.shares)
      shares += format("%s,%s,%.5g,%.4f\n", backend_name(backend), name(each.pass), each.ms, each.share);
  }
  if (options.out.empty()) return kExitOk;
  for (const auto& [file, text] : {std::pair{kPassesTable, csv}, std::pair{kSharesTable, shares}}) {
    const std::filesystem::path table = std::filesystem::path(options.out) / file;
    std::ofstream out(table);
    out << text;
    if (!out.flush()) return fail({table.string(), "cannot be written", "Is the disk full?"});
  }
  return kExitOk;
}

}  // namespace slosh
