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
#include "peer/view/palette.h"
#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr std::size_t kPlotPoints = 3000;

// What there is room for.
constexpr std::size_t kMaxHandBytes = 24;   // of a hand's name in the legend
constexpr std::size_t kMaxTitleBytes = 90;  // of the sheet's title
constexpr std::size_t kMaxLineBytes = 180;  // of a line under it
constexpr int kSheetWidth = 1200;

/// A text from elsewhere, cut to its place.
std::string shortened(const std::string& text, std::size_t most_bytes) {
  std::string shown = clean_text(text, most_bytes);
  if (clean_text(text, most_bytes + 4).size() > shown.size()) shown += "…";
  return shown;
}

struct Quantity {
  const char* name;
  const char* label;
  int part;  ///< 0 the size, 1–3 along an axis; 4 and 5–7 the same of the torque
};

constexpr std::array<Quantity, 8> kQuantities{{{"force", "force on the hand, N", 0},
                                               {"fx", "force along x, N", 1},
                                               {"fy", "force along y, N", 2},
                                               {"fz", "force along z, N", 3},
                                               {"torque", "torque on the hand, N·m", 4},
                                               {"tx", "torque about x, N·m", 5},
                                               {"ty", "torque about y, N·m", 6},
                                               {"tz", "torque about z, N·m", 7}}};

double reading(const Wrench& w, int part) {
  const glm::dvec3& of = part < 4 ? w.force : w.torque;
  return part % 4 == 0 ? glm::length(of) : of[part % 4 - 1];
}

/// Data blocks $qQdD, a quantity and device each: time and value, peaks kept.
std::string data_of(const std::vector<WrenchSeries>& series, const std::vector<Quantity>& quantities) {
  std::string script;
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    for (std::size_t d = 0; d < series.size(); ++d) {
      std::vector<glm::dvec2> curve;
      for (std::size_t i = 0; i < series[d].time.size(); ++i)
        curve.emplace_back(series[d].time[i], reading(series[d].on_hand[i], quantities[q].part));
      script += format("$q%zud%zu << END_OF_DATA\n", q, d);
      for (const glm::dvec2& point : thinned(curve, kPlotPoints))
        script += format("%.5f %.6g\n", point.x, point.y);
      script += "END_OF_DATA\n";
    }
  }
  return script;
}

/// The world axis on which the vectors vary most, 0–2.
template <class Pick>
std::size_t liveliest_axis(const std::vector<WrenchSeries>& series, Pick pick) {
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
  std::size_t axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (range[i] > range[static_cast<int>(axis)]) axis = static_cast<std::size_t>(i);
  }
  return axis;
}

std::vector<Quantity> chosen(const std::vector<WrenchSeries>& series, const PlotSheet& sheet) {
  std::vector<Quantity> quantities;
  for (const std::string& name : sheet.quantities) {
    for (const Quantity& quantity : kQuantities) {
      if (name == quantity.name) quantities.push_back(quantity);
    }
  }
  if (!quantities.empty()) return quantities;
  const std::size_t force = liveliest_axis(series, [](const Wrench& w) { return w.force; });
  const std::size_t torque = liveliest_axis(series, [](const Wrench& w) { return w.torque; });
  return {kQuantities[0], kQuantities[1 + force], kQuantities[4], kQuantities[5 + torque]};
}

/// Devices that have rows: a grip that somebody else held has none here.
std::vector<std::size_t> devices_shown(const std::vector<WrenchSeries>& series) {
  std::vector<std::size_t> shown;
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (!series[i].time.empty()) shown.push_back(i);
  }
  return shown;
}

/// What is drawn over others is thinner and dashed, so that those under it show.
std::string line_of(std::size_t order, std::size_t device) {
  constexpr std::array<const char*, 4> kLines{"lw 3 dt 1", "lw 1.8 dt (16,14)", "lw 1.8 dt (4,10)",
                                              "lw 1.4 dt (16,6,3,6)"};
  return std::string(kLines[order % kLines.size()]) + " lc rgb \"" + device_color(device).hex + "\"";
}

