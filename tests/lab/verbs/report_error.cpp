// `slosh report error`: every case at every setting, as rows, pictures and a table.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "net/text/clean.h"
#include "peer/output/chart.h"
#include "peer/output/gnuplot.h"
#include "peer/output/progress.h"
#include "peer/output/whole_file.h"
#include "peer/app/interrupt.h"
#include "peer/app/verbs.h"
#include "sim/math/format.h"
#include "tests/lab/report/close_spacings.h"
#include "tests/lab/report/frontier.h"
#include "tests/lab/verbs/report.h"
#include "tests/lab/verbs/report_error_scenes.h"

namespace slosh {
namespace {

using report::ErrorCase;
using report::ErrorRow;
using report::Setting;

constexpr const char* kErrorTable = "errors.csv";

constexpr const char* kModels[] = {"paper", "corrected", "incompressible"};

/// One picture's and one table line's rows: of one case and one quantity of it.
struct Group {
  std::string case_id, quantity, title;
  std::vector<ErrorRow> rows;
};

std::vector<Group> groups_of(const std::vector<ErrorRow>& rows) {
  std::vector<Group> groups;
  for (const ErrorRow& row : rows) {
    if (!row.plotted || !row.refused.empty()) continue;
    auto at = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
      return g.case_id == row.case_id && g.quantity == row.quantity;
    });
    if (at == groups.end()) {
      const ErrorCase* known = report::find_error_case(row.case_id);
      groups.push_back(
          {row.case_id, row.quantity, (known ? known->title : row.case_id) + (": " + row.quantity), {}});
      at = groups.end() - 1;
    }
    at->rows.push_back(row);
  }
  return groups;
}

glm::dvec2 time_and_error(const ErrorRow& row) {
  return {row.wall_per_simulated(), 100.0 * std::abs(row.error())};
}

