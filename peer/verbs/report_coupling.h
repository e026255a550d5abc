// The parts of `slosh report coupling` besides its maps.
#pragma once

#include <filesystem>

#include "peer/output/progress.h"
#include "peer/verbs/report.h"

namespace slosh {

/// Rendered against commanded impedance, 0.1 to 30 Hz, by scheme and round trip: transparency.csv and .png.
/// Errors: a file cannot be written or drawn.
Result<bool> report_transparency(const ReportOptions& options, const std::filesystem::path& folder,
                                 Progress& progress);
/// Force in a syrup with and without the host's model of it, by the host's rate: spectrum.csv and .png.
/// Errors: as above.
Result<bool> report_spectra(const ReportOptions& options, const std::filesystem::path& folder,
                            Progress& progress);

}  // namespace slosh
