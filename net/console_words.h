// What is typed at a host and what is typed at a peer have in common: words, quotes, names, `set`.
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/scene.h"
#include "sim/math/result.h"

namespace slosh {

constexpr std::size_t kMaxConsoleLine = 1000;  ///< bytes

/// The words of a line; quotes, single or double, keep a name of several words together. Any bytes may come.
/// Errors: too long, or text that cannot be shown.
Result<std::vector<std::string>> console_words(std::string_view typed);

/// `set viscosity [FLUID] X`, `set gravity X` or `set stiffness [GRIP] X`.
struct SetWish {
  enum class What : std::uint8_t { kViscosity, kGravity, kStiffness } what = What::kViscosity;
  std::string which;   ///< fluid or grip, name or number; empty = not said
  double value = 0.0;  ///< Pa·s, or times the scene's; finite, ≥ 0
};
/// `words` begin with "set". Errors say what was expected.
Result<SetWish> parse_set(const std::vector<std::string>& words);

/// The index of what is called `text`, or of the number that `text` is; nothing when there is no such thing.
template <class T>
std::optional<std::size_t> index_named(const std::vector<T>& things, const std::string& text) {
  for (std::size_t i = 0; i < things.size(); ++i) {
    if (things[i].name == text) return i;
  }
  std::size_t number = 0;
  const char* end = text.data() + text.size();
  const auto [at, code] = std::from_chars(text.data(), end, number);
  if (code != std::errc() || at != end || number >= things.size()) return std::nullopt;
  return number;
}

inline const std::string& name_of(const std::string& name) {
  return name;
}
template <class T>
const std::string& name_of(const T& thing) {
  return thing.name;
}

/// "left, right", or "none". Of names, or of what has a `name`.
template <class T>
std::string names_of(const std::vector<T>& things) {
  std::string names;
  for (const T& thing : things) names.append(names.empty() ? "" : ", ").append(name_of(thing));
  return names.empty() ? "none" : names;
}

/// What to say of a grip that does not exist, wherever somebody asks for one.
template <class T>
std::string no_grip_text(const std::string& text, const std::vector<T>& grips) {
  return "there is no grip '" + text + "'. There are: " + names_of(grips);
}

/// The same of what may come and go (scenes/scene.h, thing_name).
inline std::string no_thing_text(const std::string& text, const Scene& scene) {
  std::vector<std::string> names;
  for (std::size_t thing = 0; thing < thing_count(scene); ++thing) names.push_back(thing_name(scene, thing));
  return "there is no body or fluid '" + text + "'. There are: " + names_of(names);
}

/// Which fluid or grip a SetWish means: the one it names, or the only one there is.
template <class T>
std::optional<std::size_t> one_meant(const std::vector<T>& things, const std::string& text) {
  if (!text.empty()) return index_named(things, text);
  return things.size() == 1 ? std::optional<std::size_t>(0) : std::nullopt;
}

}  // namespace slosh
