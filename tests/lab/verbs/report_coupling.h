// The parts of `slosh report coupling` besides its maps.
#pragma once

#include <filesystem>
#include <vector>

#include "peer/output/chart.h"
#include "peer/output/progress.h"
#include "tests/lab/coupling/cells.h"
#include "tests/lab/verbs/report.h"

namespace slosh {

/// A handful of cases over QUIC between network namespaces, in place of virtual time: coupling_link.csv.
int report_coupling_link(const ReportOptions& options);

/// One hand on the shipped bucket's real water, in virtual time: how far off its force is by way of the hand
/// and round trip, and what the repeatability between two runs and the best models leave: coupling_water.csv
/// and .png.
int report_coupling_water(const ReportOptions& options);

/// coupling::bucket_cases() by the replica: bucket.csv, and `map` for its picture. `run` as for the other
/// cells; interrupted it has those that are there. Errors: the shipped scene is not there, the file cannot be
/// written.
Result<bool> report_bucket(const std::filesystem::path& folder, const coupling::CellRun& run,
                           const std::string& machine, TileMap& map);
/// Rendered against commanded impedance, 0.1 to 30 Hz, by scheme and round trip: transparency.csv, and
/// `panels` for its picture. On options.threads threads; interrupted it writes nothing and gives no panels.
/// Errors: the file cannot be written.
Result<bool> report_transparency(const ReportOptions& options, const std::filesystem::path& folder,
                                 Progress& progress, std::vector<ChartPanel>& panels);
/// Force in a syrup with and without the host's model of it, by the host's rate: spectrum.csv. As above.
Result<bool> report_spectra(const ReportOptions& options, const std::filesystem::path& folder,
                            Progress& progress, std::vector<ChartPanel>& panels);

}  // namespace slosh