std::vector<glm::dvec2> frontier_of(const std::vector<ErrorRow>& rows) {
  std::vector<glm::dvec2> all, best;
  for (const ErrorRow& row : rows) all.push_back(time_and_error(row));
  const std::vector<bool> on = report::on_frontier(all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (on[i]) best.push_back(all[i]);
  }
  std::sort(best.begin(), best.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  return best;
}

// How far the readings of a mean scatter, as an upright line through where it is drawn. On a logarithmic axis
// nothing is at zero: the line ends at a third of the mean then.
void add_scatter(const ErrorRow& row, const glm::dvec2& at, ChartPanel& panel) {
  if (row.readings < 2) return;
  const double scatter = 100.0 * row.scatter;
  panel.series.push_back({"",
                          color_of_model(row.model),
                          {{at.x, std::max(at.y - scatter, at.y / 3.0)}, {at.x, at.y + scatter}},
                          0,
                          1.0,
                          1.2,
                          false});
}

ChartPanel against_time(const Group& group) {
  ChartPanel panel{group.title, "wall s per simulated s", "|error|, %", true, true, {}};
  panel.series.push_back({"frontier", "#909090", frontier_of(group.rows), 0, 1.0, 1.5, true});
  for (const bool cuda : {false, true}) {
    for (const std::string model : kModels) {
      const std::string on = cuda ? " (CUDA)" : "";
      ChartSeries base{model + on, color_of_model(model), {}, cuda ? 9 : 7, 0.9, 1.2, false};
      ChartSeries variants{
          model + on + ", support 2.5", color_of_model(model), {}, cuda ? 11 : 5, 0.9, 0.0, false};
      ChartSeries shorter{model + on + ", half the step", color_of_model(model), {}, 2, 0.8, 0.0, false};
      for (const ErrorRow& row : group.rows) {
        if (row.model != model || (row.backend == "cuda") != cuda) continue;
        auto& to = row.is_base() ? base : row.support_ratio != 2.0 ? variants : shorter;
        to.points.push_back(time_and_error(row));
        add_scatter(row, time_and_error(row), panel);
      }
      for (ChartSeries& series : {std::ref(base), std::ref(variants), std::ref(shorter)})
        panel.series.push_back(series);
    }
  }
  // The two settings that everybody asks for, ringed.
  ChartSeries paper{"the paper's setting", "#000000", {}, 4, 1.9, 0.0, false};
  ChartSeries usual{"the default", "#000000", {}, 6, 1.9, 0.0, false};
  for (const ErrorRow& row : group.rows) {
    if (row.is_paper()) paper.points.push_back(time_and_error(row));
    if (row.is_default()) usual.points.push_back(time_and_error(row));
  }
  panel.series.push_back(paper);
  panel.series.push_back(usual);
  return panel;
}

// From coarse to fine. The backends agree to rounding; a GPU's rows go on where a CPU's take too long.
std::vector<std::pair<glm::dvec2, const ErrorRow*>> by_spacing(const Group& group, const std::string& model) {
  std::map<double, const ErrorRow*, std::greater<>> rows;
  for (const ErrorRow& row : group.rows) {
    if (row.model != model || !row.is_base()) continue;
    const auto [at, is_new] = rows.emplace(row.spacing, &row);
    if (!is_new && row.backend == "cpu") at->second = &row;
  }
  std::vector<std::pair<glm::dvec2, const ErrorRow*>> points;
  for (const auto& [spacing, row] : rows)
    points.emplace_back(glm::dvec2(1e3 * spacing, 100.0 * std::abs(row->error())), row);
  return points;
}

ChartPanel against_spacing(const Group& group) {
  ChartPanel panel{"convergence", "spacing, mm", "|error|, %", true, true, {}};
  for (const std::string model : kModels) {
    std::vector<glm::dvec2> points;
    for (const auto& [at, row] : by_spacing(group, model)) {
      points.push_back(at);
      add_scatter(*row, at, panel);
    }
    const std::optional<double> order = report::order_of(points);
    panel.series.push_back({model + (order ? format(", order %.1f", *order) : std::string()),
                            color_of_model(model), points, 7, 0.9, 1.2, false});
  }
  return panel;
}

std::string file_name(const Group& group) {
  return folder_name(group.case_id + "-" + group.quantity, "case") + ".png";
}

// The default's and each other model's error at each spacing, and where the default stands.
std::string markdown(const std::vector<Group>& groups, const std::string& machine) {
  std::string text =
      "# Error against run time\n\n" + machine +
      "\n\nError in % and, after the slash, wall seconds a simulated second; support ratio 2, the "
      "plan's time step. Bold: nothing in the report has less error for as little time. \"+1.1 ± 1.9 (5)\" "
      "is the "
      "mean of five spacings close by, and the root mean square of what they differ by from it.\n\n"
      "| case | reads | spacing, mm | paper | corrected | incompressible | CUDA, corrected | "
      "CUDA, "
      "incompressible |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const Group& group : groups) {
    const std::vector<glm::dvec2> best = frontier_of(group.rows);
    std::vector<double> spacings;
    for (const ErrorRow& row : group.rows) spacings.push_back(row.spacing);
    std::sort(spacings.rbegin(), spacings.rend());
    spacings.erase(std::unique(spacings.begin(), spacings.end()), spacings.end());
    const std::string title = group.title.substr(0, group.title.rfind(": "));
    for (const double spacing : spacings) {
      text += format("| %s | %s | %.3g |", title.c_str(), group.quantity.c_str(), 1e3 * spacing);
      for (const auto& [model, backend] : {std::pair{"paper", "cpu"},
                                           {"corrected", "cpu"},
                                           {"incompressible", "cpu"},
                                           {"corrected", "cuda"},
                                           {"incompressible", "cuda"}}) {
        const auto row = std::find_if(group.rows.begin(), group.rows.end(), [&](const ErrorRow& r) {
          return r.model == model && r.backend == backend && r.spacing == spacing && r.is_base();
        });
        if (row == group.rows.end()) {
          text += " |";
          continue;
        }
        const bool front = std::find(best.begin(), best.end(), time_and_error(*row)) != best.end();
        std::string cell = format("%+.3g", 100.0 * row->error());
        if (row->readings > 1) cell += format(" ± %.2g (%d)", 100.0 * row->scatter, row->readings);
        cell += format(" / %.2g", row->wall_per_simulated());
        if (row->retired > 0.0)
          cell += format(" (%.0f %% lost)", 100.0 * row->retired / std::max(row->particles, 1.0));
        text += (front ? " **" + cell + "** |" : " " + cell + " |");
      }
      text += "\n";
    }
  }
  return text;
}

// What the marks of the pictures mean, each once.
ChartPanel key_of(const std::vector<ChartPanel>& panels) {
  ChartPanel key;
  key.key_alone = true;
  for (const ChartPanel& panel : panels) {
    for (const ChartSeries& series : panel.series) {
      const bool known = std::any_of(key.series.begin(), key.series.end(),
                                     [&](const ChartSeries& other) { return other.name == series.name; });
      if (!known && !series.points.empty()) key.series.push_back(series);
    }
  }
  return key;
}

