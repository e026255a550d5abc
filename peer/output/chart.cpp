#include "peer/output/chart.h"

#include <algorithm>
#include <cmath>

#include "peer/output/gnuplot.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr int kPanelWidth = 620, kPanelHeight = 420, kTitleHeight = 46;  // pixels
// A legend of longer names stands below the axes: beside them it would leave the curves no room.
constexpr std::size_t kLongestBeside = 28;            // bytes of a name
constexpr int kLetter = 6, kSample = 50, kLine = 15;  // pixels of a legend's

const char* const kStyle =
    "set encoding utf8\n"
    "set border 3 lc rgb \"#606060\"\n"
    "set grid lc rgb \"#dcdcdc\" lt 1 lw 1\n"
    "set tics nomirror textcolor rgb \"#303030\"\n";

bool shown(const ChartPanel& panel, const glm::dvec2& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && (!panel.log_x || p.x > 0.0) &&
         (!panel.log_y || p.y > 0.0);
}

/// The least and the largest value of an axis (0: x, 1: y) that is drawn; the least is above where there is
/// none.
glm::dvec2 extent(const ChartPanel& panel, int axis) {
  glm::dvec2 found(INFINITY, -INFINITY);
  for (const ChartSeries& series : panel.series) {
    for (const glm::dvec2& p : series.points) {
      if (!shown(panel, p)) continue;
      found = {std::min(found.x, p[axis]), std::max(found.y, p[axis])};
    }
  }
  return found;
}

/// Of values that are all at or above nothing.
bool starts_near_zero(const glm::dvec2& extent) {
  return extent.x >= 0.0 && extent.x < 0.1 * extent.y;
}

/// A logarithmic axis ends a little beyond what it shows, not at the next power of ten, where two of these
/// are left to be written at it. Empty: gnuplot may choose.
std::string log_range(const char* axis, const glm::dvec2& extent) {
  constexpr double kBeyond = 1.5;
  const double low = extent.x / kBeyond, high = extent.y * kBeyond;
  if (!(low < high) || std::floor(std::log10(high)) - std::ceil(std::log10(low)) < 1.0) return {};
  return format("set %srange [%.8g:%.8g]\n", axis, low, high);
}

/// The horizontal axis of curves begins and ends where they do; marks at its ends need room around them.
std::string range_script(const ChartPanel& panel) {
  const glm::dvec2 x = extent(panel, 0);
  const bool marks =
      std::any_of(panel.series.begin(), panel.series.end(), [](const ChartSeries& s) { return s.mark > 0; });
  if (!marks && x.x < x.y) return format("set xrange [%.8g:%.8g]\n", x.x, x.y);
  const std::string by_tens = panel.log_x ? log_range("x", x) : "";
  if (!by_tens.empty()) return by_tens;
  return !panel.log_x && starts_near_zero(x) ? "set xrange [0:*]\n" : "set xrange [*:*]\n";
}

/// Stretches of the axis, every second one shaded, their names above the curves.
std::string spans_script(const ChartPanel& panel) {
  std::string script = "unset object\nunset label\n";
  if (panel.spans.empty()) return script + range_script(panel) + "set tmargin\nset bmargin\n";
  // Room above for the names, below for what stands in the corner.
  script += format("set xrange [%.8g:%.8g]\nset tmargin 4.5\nset bmargin 5\n", panel.spans.front().from,
                   panel.spans.back().to);
  for (std::size_t i = 0; i < panel.spans.size(); ++i) {
    const ChartSpan& span = panel.spans[i];
    if (i % 2 == 1) {
      script += format(
          "set object rectangle from first %.8g,graph 0 to first %.8g,graph 1 behind fc rgb \"#eef1f5\" fs "
          "solid noborder\n",
          span.from, span.to);
    }
    script +=
        "set label " + gnuplot_text(span.name) +
        format(" at first %.8g,graph 1.0 center offset 0,0.6 tc rgb \"#505050\" font \"DejaVu Sans,8\"\n",
               0.5 * (span.from + span.to));
  }
  return script;
}

/// Whether the vertical axis begins at nothing: where the values are all at or above it and begin there.
bool begins_at_zero(const ChartPanel& panel) {
  const glm::dvec2 y = extent(panel, 1);
  return !panel.log_y && ((panel.y_from_zero && y.x >= 0.0) || starts_near_zero(y));
}

