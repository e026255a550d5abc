// Typed, checked reading of a node's custom properties.
#pragma once

#include <glm/glm.hpp>
#include <initializer_list>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sim/math/result.h"

namespace slosh::gltf {

/// What a number may be.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool above_low = false;  ///< low itself is not allowed
};
inline constexpr Range kPositive{0.0, 1e9, true};
inline constexpr Range kNotNegative{0.0, 1e9, false};
inline constexpr Range kAnyNumber{-1e9, 1e9, false};

/// Reads an `extras` object. A getter returns the fallback when the key is absent or wrong; what is wrong is
/// kept, so a caller may read everything and ask once at the end. Every key asked for is a valid key.
class Extras {
 public:
  /// `owner` begins every error: "file: node 'x'". The object must outlive this.
  Extras(const nlohmann::json& object, std::string owner) : object_(object), owner_(std::move(owner)) {}

  /// Somebody else reads it.
  void known(const char* key) { find(key); }
  bool has(const char* key) const { return object_.contains(key) && !object_[key].is_null(); }
  double number(const char* key, double fallback, Range range);
  int integer(const char* key, int fallback, int low, int high);
  bool flag(const char* key, bool fallback);  ///< true, false, 1 or 0
  std::string text(const char* key, std::string fallback);
  std::string choice(const char* key, std::string fallback, std::initializer_list<const char*> choices);
  glm::dvec3 vector(const char* key, glm::dvec3 fallback, Range each);
  std::vector<double> numbers(const char* key, std::size_t count, Range each);  ///< empty when absent
  /// 2 to 2 · `most` of them; empty when absent.
  std::vector<double> pairs(const char* key, std::size_t most, Range each);
  const nlohmann::json* object(const char* key);  ///< nullptr when absent

  /// Notes an error about `key` unless one about it is noted already: a second one would only follow from it.
  void fail(const std::string& key, std::string what, std::string mend);

  /// Everything that is wrong, last the unknown keys that look like a known one misspelt, or without its
  /// unit.
  std::vector<Error> errors() const;
  /// The other unknown keys: somebody else's. Those that begin with "_" or a capital letter, and those that
  /// exporters are known to leave, are not even told.
  std::vector<Error> foreign() const;
  /// The first of these.
  std::optional<Error> error() const;

 private:
  const nlohmann::json* find(const char* key);
  std::vector<std::string> unknown() const;
  template <class F>
  std::vector<double> list(const char* key, const std::string& mend, Range each, F&& is_long);

  const nlohmann::json& object_;
  std::string owner_;
  std::vector<std::string> known_;
  std::vector<Error> errors_;
};

/// A number for people: at most 6 digits.
std::string short_number(double value);

}  // namespace slosh::gltf
