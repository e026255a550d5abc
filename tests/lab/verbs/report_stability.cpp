// `slosh report stability`: every stress case, as rows and a map.
#include <algorithm>
#include <cstdio>
#include <fstream>

#include "net/text/clean.h"
#include "peer/output/chart.h"
#include "peer/output/gnuplot.h"
#include "peer/output/progress.h"
#include "peer/app/interrupt.h"
#include "peer/app/verbs.h"
#include "sim/math/format.h"
#include "tests/lab/report/stress_case.h"
#include "tests/lab/verbs/report.h"

namespace slosh {
namespace {

using report::Setting;
using report::StressCase;
using report::StressRow;

constexpr const char* kStabilityTable = "stability.csv";

std::string column_of(const StressRow& row) {
  return row.backend == "cuda" ? row.model + ", CUDA" : row.model;
}

TileMap map_of(const std::vector<StressRow>& rows, const std::string& machine) {
  TileMap map;
  map.title = "Stiff and extreme cases";
  map.subtitle = machine;
  for (std::size_t i = 0; i < report::kVerdictNames.size(); ++i) {
    constexpr const char* kColors[] = {"#3a9d5d", "#e0b93c", "#7a8fa8", "#c8322b"};
    map.kinds.push_back({report::kVerdictNames[i], kColors[i]});
  }
  const auto index = [](std::vector<std::string>& names, const std::string& name) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) names.push_back(name);
    return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  const auto title = [](const StressRow& row) {
    for (const StressCase& each : report::stress_cases()) {
      if (row.case_id == each.id) return std::string(each.title);
    }
    return row.case_id;
  };
  for (const StressRow& row : rows) {
    index(map.rows, title(row));
    index(map.columns, column_of(row));
  }
  map.kind.assign(map.rows.size(), std::vector<int>(map.columns.size(), -1));
  map.text.assign(map.rows.size(), std::vector<std::string>(map.columns.size()));
  for (const StressRow& row : rows) {
    const std::size_t r = index(map.rows, title(row)), c = index(map.columns, column_of(row));
    map.kind[r][c] = static_cast<int>(row.verdict);
    const double lost = 100.0 * row.found.lost_share;
    if (lost > 0.0) map.text[r][c] = format(lost < 10.0 ? "%.2g %% lost" : "%.0f %% lost", lost);
  }
  return map;
}

void print_summary(const std::vector<StressRow>& rows) {
  std::vector<std::string> columns;
  for (const StressRow& row : rows) {
    if (std::find(columns.begin(), columns.end(), column_of(row)) == columns.end())
      columns.push_back(column_of(row));
  }
  for (const std::string& column : columns) {
    std::string line = format("%-18s", column.c_str());
    for (std::size_t v = 0; v < report::kVerdictNames.size(); ++v) {
      const auto count = std::count_if(rows.begin(), rows.end(), [&](const StressRow& row) {
        return column_of(row) == column && row.verdict == static_cast<report::Verdict>(v);
      });
      line += format("  %s %ld", report::kVerdictNames[v], static_cast<long>(count));
    }
    std::printf("%s\n", line.c_str());
  }
}

}  // namespace

int report_stability(const ReportOptions& options) {
  const Result<std::vector<const StressCase*>> cases = report::chosen(report::stress_cases(), options.cases);
  if (!cases) return fail(cases.error());
  if (options.from.empty()) {
    if (const std::optional<Error> missing = no_backend(options)) return fail(*missing);
  }
  std::vector<StressRow> rows;
  for (const std::string& file : options.from) {
    const Result<std::vector<StressRow>> read = report::read_stresses(file);
    if (!read) return fail(read.error());
    rows.insert(rows.end(), read.value().begin(), read.value().end());
  }
  const Result<std::filesystem::path> folder = report_folder(options, "stability", kStabilityTable);
  if (!folder) return fail(folder.error());
  catch_interrupts();
  const std::filesystem::path table = folder.value() / kStabilityTable;
  std::ofstream out(table);
  out << report::kStressHeader << '\n';
  for (const StressRow& row : rows) out << report::csv_line(row) << '\n';
  Progress progress;
  std::vector<ReportJob> jobs;
  for (const StressCase* which : options.from.empty() ? cases.value() : std::vector<const StressCase*>()) {
    // A case that is asked for by name is run, quick or not.
    if (options.cases.empty() && options.quick && !which->quick) continue;
    for (const Setting& setting : report::settings_of(*which, sweep_of(options))) {
      jobs.push_back({std::string(which->title) + ", " + name(setting.model), 1.0, [&, which, setting] {
                        rows.push_back(report::run_stress(*which, setting));
                        out << report::csv_line(rows.back()) << '\n';
                        if (rows.back().verdict == report::Verdict::kFailed)
                          progress.note(
                              format("failed: %s, %s: ", which->id, column_of(rows.back()).c_str()) +
                              rows.back().why);
                      }});
    }
  }
  if (const Result<bool> ran = run_jobs(jobs, out, table, progress); !ran) return fail(ran.error());
  print_summary(rows);
  if (rows.empty()) return kExitOk;
  const Result<bool> drawn =
      draw(tile_script(map_of(rows, origin_line(options))), folder.value() / "stability.png");
  if (!drawn) return fail(drawn.error());
  std::printf("Written: %s/stability.csv and stability.png\n",
              clean_text(folder.value().string(), kMaxTextBytes).c_str());
  return kExitOk;
}

}  // namespace slosh