std::string height_script(const ChartPanel& panel) {
  const bool zero = begins_at_zero(panel);
  const std::string range = panel.log_y ? log_range("y", extent(panel, 1)) : "";
  // Room around what is drawn, but none below nothing.
  return format("set offsets graph 0.05, graph 0.05, graph 0.08, %s\n", zero ? "0" : "graph 0.08") +
         (!range.empty() ? range
          : zero         ? "set yrange [0:*]\n"
                         : "set yrange [*:*]\n");
}

std::size_t longest_name(const ChartPanel& panel) {
  std::size_t longest = 0;
  for (const ChartSeries& series : panel.series) longest = std::max(longest, series.name.size());
  return longest;
}
bool has_legend_below(const ChartPanel& panel) {
  return panel.legend && !panel.key_alone && longest_name(panel) > kLongestBeside;
}
/// Pixels that a legend below the axes takes; 0 beside them.
int height_below(const ChartPanel& panel) {
  if (!has_legend_below(panel)) return 0;
  const int columns = std::max(1, kPanelWidth / (kSample + kLetter * static_cast<int>(longest_name(panel))));
  return kLine * ((static_cast<int>(panel.series.size()) + columns - 1) / columns);
}

std::string look_of(const ChartSeries& series) {
  std::string look = series.width > 0.0 ? (series.mark > 0 ? "linespoints" : "lines") : "points";
  if (series.width > 0.0) look += format(" lw %.2g dt %s", series.width, series.dashed ? "2" : "1");
  if (series.mark > 0) look += format(" pt %d ps %.2g", series.mark, series.size);
  return look + " lc rgb \"" + series.color + "\" ";
}

std::string key_script(const ChartPanel& panel) {
  std::string script =
      "unset logscale\nunset object\nunset label\nset xrange [0:1]\nset yrange [0:1]\nunset border\nunset "
      "tics\n"
      "unset title\nunset xlabel\nunset ylabel\n"
      "set key inside left top reverse Left samplen 2 font \"DejaVu Sans,10\"\n";
  std::string plot;
  for (const ChartSeries& series : panel.series) {
    plot += (plot.empty() ? "plot " : ", \\\n  ") + std::string("NaN with ") + look_of(series) + "title " +
            gnuplot_text(series.name);
  }
  return script + plot + "\n" + kStyle + "set tics\nset autoscale\n";
}

std::string panel_script(const ChartPanel& panel, std::size_t number) {
  if (panel.key_alone) return key_script(panel);
  std::string data, plot;
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const ChartSeries& series = panel.series[i];
    std::string rows;
    for (const glm::dvec2& p : series.points) {
      if (shown(panel, p)) rows += format("%.8g %.8g\n", p.x, p.y);
    }
    if (rows.empty()) continue;
    const std::string block = format("$p%zus%zu", number, i);
    data += block + " << END_OF_DATA\n" + rows + "END_OF_DATA\n";
    plot += (plot.empty() ? "plot " : ", \\\n  ") + block + " using 1:2 with ";
    plot += look_of(series);
    plot += series.name.empty() ? "notitle" : "title " + gnuplot_text(series.name);
  }
  std::string script = data + "unset logscale\n" + spans_script(panel);
  script += !panel.legend ? "unset key\n"
                          : std::string("set key outside ") +
                                (has_legend_below(panel) ? "below center" : "right top vertical") +
                                " reverse Left samplen 2 font \"DejaVu Sans,9\"\n";
  // A title of nothing keeps a legend below off the axis' label.
  if (panel.legend)
    script += has_legend_below(panel) ? "set key title \" \" font \"DejaVu Sans,5\"\n" : "set key notitle\n";
  if (panel.log_x) script += "set logscale x\n";
  if (panel.log_y) script += "set logscale y\n";
  script += height_script(panel);
  script += "set title " + gnuplot_text(panel.title) + (panel.spans.empty() ? "" : " offset 0,0.7") +
            " font \"DejaVu Sans,12\"\n";
  script +=
      "set xlabel " + gnuplot_text(panel.x_label) + "\nset ylabel " + gnuplot_text(panel.y_label) + "\n";
  // Where nothing is to be drawn the panel says so, or gnuplot would fail over an empty range.
  if (plot.empty())
    return script +
           "unset logscale\nset xrange [0:1]\nset yrange [0:1]\nplot NaN title \"no data\"\nset autoscale\n";
  return script + plot + "\n";
}

}  // namespace

