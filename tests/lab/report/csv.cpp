#include "tests/lab/report/csv.h"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "net/text/spreadsheet.h"

namespace slosh::report {
namespace {

/// The texts that csv_field was given, as far as it kept them.
Fields fields_of(const std::string& line) {
  Fields fields;
  std::istringstream cells(line + ',');
  for (std::string cell; std::getline(cells, cell, ',');) fields.push_back(from_spreadsheet_text(cell));
  return fields;
}

}  // namespace

std::string csv_field(std::string text) {
  for (char& c : text) {
    if (c == ',' || c == '\n' || c == '\r' || c == '"') c = ';';
  }
  return as_spreadsheet_text(text);
}

Result<bool> read_rows(const std::filesystem::path& file, const std::string& header, const std::string& kind,
                       const std::function<void(const Fields&)>& take) {
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line) || line != header) {
    return Error{file.string(), "cannot be read as the rows of a report",
                 "Give a table that `slosh report " + kind + "` wrote"};
  }
  const std::size_t count = fields_of(header).size();
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    const Fields fields = fields_of(line);
    try {
      if (fields.size() != count) throw std::invalid_argument("fields");
      take(fields);
    } catch (const std::exception&) {
      return Error{file.string() + ": line " + std::to_string(number), "is not a row of a report",
                   "Remove the line; a run that was ended may have cut the last one short"};
    }
  }
  return true;
}

}  // namespace slosh::report
