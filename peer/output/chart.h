// Charts of a report: curves and marks on axes, and a map of coloured tiles.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh {

struct ChartSeries {
  std::string name;                ///< in the legend; empty: not there
  std::string color = "#303030";   ///< "#rrggbb"
  std::vector<glm::dvec2> points;  ///< on logarithmic axes only what is above 0 is drawn
  int mark = 7;                    ///< gnuplot's point type; 0: none
  double size = 1.0;               ///< of the mark
  double width = 0.0;              ///< of the line; 0: none
  bool dashed = false;
};

/// A named stretch of the horizontal axis, a phase of a motion for one.
struct ChartSpan {
  std::string name;
  double from = 0.0, to = 0.0;
};

struct ChartPanel {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<ChartSeries> series;
  bool legend = true;
  std::vector<ChartSpan> spans = {};  ///< in order; every second one is shaded
  bool key_alone = false;    ///< no axes: the series' names and looks alone, their points do not matter
  bool y_from_zero = false;  ///< of an axis that is not logarithmic, however far above it all values are
};

/// A complete gnuplot script, data included, that writes a picture ("png", "svg" or "pdf"): panels in rows of
/// `columns`, under one title; `corner` small at the bottom right.
std::string chart_script(const std::vector<ChartPanel>& panels, int columns, const std::string& title,
                         const std::string& picture = "png", const std::string& corner = "");

/// A map: one coloured tile a row and column. `kind[row][column]` is an index into `kinds`, or −1 for none.
struct TileMap {
  struct Kind {
    std::string name, color;
  };
  std::string title, subtitle;
  std::vector<std::string> rows, columns;
  std::vector<Kind> kinds;
  std::vector<std::vector<int>> kind;
  std::vector<std::vector<std::string>> text;  ///< on the tiles, as `kind`; short
};

/// As chart_script.
std::string tile_script(const TileMap& map);

}  // namespace slosh
