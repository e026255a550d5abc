// wrenches.csv to wrenches.png: force above, torque below, one colour a device (the paper's Figs 8–11).
#pragma once

#include <filesystem>
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

/// The same run in at most `rows` points a device, each the mean of the samples it stands for.
WrenchSeries thinned(const WrenchSeries& series, std::size_t rows);

/// A complete gnuplot script, data included, that writes a PNG to its standard output. Bold: magnitudes;
/// thin: the component along the world axis on which it varies most. `names` labels the devices; names and
/// title come from strangers: they are cleaned and cut, and no character of them is in the script.
std::string plot_script(const std::vector<WrenchSeries>& series, const std::vector<std::string>& names,
                        const std::string& title);

/// All of the above. False when there is nothing to plot. Errors: gnuplot is missing or failed, `png` cannot
/// be written.
Result<bool> plot_wrenches(const std::filesystem::path& csv, const std::vector<std::string>& names,
                           const std::string& title, const std::filesystem::path& png);

}  // namespace slosh
