// Text from elsewhere as a cell of a table that somebody may open in a spreadsheet, which runs formulas.
#pragma once

#include <string>
#include <string_view>

namespace slosh {

/// The text with an apostrophe in front where a spreadsheet would take it for a formula: where it begins with
/// =, +, -, @, one of their full-width forms, a tab or a carriage return, behind any apostrophes. Likewise
/// behind each comma, semicolon and tab, and on each line: where a comma divides decimals, a semicolon
/// divides cells. An apostrophe is a spreadsheet's own mark for text. For names and sentences; numbers are
/// written as they are. Source: OWASP, "CSV Injection".
std::string as_spreadsheet_text(std::string_view text);

/// The text again that as_spreadsheet_text was given.
std::string from_spreadsheet_text(std::string_view cell);

}  // namespace slosh
