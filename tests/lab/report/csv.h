// The reports' tables: fields written, rows read back.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh::report {

/// A text as one field of a CSV: without separators, quotes or ends of lines, and no formula
/// (net/text/spreadsheet.h).
std::string csv_field(std::string text);

using Fields = std::vector<std::string>;

/// Calls `take` for every line behind the header, with as many fields as the header has; what it throws says
/// that the line is no row. `kind`: of report, "error". Errors: it cannot be read, another header, a line
/// that is no row.
Result<bool> read_rows(const std::filesystem::path& file, const std::string& header, const std::string& kind,
                       const std::function<void(const Fields&)>& take);

}  // namespace slosh::report
