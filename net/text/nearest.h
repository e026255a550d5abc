// Which of the words that are known was meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace slosh {

/// The word of `known` that is the fewest edits away from `word` (a letter changed, put in, left out, or two
/// neighbours swapped; capitals, and "-" for "_", count for nothing), the first of equals. Empty where even
/// that takes more than a third of its letters, but two at least (one of less than five), or as many as
/// `word` has.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

/// "Did you mean bucket? ", to stand before what else there is to say; empty where no word is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& known);

}  // namespace slosh
