#include "peer/output/plot.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "net/text/clean.h"
#include "peer/output/gnuplot.h"
#include "peer/output/recorder.h"
#include "peer/palette.h"

namespace slosh {
namespace {

constexpr std::size_t kPlotRows = 1500;

// What there is room for.
constexpr std::size_t kMostHandBytes = 24;    // of a hand's name in the legend
constexpr std::size_t kMostTitleBytes = 120;  // of the picture's title

/// A text from elsewhere, cut to its place.
std::string shortened(const std::string& text, std::size_t most_bytes) {
  std::string shown = clean_text(text, most_bytes);
  if (clean_text(text, most_bytes + 4).size() > shown.size()) shown += "…";
  return shown;
}

std::string row_text(double time, const Wrench& w) {
  char text[200];
  std::snprintf(text, sizeof text, "%.5f %.6g %.6g %.6g %.6g %.6g %.6g %.6g %.6g\n", time,
                glm::length(w.force), w.force.x, w.force.y, w.force.z, glm::length(w.torque), w.torque.x,
                w.torque.y, w.torque.z);
  return text;
}

/// The world axis on which the vectors vary most, 0–2.
template <class Pick>
int liveliest_axis(const std::vector<WrenchSeries>& series, Pick pick) {
  glm::dvec3 range{0.0};
  for (const WrenchSeries& s : series) {
    if (s.on_hand.empty()) continue;
    glm::dvec3 low = pick(s.on_hand.front());
    glm::dvec3 high = low;
    for (const Wrench& w : s.on_hand) {
      low = glm::min(low, pick(w));
      high = glm::max(high, pick(w));
    }
    range = glm::max(range, high - low);
  }
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (range[i] > range[axis]) axis = i;
  }
  return axis;
}

void add_curves(std::string& script, const std::vector<WrenchSeries>& series,
                const std::vector<std::string>& names, const char* quantity, int magnitude_column, int axis) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  script += "plot \\\n";
  // A grip that somebody else held has no rows here.
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!series[i].time.empty()) shown.push_back(i);
  }
  for (const std::size_t i : shown) {
    const bool last = i == shown.back();
    const std::string data = "$device" + std::to_string(i);
    // Hands that feel the same lie on top of each other: the later, the thinner, so that all are seen.
    const double later = static_cast<double>(i) / static_cast<double>(std::max<std::size_t>(shown.back(), 1));
    const std::string width = last ? "1.8" : later < 0.5 ? "3.4" : "2.6";
    const std::string color = std::string("lc rgb \"") + device_color(i).hex;
    const std::string name =
        i < names.size() ? shortened(names[i], kMostHandBytes) : "device " + std::to_string(i);
    script += "  " + data + " using 1:" + std::to_string(magnitude_column + 1 + axis) + " with lines lw 1 " +
              std::string("lc rgb \"#90") + (device_color(i).hex + 1) + "\" title " +
              gnuplot_text(name + ": " + quantity + " " + kAxes[axis]) + ", \\\n";
    script += "  " + data + " using 1:" + std::to_string(magnitude_column) + " with lines lw " + width + " " +
              color + "\" title " + gnuplot_text(name + ": magnitude") + (last ? "\n" : ", \\\n");
  }
}

}  // namespace

Result<std::vector<WrenchSeries>> read_wrenches(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line) || line != kWrenchesHeader) {
    return Error{file.string(), "cannot be read as recorded wrenches",
                 "Its first line must be " + std::string(kWrenchesHeader)};
  }
  std::vector<WrenchSeries> series;
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    std::array<double, 8> v{};
    const char* at = line.data();
    const char* const end = at + line.size();
    for (std::size_t i = 0; i < v.size(); ++i) {
      const auto [after, code] = std::from_chars(at, end, v[i]);
      const bool last = i + 1 == v.size();
      if (code != std::errc() || (last ? after != end : after == end || *after != ',')) {
        return Error{file.string() + ": line " + std::to_string(number), "is not eight numbers",
                     "Remove the line; a crash may have cut the last one short"};
      }
      at = after + 1;
    }
    if (!(v[1] >= 0.0 && v[1] < 256.0)) {
      return Error{file.string() + ": line " + std::to_string(number), "device is not an index from 0 to 255",
                   "Correct the field"};
    }
    const auto device = static_cast<std::size_t>(v[1]);
    if (device >= series.size()) series.resize(device + 1);
    series[device].time.push_back(v[0]);
    series[device].on_hand.push_back({{v[2], v[3], v[4]}, {v[5], v[6], v[7]}});
  }
  return series;
}

