// Text that comes from elsewhere (a file, the network, another program), made fit to be shown.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace slosh {

constexpr std::size_t kMaxTextBytes = 400;  ///< of a name in a file or of a sentence, as on the wire

/// Marks (accents) that one character may carry. Scripts stack two or three; more is made to cover other
/// lines.
constexpr std::size_t kMaxMarks = 3;

/// What is wrong with a text, empty when nothing is. Refused are bytes that are not UTF-8 (overlong forms and
/// surrogates among them), control characters (C0, DEL, C1: an 0x9b begins a terminal's sequence), line and
/// paragraph separators, characters that nobody sees (of zero width, turning the direction of writing, tags,
/// variation selectors, fillers), private use, code points that are no characters, a mark with nothing to
/// stand on, and more than kMaxMarks on one character. Whether a code point is assigned yet depends on the
/// version of Unicode that a machine has, so it is no problem here: two ends of a connection may differ.
std::string text_problem(std::string_view text);

/// The text fit for one line of a terminal, cut at a character to at most `most_bytes`: what is refused above
/// is left out where it shows nothing and else becomes "?", as does what this machine's Unicode does not
/// know. What is fine comes back as it is; the result is fine, and cleaning it again changes nothing.
std::string clean_text(std::string_view foreign, std::size_t most_bytes);

/// The same for text of several lines: "\n" stays.
std::string clean_lines(std::string_view foreign, std::size_t most_bytes);

}  // namespace slosh
