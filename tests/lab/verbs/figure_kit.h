// Readings of a scripted run for the paper's figures: means and peaks of phases, strokes of a hand, curves.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/lab/verbs/figures.h"

namespace slosh::figure {

/// What of a wrench is read.
using Reading = std::function<double(const Wrench&)>;

/// The largest |reading| of a phase and when it was.
struct Peak {
  double value = 0.0;  // its size
  double time = 0.0;   // s
};
/// Mean reading of a phase; 0 where it has no sample.
double mean(const WrenchSeries& s, const Phase& phase, const Reading& of);
Peak peak(const WrenchSeries& s, const Phase& phase, const Reading& of);
/// N and N·m.
double force_size(const Wrench& w);
double torque_size(const Wrench& w);
/// A reading over time; `color` of the palette.
ChartSeries curve(const std::string& name, const WrenchSeries& s, const Reading& of, std::size_t color,
                  bool dashed = false);
/// Phases as spans of the panel.
void mark_phases(ChartPanel& panel, const std::vector<Phase>& phases);
ChartPanel panel_of(const std::string& title, const std::string& y_label);
/// Of a handle, m/s and rad/s, a value a sample; the first is 0.
std::vector<glm::dvec3> velocities(const ScriptedRun& run, std::size_t hand);
std::vector<double> turning(const ScriptedRun& run, std::size_t hand);
/// What a hand felt, with their torque about the centre of mass of what is held, in place of the handle.
WrenchSeries about_centers(const ScriptedRun& run, std::size_t hand);
/// The axis, 0–2, along which the values range widest.
std::size_t liveliest(const std::vector<glm::dvec3>& values);
/// Stretches of one sign of a speed that is above a twentieth of its largest.
std::vector<Phase> strokes(const std::vector<double>& time, const std::vector<double>& speed);

}  // namespace slosh::figure