std::string curves_of(const std::vector<WrenchSeries>& series, const PlotSheet& sheet, std::size_t quantity,
                      bool legend) {
  std::string script;
  const std::vector<std::size_t> shown = devices_shown(series);
  for (std::size_t order = 0; order < shown.size(); ++order) {
    const std::size_t i = shown[order];
    const std::string name =
        i < sheet.names.size() ? shortened(sheet.names[i], kMaxHandBytes) : "device " + std::to_string(i);
    script += (order == 0 ? "plot \\\n  " : ", \\\n  ") + format("$q%zud%zu", quantity, i) +
              " using 1:2 with lines " + line_of(order, i) +
              (legend ? " title " + gnuplot_text(name) : std::string(" notitle"));
  }
  return script + "\n";
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

std::vector<glm::dvec2> thinned(const std::vector<glm::dvec2>& curve, std::size_t points) {
  const std::size_t groups = std::max<std::size_t>(1, points / 2);
  const std::size_t group = (curve.size() + groups - 1) / groups;
  if (group <= 2) return curve;
  std::vector<glm::dvec2> out;
  for (std::size_t begin = 0; begin < curve.size(); begin += group) {
    const std::size_t end = std::min(begin + group, curve.size());
    std::size_t least = begin;
    std::size_t most = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (curve[i].y < curve[least].y) least = i;
      if (curve[i].y > curve[most].y) most = i;
    }
    out.push_back(curve[std::min(least, most)]);
    if (least != most) out.push_back(curve[std::max(least, most)]);
  }
  return out;
}

const std::vector<std::string>& plot_quantities() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Quantity& quantity : kQuantities) all.emplace_back(quantity.name);
    return all;
  }();
  return names;
}

const std::vector<std::string>& plot_formats() {
  static const std::vector<std::string> formats{"png", "svg", "pdf"};
  return formats;
}

std::string plot_script(const std::vector<WrenchSeries>& series, const PlotSheet& sheet) {
  const std::vector<Quantity> quantities = chosen(series, sheet);
  std::string script = data_of(series, quantities);
  const int panels = static_cast<int>(quantities.size());
  const int head = 58 + 18 * static_cast<int>(sheet.parameters.size());
  const int height = head + 212 * panels + 60;
  const auto from_top = [&](int pixels) {
    return std::to_string(1.0 - static_cast<double>(pixels) / height);
  };
  script += "set encoding utf8\n" + gnuplot_terminal(sheet.format, kSheetWidth, height, 12);
  script += "set multiplot layout " + std::to_string(panels) + ",1 margins 0.085,0.97," +
            std::to_string(60.0 / height) + "," + from_top(head) + " spacing 0," +
            std::to_string(16.0 / height) + "\n";
  script +=
      "set border 3 lc rgb \"#606060\"\n"
      "set grid lc rgb \"#dcdcdc\" lt 1 lw 1\n"
      "set tics nomirror textcolor rgb \"#303030\"\n"
      "set autoscale xfix\n"
      "set offsets 0,0,graph 0.06,graph 0.06\n"
      "set ylabel offset 0.5,0\n";
  script += "set label 1 " + gnuplot_text(shortened(sheet.title, kMaxTitleBytes)) + " at screen 0.085," +
            from_top(22) + " font \"DejaVu Sans,14\"\n";
  for (std::size_t i = 0; i < sheet.parameters.size(); ++i) {
    script += "set label " + std::to_string(i + 2) + " " +
              gnuplot_text(shortened(sheet.parameters[i], kMaxLineBytes)) + " at screen 0.085," +
              from_top(44 + 18 * static_cast<int>(i)) +
              " font \"DejaVu Sans,10\" textcolor rgb \"#505050\"\n";
  }
  script += "set key at screen 0.97," + from_top(22) +
            " right horizontal reverse Left samplen 3 font \"DejaVu Sans,11\"\n";
  for (int i = 0; i < panels; ++i) {
    const Quantity& quantity = quantities[static_cast<std::size_t>(i)];
    script += std::string("set ylabel \"") + quantity.label + "\"\n";
    if (i + 1 < panels) {
      script += "set format x \"\"\nunset xlabel\n";
    } else {
      script += "set format x \"%g\"\nset xlabel \"simulated time, s\"\n";
    }
    script += curves_of(series, sheet, static_cast<std::size_t>(i), i == 0);
    if (i == 0) script += "unset label\nunset key\n";
  }
  return script + "unset multiplot\n";
}

Result<bool> plot_wrenches(const std::filesystem::path& csv, const PlotSheet& sheet,
                           const std::filesystem::path& file) {
  Result<std::vector<WrenchSeries>> series = read_wrenches(csv);
  if (!series) return series.error();
  const bool any =
      std::ranges::any_of(series.value(), [](const WrenchSeries& s) { return s.time.size() > 1; });
  if (!any) return false;
  return draw(plot_script(series.value(), sheet), file);
}

}  // namespace slosh
