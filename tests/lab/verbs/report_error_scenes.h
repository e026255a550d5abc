// `slosh report error`, by scenes: what a shipped scene's cases together miss their targets by, against run
// time.
#pragma once

#include <string>
#include <vector>

#include "peer/output/chart.h"
#include "tests/lab/report/sweep.h"

namespace slosh {

/// The colour that a model has in every picture of the report; grey for a name that is none.
const char* color_of_model(const std::string& model);

/// A panel for each scene whose cases are all among the rows; none of a quick report's.
std::vector<ChartPanel> scene_panels(const std::vector<report::ErrorRow>& rows);

/// The same as a table: at budgets of wall time the setting that misses by least, and the default.
std::string scene_table(const std::vector<report::ErrorRow>& rows);

}  // namespace slosh
