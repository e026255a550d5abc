// What text on the wire may be: UTF-8 that shows as one line and cannot play tricks with a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace slosh::wire {

/// What is wrong with a text, empty when nothing is: it is not UTF-8, has control characters, characters that
/// show nothing, turn the direction of writing or are private, or more marks on a character than scripts put
/// there. net/text/clean.h has the rules; net/text/name.h has what a person's name may be besides.
std::string text_problem(std::string_view text);

/// The text with what would be refused replaced by "?" or, where it shows nothing, left out; cut at a
/// character to at most `most` bytes. What is fine comes back as it is.
std::string clean_text(std::string_view text, std::size_t most);

}  // namespace slosh::wire