std::string chart_script(const std::vector<ChartPanel>& panels, int columns, const std::string& title,
                         const std::string& picture, const std::string& corner) {
  const int rows = (static_cast<int>(panels.size()) + columns - 1) / columns;
  int height = kPanelHeight;
  for (const ChartPanel& panel : panels) height = std::max(height, kPanelHeight + height_below(panel));
  std::string script =
      kStyle + gnuplot_terminal(picture, columns * kPanelWidth, rows * height + kTitleHeight, 11);
  script += "set format x \"%g\"\nset format y \"%g\"\n";
  script += format("set multiplot layout %d,%d title ", rows, columns) + gnuplot_text(title) +
            " font \"DejaVu Sans,14\"\n";
  for (std::size_t i = 0; i < panels.size(); ++i) {
    std::string panel = panel_script(panels[i], i);
    if (i + 1 == panels.size() && !corner.empty()) {
      // With the last panel, as each begins without labels.
      panel.insert(panel.rfind("plot "),
                   "set label " + gnuplot_text(corner) +
                       " at screen 0.995,0.012 right tc rgb \"#707070\" font \"DejaVu Sans,7\"\n");
    }
    script += panel;
  }
  return script + "unset multiplot\n";
}

std::string tile_script(const TileMap& map) {
  constexpr int kRow = 24, kColumn = 165, kLeft = 420, kTop = 146;
  const int rows = static_cast<int>(map.rows.size()), columns = static_cast<int>(map.columns.size());
  const double width = kLeft + kColumn * columns + 40, height = kTop + kRow * rows + 30;
  std::string script =
      "set encoding utf8\n" + gnuplot_terminal("png", static_cast<int>(width), static_cast<int>(height), 11) +
      format("set lmargin at screen %.5f\nset rmargin at screen %.5f\n", kLeft / width,
             (kLeft + kColumn * columns) / width) +
      format("set tmargin at screen %.5f\nset bmargin at screen %.5f\n", 1.0 - kTop / height, 20.0 / height) +
      "unset border\nunset tics\nunset key\n" +
      format("set xrange [0:%d]\nset yrange [%d:0]\n", columns, rows);
  script += "set label " + gnuplot_text(map.title) +
            format(" at screen 0.5,%.5f center font \"DejaVu Sans,14\"\n", 1.0 - 24.0 / height);
  script += "set label " + gnuplot_text(map.subtitle) +
            format(" at screen 0.5,%.5f center font \"DejaVu Sans,9\"\n", 1.0 - 44.0 / height);
  for (int r = 0; r < rows; ++r) {
    script += "set label " + gnuplot_text(map.rows[static_cast<std::size_t>(r)]) +
              format(" at -0.08,%.1f right\n", r + 0.5);
    for (int c = 0; c < columns; ++c) {
      const int kind = map.kind[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
      if (kind < 0) continue;
      script += format("set object rectangle from %.2f,%.2f to %.2f,%.2f fc rgb \"%s\" fs solid noborder\n",
                       c + 0.02, r + 0.06, c + 0.98, r + 0.94,
                       map.kinds[static_cast<std::size_t>(kind)].color.c_str());
      const std::string& text = map.text[static_cast<std::size_t>(r)][static_cast<std::size_t>(c)];
      if (!text.empty()) {
        script +=
            "set label " + gnuplot_text(text) +
            format(" at %.2f,%.2f center front tc rgb \"white\" font \"DejaVu Sans,9\"\n", c + 0.5, r + 0.5);
      }
    }
  }
  for (int c = 0; c < columns; ++c) {
    script += "set label " + gnuplot_text(map.columns[static_cast<std::size_t>(c)]) +
              format(" at %.2f,-0.5 center\n", c + 0.5);
  }
  for (std::size_t k = 0; k < map.kinds.size(); ++k) {
    const double x = (20.0 + 150.0 * static_cast<double>(k)) / width, y = 1.0 - 76.0 / height;
    script += format(
        "set object rectangle from screen %.5f,%.5f to screen %.5f,%.5f fc rgb \"%s\" fs solid noborder\n", x,
        y - 8.0 / height, x + 16.0 / width, y + 8.0 / height, map.kinds[k].color.c_str());
    script += "set label " + gnuplot_text(map.kinds[k].name) +
              format(" at screen %.5f,%.5f\n", x + 24.0 / width, y);
  }
  return script + "plot NaN notitle\n";
}

}  // namespace slosh
