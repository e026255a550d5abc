#include "net/text/spreadsheet.h"

#include <algorithm>
#include <iterator>

namespace slosh {
namespace {

constexpr std::string_view kDividers = ",;\t\r\n";

/// Behind any apostrophes, which are no part of what decides: one more or fewer changes nothing.
bool begins_a_formula(std::string_view text) {
  constexpr std::string_view kBeginnings[] = {"=",  "+",      "-",      "@",      "\t",
                                              "\r", "\uff1d", "\uff0b", "\uff0d", "\uff20"};
  text.remove_prefix(std::min(text.find_first_not_of('\''), text.size()));
  return std::any_of(std::begin(kBeginnings), std::end(kBeginnings),
                     [&](std::string_view beginning) { return text.starts_with(beginning); });
}

}  // namespace

std::string as_spreadsheet_text(std::string_view text) {
  std::string cell;
  for (;;) {
    if (begins_a_formula(text)) cell += '\'';
    const std::size_t divider = text.find_first_of(kDividers);
    cell += text.substr(0, divider == std::string_view::npos ? divider : divider + 1);
    if (divider == std::string_view::npos) return cell;
    text.remove_prefix(divider + 1);
  }
}

std::string from_spreadsheet_text(std::string_view cell) {
  std::string text;
  for (;;) {
    if (cell.starts_with('\'') && begins_a_formula(cell)) cell.remove_prefix(1);
    const std::size_t divider = cell.find_first_of(kDividers);
    text += cell.substr(0, divider == std::string_view::npos ? divider : divider + 1);
    if (divider == std::string_view::npos) return text;
    cell.remove_prefix(divider + 1);
  }
}

}  // namespace slosh
