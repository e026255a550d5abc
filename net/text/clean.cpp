#include "net/text/clean.h"

#include <unicode/uchar.h>
#include <unicode/utf8.h>

#include <algorithm>

namespace slosh {
namespace {

/// What becomes of a character.
enum class Fate {
  kKept,
  kMark,         ///< kept while there are few of them
  kDropped,      ///< shows nothing
  kReplaced,     ///< does something other than show
  kNotUtf8,      ///< no character
  kUnknownHere,  ///< not assigned in this machine's Unicode
};

Fate fate_of(UChar32 code) {
  if (code < 0) return Fate::kNotUtf8;
  if (u_hasBinaryProperty(code, UCHAR_DEFAULT_IGNORABLE_CODE_POINT)) return Fate::kDropped;
  switch (u_charType(code)) {
    case U_FORMAT_CHAR:
      return Fate::kDropped;
    case U_CONTROL_CHAR:
    case U_LINE_SEPARATOR:
    case U_PARAGRAPH_SEPARATOR:
    case U_PRIVATE_USE_CHAR:
    case U_SURROGATE:
      return Fate::kReplaced;
    case U_NON_SPACING_MARK:
    case U_ENCLOSING_MARK:
    case U_COMBINING_SPACING_MARK:
      return Fate::kMark;
    case U_UNASSIGNED:
      return U_IS_UNICODE_NONCHAR(code) ? Fate::kReplaced : Fate::kUnknownHere;
    default:
      return Fate::kKept;
  }
}

/// Visits every character with its place, its bytes and its fate, until `visit` returns false.
template <class Visit>
void each_character(std::string_view text, Visit&& visit) {
  const auto size = static_cast<std::int32_t>(text.size());
  for (std::int32_t at = 0; at < size;) {
    const std::int32_t from = at;
    UChar32 code = 0;
    U8_NEXT(text.data(), at, size, code);
    const Fate fate = fate_of(code);
    // A broken sequence counts byte by byte, so that where it ends does not depend on what follows.
    if (fate == Fate::kNotUtf8) at = from + 1;
    const auto place = static_cast<std::size_t>(from);
    if (!visit(place, text.substr(place, static_cast<std::size_t>(at - from)), fate)) return;
  }
}

}  // namespace

std::string text_problem(std::string_view text) {
  std::string problem;
  std::size_t marks = kMaxMarks;  // nothing to stand on yet
  each_character(text, [&](std::size_t at, std::string_view, Fate fate) {
    marks = fate == Fate::kMark ? marks + 1 : 0;
    const char* what = nullptr;
    if (fate == Fate::kNotUtf8) what = "is not UTF-8";
    if (fate == Fate::kReplaced) what = "has a control character";
    if (fate == Fate::kDropped) what = "has an invisible character";
    if (marks > kMaxMarks) what = at == 0 ? "has a mark on nothing" : "has too many marks on a character";
    if (what) problem = std::string(what) + " at byte " + std::to_string(at);
    return !what;
  });
  return problem;
}

std::string clean_text(std::string_view foreign, std::size_t most_bytes) {
  std::string out;
  std::size_t marks = kMaxMarks;
  // No character needs more than this many bytes of what is left out for one that is kept: nobody may make
  // this walk through megabytes that show nothing.
  const std::string_view looked_at = foreign.substr(0, 64 + 16 * std::min(most_bytes, foreign.size()));
  each_character(looked_at, [&](std::size_t, std::string_view bytes, Fate fate) {
    if (fate == Fate::kDropped) return true;
    if (fate == Fate::kMark && marks >= kMaxMarks) return true;
    const bool kept = fate == Fate::kKept || fate == Fate::kMark;
    const std::string_view piece = kept ? bytes : std::string_view("?");
    if (out.size() + piece.size() > most_bytes) return false;
    marks = fate == Fate::kMark ? marks + 1 : 0;
    out += piece;
    return true;
  });
  return out;
}

std::string clean_lines(std::string_view foreign, std::size_t most_bytes) {
  std::string out;
  for (;;) {
    const std::size_t end = foreign.find('\n');
    out += clean_text(foreign.substr(0, end), most_bytes - out.size());
    if (end == std::string_view::npos || out.size() >= most_bytes) return out;
    out += '\n';
    foreign.remove_prefix(end + 1);
  }
}

}  // namespace slosh
