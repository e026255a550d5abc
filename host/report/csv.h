// Fields of the reports' tables.
#pragma once

#include <string>

namespace slosh::report {

/// A text as one field of a CSV: without separators, quotes or ends of lines.
inline std::string csv_field(std::string text) {
  for (char& c : text) {
    if (c == ',' || c == '\n' || c == '\r' || c == '"') c = ';';
  }
  return text;
}

}  // namespace slosh::report
