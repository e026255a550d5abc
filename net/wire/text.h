// What text on the wire may be: UTF-8 that shows as one line and cannot play tricks with a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace slosh::wire {

/// What is wrong with a text, empty when nothing is. Refused are bytes that are not UTF-8 (overlong forms and
/// surrogates among them), control characters (C0, DEL, C1), line and paragraph separators, and the marks
/// that turn the direction of writing, with which one name could be made to look like another.
std::string text_problem(std::string_view text);

/// The text with every byte or character that would be refused replaced by "?", cut at a character to at most
/// `most` bytes. What is fine comes back as it is.
std::string clean_text(std::string_view text, std::size_t most);

}  // namespace slosh::wire