int write_up(const std::vector<ErrorRow>& all_rows, const std::filesystem::path& folder,
             const std::string& machine) {
  const std::vector<ErrorRow> rows = report::means_of_close(all_rows);
  const std::vector<Group> groups = groups_of(rows);
  const Result<bool> table = write_whole(folder / "errors.md", markdown(groups, machine) + scene_table(rows));
  if (!table) return fail(table.error());
  std::vector<ChartPanel> all;
  for (const Group& group : groups) {
    const ChartPanel panel = against_time(group);
    const Result<bool> drawn =
        draw(chart_script({panel, against_spacing(group)}, 2, machine), folder / file_name(group));
    if (!drawn) return fail(drawn.error());
    all.push_back(panel);
    all.back().legend = false;
  }
  if (all.empty()) return kExitOk;
  all.push_back(key_of(all));
  const Result<bool> drawn =
      draw(chart_script(all, 3, "Error against run time: " + machine), folder / "errors.png");
  if (!drawn) return fail(drawn.error());
  std::vector<ChartPanel> scenes = scene_panels(rows);
  if (!scenes.empty()) {
    for (ChartPanel& panel : scenes) panel.legend = false;
    scenes.push_back(key_of(scenes));
    const Result<bool> by_scene =
        draw(chart_script(scenes, 3, "Error against run time, by scenes, on a CPU: " + machine),
             folder / "scenes.png");
    if (!by_scene) return fail(by_scene.error());
  }
  std::printf("Written: %s/errors.csv, errors.md, errors.png%s and a picture for each of %zu readings\n",
              clean_text(folder.string(), kMaxTextBytes).c_str(), scenes.empty() ? "" : ", scenes.png",
              groups.size());
  return kExitOk;
}

std::string job_name(const ErrorCase& which, const Setting& setting) {
  std::string text = format("%s, %s, %.3g mm", which.id, name(setting.model), 1e3 * setting.spacing);
  if (setting.support_ratio != 2.0) text += format(", support %.2g", setting.support_ratio);
  if (setting.step_share != 1.0) text += format(", %.2g of the step", setting.step_share);
  if (setting.backend == Backend::kCuda) text += ", CUDA";
  return text;
}

// Work in particles and steps: a spacing half as long is eight times the particles and twice the steps.
double weight_of(const ErrorCase& which, const Setting& setting) {
  const double ratio = which.spacings.front() / setting.spacing;
  return std::pow(ratio, 4.0) * std::pow(setting.support_ratio / 2.0, 2.0) / setting.step_share;
}

}  // namespace

int report_error(const ReportOptions& options) {
  const Result<std::vector<const ErrorCase*>> cases = report::chosen(report::error_cases(), options.cases);
  if (!cases) return fail(cases.error());
  if (options.from.empty()) {
    if (const std::optional<Error> missing = no_backend(options)) return fail(*missing);
  }
  std::vector<ErrorRow> rows;
  for (const std::string& file : options.from) {
    const Result<std::vector<ErrorRow>> read = report::read_errors(file);
    if (!read) return fail(read.error());
    rows.insert(rows.end(), read.value().begin(), read.value().end());
  }
  const Result<std::filesystem::path> folder = report_folder(options, "error", kErrorTable);
  if (!folder) return fail(folder.error());
  catch_interrupts();
  const std::filesystem::path table = folder.value() / kErrorTable;
  std::ofstream out(table);
  out << report::kErrorHeader << '\n';
  for (const ErrorRow& row : rows) out << report::csv_line(row) << '\n';
  Progress progress;
  std::vector<ReportJob> jobs;
  for (const ErrorCase* which : options.from.empty() ? cases.value() : std::vector<const ErrorCase*>()) {
    for (const Setting& setting : report::settings_of(*which, sweep_of(options))) {
      const std::string named = job_name(*which, setting);
      jobs.push_back({named, weight_of(*which, setting), [&, which, setting, named] {
                        for (const ErrorRow& row : report::run_case(*which, setting)) {
                          out << report::csv_line(row) << '\n';
                          rows.push_back(row);
                          if (!row.refused.empty()) progress.note(named + ": " + row.refused);
                        }
                      }});
    }
  }
  if (const Result<bool> ran = run_jobs(jobs, out, table, progress); !ran) return fail(ran.error());
  const int written = write_up(rows, folder.value(), origin_line(options));
  const bool any =
      std::any_of(rows.begin(), rows.end(), [](const ErrorRow& row) { return row.refused.empty(); });
  if (written != kExitOk || rows.empty() || any) return written;
  return fail({"report error", "every run was refused", "Each line above says why"});
}

}  // namespace slosh
