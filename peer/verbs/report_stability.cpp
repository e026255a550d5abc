// `slosh report stability`: every stress case, as rows and a map.
#include <algorithm>
#include <cstdio>
#include <fstream>

#include "host/report/stress_case.h"
#include "net/text/clean.h"
#include "peer/output/chart.h"
#include "peer/output/gnuplot.h"
#include "peer/output/progress.h"
#include "peer/verbs/interrupt.h"
#include "peer/verbs/report.h"
#include "peer/verbs/verbs.h"
#include "sim/format.h"

namespace slosh {
namespace {

using report::Setting;
using report::StressCase;
using report::StressRow;
using report::Verdict;

constexpr const char* kTable = "stability.csv";

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
    if (row.found.lost_share > 0.0) map.text[r][c] = format("%.2g %% lost", 100.0 * row.found.lost_share);
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
        return column_of(row) == column && row.verdict == static_cast<Verdict>(v);
      });
      line += format("  %s %ld", report::kVerdictNames[v], static_cast<long>(count));
    }
    std::printf("%s\n", line.c_str());
  }
}

bool wanted(const std::vector<std::string>& names, const std::string& name) {
  return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

int report_stability(const ReportOptions& options) {
  std::string known;
  for (const StressCase& each : report::stress_cases())
    known += (known.empty() ? "" : ", ") + std::string(each.id);
  for (const std::string& id : options.cases) {
    const auto& all = report::stress_cases();
    if (std::none_of(all.begin(), all.end(), [&](const StressCase& each) { return id == each.id; }))
      return fail({"--case", "there is no case '" + id + "'", "Cases: " + known});
  }
  if (const std::optional<Error> missing = no_backend(options)) return fail(*missing);
  const Result<std::filesystem::path> folder = report_folder(options, "stability", kTable);
  if (!folder) return fail(folder.error());
  catch_interrupts();
  std::ofstream out(folder.value() / kTable);
  out << report::kStressHeader << '\n';
  std::vector<StressRow> rows;
  Progress progress;
  progress.phase("measuring");
  const auto& cases = report::stress_cases();
  bool stopped = false;
  for (std::size_t i = 0; i < cases.size() && !stopped; ++i) {
    // A case that is asked for by name is run, quick or not.
    if (!wanted(options.cases, cases[i].id) || (options.cases.empty() && options.quick && !cases[i].quick))
      continue;
    for (const Backend backend : backends_of(options)) {
      for (const ParticleModel model :
           {ParticleModel::kPaper, ParticleModel::kConsistent, ParticleModel::kCorrected}) {
        if (stopped || !wanted(options.models, name(model))) continue;
        if (!cases[i].fluid && model != ParticleModel::kCorrected) continue;  // the same world for all
        progress.update(static_cast<double>(i) / static_cast<double>(cases.size()),
                        std::string(cases[i].title) + ", " + name(model));
        Setting setting;
        setting.model = model;
        setting.spacing = cases[i].spacing;
        setting.backend = backend;
        setting.threads = options.threads;
        setting.stopped = [] { return interrupted_by() != 0; };
        try {
          rows.push_back(report::run_stress(cases[i], setting));
        } catch (const report::Stopped&) {
          progress.note("interrupted: drawing what there is");
          stopped = true;
          continue;
        }
        out << report::csv_line(rows.back()) << '\n' << std::flush;
        if (rows.back().verdict == Verdict::kFailed)
          progress.note(format("failed: %s, %s: ", cases[i].id, column_of(rows.back()).c_str()) +
                        rows.back().why);
      }
    }
  }
  if (!out.flush())
    return fail(
        {(folder.value() / kTable).string(), "cannot be written", "Is the disk full? Rows so far are kept"});
  print_summary(rows);
  if (rows.empty()) return kExitOk;
  const Result<bool> drawn =
      draw(tile_script(map_of(rows, machine_line(options))), folder.value() / "stability.png");
  if (!drawn) return fail(drawn.error());
  std::printf("Written: %s/stability.csv and stability.png\n",
              clean_text(folder.value().string(), kMostTextBytes).c_str());
  return kExitOk;
}

}  // namespace slosh
