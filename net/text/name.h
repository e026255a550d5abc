// Names that people give themselves: what one may be, and when two of them look alike.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace slosh {

constexpr std::size_t kMaxNameBytes = 32;  ///< of a person's name, UTF-8

/// The nearest name to what was asked for that others may be shown: letters, digits and marks of any script,
/// and between them single spaces, "-", "'", "." and "_"; pictographs too. Compatibility forms (full
/// width, mathematical) become plain letters (NFKC), so that what is shown can be typed. It ends before the
/// first word that notices are made of ("is", "has", "left" …, also disguised), so that no name reads like
/// one: "Ana has left" becomes "Ana". At most kMaxNameBytes. Empty when nothing is left: then choose one.
/// A cleaned name comes back as it is.
std::string clean_name(std::string_view foreign);

/// What a name looks like: two names that a person may take for each other have the same skeleton, whatever
/// letters they are made of (Unicode's list of confusable characters, UTS 39; then without regard to case,
/// accents, spaces and punctuation, and to what a font may draw alike: 0 and O, 1, l, I and i). For comparing
/// only. Empty for an empty name, never for another.
std::string name_skeleton(std::string_view name);

}  // namespace slosh