WrenchSeries thinned(const WrenchSeries& series, std::size_t rows) {
  const std::size_t count = series.time.size();
  const std::size_t group = rows == 0 ? 1 : (count + rows - 1) / rows;
  if (group <= 1) return series;
  WrenchSeries out;
  for (std::size_t begin = 0; begin < count; begin += group) {
    const std::size_t end = std::min(begin + group, count);
    double time = 0.0;
    Wrench sum;
    for (std::size_t i = begin; i < end; ++i) {
      time += series.time[i];
      sum = sum + series.on_hand[i];
    }
    const double share = 1.0 / static_cast<double>(end - begin);
    out.time.push_back(time * share);
    out.on_hand.push_back({sum.force * share, sum.torque * share});
  }
  return out;
}

std::string plot_script(const std::vector<WrenchSeries>& series, const std::vector<std::string>& names,
                        const std::string& title) {
  std::string script;
  for (std::size_t i = 0; i < series.size(); ++i) {
    script += "$device" + std::to_string(i) + " << END_OF_DATA\n";
    const WrenchSeries rows = thinned(series[i], kPlotRows);
    for (std::size_t row = 0; row < rows.time.size(); ++row)
      script += row_text(rows.time[row], rows.on_hand[row]);
    script += "END_OF_DATA\n";
  }
  const int force_axis = liveliest_axis(series, [](const Wrench& w) { return w.force; });
  const int torque_axis = liveliest_axis(series, [](const Wrench& w) { return w.torque; });
  script += "set encoding utf8\n";
  script +=
      "set terminal pngcairo size 1200,900 noenhanced font \"DejaVu Sans,12\" background rgb \"white\"\n";
  script +=
      "set multiplot layout 2,1 margins 0.075,0.79,0.075,0.925 spacing 0,0.06\n"
      "set border 3 lc rgb \"#606060\"\n"
      "set grid lc rgb \"#dcdcdc\" lt 1 lw 1\n"
      "set tics nomirror textcolor rgb \"#303030\"\n"
      "set key outside right top reverse Left samplen 2 spacing 1.25 font \"DejaVu Sans,10\"\n"
      "set xzeroaxis lt 1 lc rgb \"#a0a0a0\"\n"
      "set autoscale xfix\n"
      "set offsets 0,0,graph 0.04,graph 0.04\n";
  script += "set title " + gnuplot_text(shortened(title, kMostTitleBytes)) + " font \"DejaVu Sans,14\"\n";
  script += "set ylabel \"force on the hand, N\"\nset format x \"\"\n";
  add_curves(script, series, names, "along", 2, force_axis);
  script += "unset title\nset format x \"%g\"\nset xlabel \"simulated time, s\"\n";
  script += "set ylabel \"torque on the hand, N·m\"\n";
  add_curves(script, series, names, "about", 6, torque_axis);
  script += "unset multiplot\n";
  return script;
}

Result<bool> plot_wrenches(const std::filesystem::path& csv, const std::vector<std::string>& names,
                           const std::string& title, const std::filesystem::path& png) {
  Result<std::vector<WrenchSeries>> series = read_wrenches(csv);
  if (!series) return series.error();
  const bool nothing = std::all_of(series.value().begin(), series.value().end(),
                                   [](const WrenchSeries& s) { return s.time.size() < 2; });
  if (nothing) return false;
  return draw(plot_script(series.value(), names, title), png);
}

}  // namespace slosh
