// wrenches.csv to a sheet of curves: forces above, torques below, one colour a device (the paper's Figs
// 8–11).
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "sim/math/pose.h"
#include "sim/math/result.h"

namespace slosh {

/// One device's felt wrenches over time.
struct WrenchSeries {
  std::vector<double> time;  ///< s
  std::vector<Wrench> on_hand;
};

/// Reads a wrenches.csv, one series a device. Errors: it cannot be read, a row that is not eight numbers.
Result<std::vector<WrenchSeries>> read_wrenches(const std::filesystem::path& file);

/// The same curve (s, value) in about `points` points: of each stretch the least and the largest sample, so
/// that no peak is lost. One that has no more points stays as it is.
std::vector<glm::dvec2> thinned(const std::vector<glm::dvec2>& curve, std::size_t points);

/// What a sheet of curves says and shows beside the data.
struct PlotSheet {
  std::vector<std::string> names;       ///< a device each; where one is missing, its number
  std::string title;                    ///< may come from strangers, as the names may: cleaned and cut
  std::vector<std::string> parameters;  ///< lines under the title: what was simulated, with units
  /// What is drawn, a panel each, top to bottom: of plot_quantities(). Empty: the magnitudes of force and
  /// torque, each followed by the component along the world axis on which it varies most.
  std::vector<std::string> quantities;
  std::string format = "png";  ///< of plot_formats()
};

/// "force", "fx", "fy", "fz", "torque", "tx", "ty", "tz"; "png", "svg", "pdf".
const std::vector<std::string>& plot_quantities();
const std::vector<std::string>& plot_formats();

/// A complete gnuplot script, data included, that writes the picture to its standard output: a panel a
/// quantity over one axis of time, each fitted to its data; devices by colour and, where they lie on each
/// other, by dashes. No character of a name or title is in the script.
std::string plot_script(const std::vector<WrenchSeries>& series, const PlotSheet& sheet);

/// All of the above. False when there is nothing to plot. Errors: gnuplot is missing or failed, `file` cannot
/// be written.
Result<bool> plot_wrenches(const std::filesystem::path& csv, const PlotSheet& sheet,
                           const std::filesystem::path& file);

}  // namespace slosh
