// What `slosh report speed` draws and says of its rows.
#pragma once

#include <string>
#include <vector>

#include "peer/output/chart.h"
#include "tests/lab/report/speed.h"

namespace slosh {

/// The paper's Figures 6a, 6b and 6c, a curve a device.
std::vector<ChartPanel> figure_six(const report::SpeedRows& rows);
/// Three panels a device: each pass's share of a step over 6a's sizes and over 6c's spheres, and the heavy
/// passes of the largest pool below the ceilings.
std::vector<ChartPanel> pass_panels(const report::SpeedRows& rows);
/// The paper's Table 1 with a row of ours, in Markdown.
std::string table_one(const report::SpeedRows& rows);

}  // namespace slosh
