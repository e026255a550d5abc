#include "tests/lab/verbs/figure_kit.h"

#include <algorithm>
#include <cmath>

#include "peer/view/palette.h"
#include "sim/math/format.h"

namespace slosh::figure {

double mean(const WrenchSeries& s, const Phase& phase, const Reading& of) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < s.time.size(); ++i) {
    if (s.time[i] < phase.from || s.time[i] > phase.to) continue;
    sum += of(s.on_hand[i]);
    count += 1;
  }
  return count > 0 ? sum / count : 0.0;
}

Peak peak(const WrenchSeries& s, const Phase& phase, const Reading& of) {
  Peak found;
  for (std::size_t i = 0; i < s.time.size(); ++i) {
    if (s.time[i] < phase.from || s.time[i] > phase.to) continue;
    const double size = std::abs(of(s.on_hand[i]));
    if (size > found.value) found = {size, s.time[i]};
  }
  return found;
}

double force_size(const Wrench& w) {
  return glm::length(w.force);
}
double torque_size(const Wrench& w) {
  return glm::length(w.torque);
}

ChartSeries curve(const std::string& name, const WrenchSeries& s, const Reading& of, std::size_t color,
                  bool dashed) {
  ChartSeries series;
  series.name = name;
  series.color = device_color(color).hex;
  series.mark = 0;
  series.width = dashed ? 1.4 : 1.8;
  series.dashed = dashed;
  for (std::size_t i = 0; i < s.time.size(); ++i) series.points.emplace_back(s.time[i], of(s.on_hand[i]));
  return series;
}

void mark_phases(ChartPanel& panel, const std::vector<Phase>& phases) {
  // What there is room for above many of them.
  const auto shown = [&](const std::string& name) {
    if (phases.size() <= 5) return name;
    return name == "forward"    ? std::string("\xE2\x86\x92")
           : name == "backward" ? std::string("\xE2\x86\x90")
                                : name;
  };
  for (const Phase& phase : phases)
    if (phase.to > phase.from) panel.spans.push_back({shown(phase.name), phase.from, phase.to});
}

ChartPanel panel_of(const std::string& title, const std::string& y_label) {
  ChartPanel panel;
  panel.title = title;
  panel.x_label = "time, s";
  panel.y_label = y_label;
  return panel;
}

std::vector<glm::dvec3> velocities(const ScriptedRun& run, std::size_t hand) {
  std::vector<glm::dvec3> out(run.poses[hand].size(), glm::dvec3(0.0));
  for (std::size_t i = 1; i < out.size(); ++i) {
    out[i] = (run.poses[hand][i].position - run.poses[hand][i - 1].position) /
             (run.hands[hand].time[i] - run.hands[hand].time[i - 1]);
  }
  return out;
}

std::vector<double> turning(const ScriptedRun& run, std::size_t hand) {
  std::vector<double> out(run.poses[hand].size(), 0.0);
  for (std::size_t i = 1; i < out.size(); ++i) {
    out[i] =
        glm::length(rotation_between(run.poses[hand][i - 1].orientation, run.poses[hand][i].orientation)) /
        (run.hands[hand].time[i] - run.hands[hand].time[i - 1]);
  }
  return out;
}

WrenchSeries about_centers(const ScriptedRun& run, std::size_t hand) {
  WrenchSeries out = run.hands[hand];
  for (std::size_t i = 0; i < out.on_hand.size(); ++i) {
    const glm::dvec3 arm = run.poses[hand][i].position - run.centers[hand][i];
    out.on_hand[i].torque += glm::cross(arm, out.on_hand[i].force);
  }
  return out;
}

std::size_t liveliest(const std::vector<glm::dvec3>& values) {
  glm::dvec3 low(1e300), high(-1e300);
  for (const glm::dvec3& v : values) {
    low = glm::min(low, v);
    high = glm::max(high, v);
  }
  const glm::dvec3 range = high - low;
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (range[static_cast<int>(i)] > range[static_cast<int>(axis)]) axis = i;
  return axis;
}

std::vector<Phase> strokes(const std::vector<double>& time, const std::vector<double>& speed) {
  double fastest = 0.0;
  for (const double v : speed) fastest = std::max(fastest, std::abs(v));
  std::vector<Phase> out;
  int sign = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const int now = std::abs(speed[i]) < 0.05 * fastest ? 0 : speed[i] > 0.0 ? 1 : -1;
    if (now != sign) {
      if (sign != 0) out.back().to = time[i];
      if (now != 0) out.push_back({now > 0 ? "forward" : "backward", time[i], time.back()});
      sign = now;
    }
  }
  return out;
}

}  // namespace slosh::figure
