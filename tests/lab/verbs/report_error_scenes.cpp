#include "tests/lab/verbs/report_error_scenes.h"

#include <algorithm>
#include <map>
#include <utility>

#include "sim/math/format.h"
#include "tests/lab/report/scene_frontier.h"

namespace slosh {
namespace {

using report::ErrorRow;
using report::ScenePoint;

constexpr std::pair<const char*, const char*> kColors[] = {
    {"paper", "#8c6d31"}, {"corrected", "#c8322b"}, {"incompressible", "#2e8b57"}};

/// Wall s a simulated s of the table; two cores keep real time with what one core takes the second for.
constexpr double kBudgets[] = {1.0, 2.0, 4.0, 8.0};

std::string text_of(const ErrorRow& row) {
  std::string text = row.model;
  if (row.backend != "cpu") text += " (" + row.backend + ")";
  if (row.support_ratio != 2.0) text += format(", support %.2g", row.support_ratio);
  if (row.step_share != 1.0) text += format(", %.2g of the step", row.step_share);
  return text;
}

// One machine's times say nothing about another's.
std::vector<ErrorRow> of_backend(const std::vector<ErrorRow>& rows, const char* backend) {
  std::vector<ErrorRow> some;
  for (const ErrorRow& row : rows) {
    if (row.backend == backend) some.push_back(row);
  }
  return some;
}

std::vector<glm::dvec2> ascending(std::vector<glm::dvec2> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  return points;
}

ChartPanel panel_of(const report::SceneCases& scene, const std::vector<ScenePoint>& points) {
  std::string title = scene.scene;
  for (const char* id : scene.cases) title += (title == scene.scene ? ": " : ", ") + std::string(id);
  ChartPanel panel{title, "wall s per simulated s", "worst error in units of its target", true, true, {}};
  ChartSeries best{"frontier", "#909090", {}, 0, 1.0, 1.5, true},
      usual{"the default", "#000000", {}, 6, 1.9, 0.0};
  std::map<std::string, ChartSeries> settings;
  for (const ScenePoint& point : points) {
    const glm::dvec2 at(point.time, point.miss);
    const ErrorRow& row = *point.setting;
    const std::string name = text_of(row);
    const int mark = row.is_base() ? 7 : row.support_ratio != 2.0 ? 5 : 2;
    settings.try_emplace(name, ChartSeries{name, color_of_model(row.model), {}, mark, 0.9, 0.0, false})
        .first->second.points.push_back(at);
    if (point.frontier) best.points.push_back(at);
    if (row.is_default()) usual.points.push_back(at);
  }
  best.points = ascending(best.points);
  panel.series.push_back(best);
  for (const auto& [name, series] : settings) panel.series.push_back(series);
  panel.series.push_back(usual);
  return panel;
}

// Nothing where none keeps to the budget.
template <class Which>
const ScenePoint* least(const std::vector<ScenePoint>& points, double budget, Which which) {
  const ScenePoint* found = nullptr;
  for (const ScenePoint& point : points) {
    if (point.time <= budget && which(*point.setting) && (!found || point.miss < found->miss)) found = &point;
  }
  return found;
}

}  // namespace

const char* color_of_model(const std::string& model) {
  for (const auto& [name, color] : kColors) {
    if (model == name) return color;
  }
  return "#808080";
}

std::vector<ChartPanel> scene_panels(const std::vector<ErrorRow>& rows) {
  std::vector<ChartPanel> panels;
  const std::vector<ErrorRow> cpu = of_backend(rows, "cpu");
  for (const report::SceneCases& scene : report::scene_cases()) {
    const std::vector<ScenePoint> points = report::points_of(scene, cpu);
    if (!points.empty()) panels.push_back(panel_of(scene, points));
  }
  return panels;
}

std::string scene_table(const std::vector<ErrorRow>& rows) {
  std::string text;
  for (const char* backend : {"cpu", "cuda"}) {
    const std::vector<ErrorRow> of = of_backend(rows, backend);
    for (const report::SceneCases& scene : report::scene_cases()) {
      const std::vector<ScenePoint> points = report::points_of(scene, of);
      for (const double budget : kBudgets) {
        const ScenePoint* best = least(points, budget, [](const ErrorRow&) { return true; });
        if (!best) continue;
        const ScenePoint* usual = least(points, budget, [](const ErrorRow& row) { return row.is_default(); });
        text += format("| %s, %s | %.0f | %s | %.2f, %s | ", scene.scene, backend, budget,
                       text_of(*best->setting).c_str(), best->miss, best->worst->quantity.c_str());
        text += usual ? format("%.2f, %s |\n", usual->miss, usual->worst->quantity.c_str())
                      : std::string("none fits |\n");
      }
    }
  }
  if (text.empty()) return text;
  return "\n# By scenes\n\nA shipped scene's cases judged together: the largest of their errors, in units of "
         "what each may "
         "have, of what keeps to a budget of wall seconds a simulated second.\n\n"
         "| scene | budget | misses by least | by | the default |\n|---|---|---|---|---|\n" +
         text;
}

}  // namespace slosh
