#include "scenes/gltf/extras.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "net/text/nearest.h"

namespace slosh::gltf {
namespace {

constexpr const char* kExporterKeys[] = {"targetNames", "glTF2ExportSettings"};

std::string shown(const nlohmann::json& value) {
  std::string text = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

/// Words that are units at a field's end.
bool is_unit(const std::string& word) {
  constexpr const char* kUnits[] = {"m", "s",  "s2", "m2",  "m3",  "kg",  "kg2", "g", "cm", "cm3",  "mm",
                                    "n", "nm", "pa", "mpa", "rad", "per", "deg", "l", "ml", "mpas", "cp"};
  return std::find(std::begin(kUnits), std::end(kUnits), word) != std::end(kUnits);
}

/// A field without its units, in small letters: "mass" of "mass_kg", "angular_velocity" of
/// "angular_velocity_rad_s".
std::string stem_of(const std::string& key) {
  std::string stem;
  for (const char c : key)
    stem += static_cast<char>(c == '-' || c == ' ' ? '_' : std::tolower(static_cast<unsigned char>(c)));
  for (std::size_t at = stem.rfind('_'); at != std::string::npos && at > 0; at = stem.rfind('_')) {
    if (!is_unit(stem.substr(at + 1))) break;
    stem.erase(at);
  }
  return stem;
}

/// The field that was meant by a word that is none: near to one, or one with other units or none. Who
/// misspells begins right: "uuid" is no "fluid". Empty: somebody else's word.
std::string meant_field(const std::string& key, const std::vector<std::string>& known) {
  const std::string stem = stem_of(key);
  std::vector<std::string> fields, stems;
  for (const std::string& field : known) {
    if (field[0] != stem[0]) continue;
    fields.push_back(field);
    stems.push_back(stem_of(field));
  }
  const std::string near = nearest_word(key, fields);
  if (!near.empty()) return near;
  const std::string meant = nearest_word(stem, stems);
  const auto found = std::find(stems.begin(), stems.end(), meant);
  return meant.empty() ? meant : fields[static_cast<std::size_t>(found - stems.begin())];
}

std::string range_text(const Range& range) {
  const std::string high = short_number(range.high);
  if (range.low == 0.0 && range.above_low) return "a number above 0, at most " + high;
  return "a number from " + short_number(range.low) + " to " + high +
         (range.above_low ? " (not " + short_number(range.low) + " itself)" : "");
}

bool in_range(double value, const Range& range) {
  return std::isfinite(value) && (range.above_low ? value > range.low : value >= range.low) &&
         value <= range.high;
}

}  // namespace

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

void Extras::fail(const std::string& key, std::string what, std::string mend) {
  const std::string where = owner_ + ": extras." + key;
  for (const Error& error : errors_)
    if (error.where == where) return;
  errors_.push_back({where, std::move(what), std::move(mend)});
}

const nlohmann::json* Extras::find(const char* key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.emplace_back(key);
  return has(key) ? &object_[key] : nullptr;
}

double Extras::number(const char* key, double fallback, Range range) {
  const nlohmann::json* value = find(key);
  if (!value) return fallback;
  if (!value->is_number()) {
    fail(key, "is " + shown(*value) + ", not a number", "Give " + range_text(range));
    return fallback;
  }
  const double number = value->get<double>();
  if (in_range(number, range)) return number;
  fail(key, "is " + short_number(number), "Give " + range_text(range));
  return fallback;
}

int Extras::integer(const char* key, int fallback, int low, int high) {
  const double value = number(key, fallback, {static_cast<double>(low), static_cast<double>(high), false});
  if (value == std::floor(value)) return static_cast<int>(value);
  fail(key, "is " + short_number(value) + ", not a whole number", "Give a whole number");
  return fallback;
}

bool Extras::flag(const char* key, bool fallback) {
  const nlohmann::json* value = find(key);
  if (!value) return fallback;
  if (value->is_boolean()) return value->get<bool>();
  if (value->is_number() && (*value == 0 || *value == 1)) return *value == 1;
  fail(key, "is " + shown(*value) + ", neither true nor false", "Give true or false (or 1 or 0)");
  return fallback;
}

std::string Extras::text(const char* key, std::string fallback) {
  const nlohmann::json* value = find(key);
  if (!value) return fallback;
  if (value->is_string()) return value->get<std::string>();
  fail(key, "is " + shown(*value) + ", not a text", "Give a text");
  return fallback;
}

std::string Extras::choice(const char* key, std::string fallback,
                           std::initializer_list<const char*> choices) {
  std::string value = text(key, fallback);
  if (!has(key) || std::find(choices.begin(), choices.end(), value) != choices.end()) return value;
  std::string list;
  for (const char* choice : choices) list += (list.empty() ? "" : ", ") + std::string(choice);
  fail(key, "is \"" + value + "\"", "Give one of: " + list);
  return fallback;
}

std::vector<double> Extras::numbers(const char* key, std::size_t count, Range each) {
  return list(key, "Give a list of " + std::to_string(count) + " numbers, each " + range_text(each), each,
              [count](std::size_t size) { return size == count; });
}

std::vector<double> Extras::pairs(const char* key, std::size_t most, Range each) {
  return list(key,
              "Give a list of 1 to " + std::to_string(most) + " pairs of numbers, each " + range_text(each),
              each, [most](std::size_t size) { return size > 0 && size % 2 == 0 && size <= 2 * most; });
}

template <class F>
std::vector<double> Extras::list(const char* key, const std::string& mend, Range each, F&& is_long) {
  const nlohmann::json* value = find(key);
  if (!value) return {};
  if (!value->is_array() || !is_long(value->size())) {
    fail(key, "is " + shown(*value), mend);
    return {};
  }
  std::vector<double> out;
  for (const nlohmann::json& item : *value) {
    if (!item.is_number() || !in_range(item.get<double>(), each)) {
      fail(key, "holds " + shown(item), mend);
      return {};
    }
    out.push_back(item.get<double>());
  }
  return out;
}

glm::dvec3 Extras::vector(const char* key, glm::dvec3 fallback, Range each) {
  const std::vector<double> values = numbers(key, 3, each);
  return values.empty() ? fallback : glm::dvec3(values[0], values[1], values[2]);
}

const nlohmann::json* Extras::object(const char* key) {
  const nlohmann::json* value = find(key);
  if (!value || value->is_object()) return value;
  fail(key, "is " + shown(*value) + ", not a group of properties", "Give a group of named properties");
  return nullptr;
}

std::vector<std::string> Extras::unknown() const {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object_.items()) {
    if (key.empty() || key[0] == '_' || std::isupper(static_cast<unsigned char>(key[0]))) continue;
    if (std::find(std::begin(kExporterKeys), std::end(kExporterKeys), key) != std::end(kExporterKeys))
      continue;
    if (std::find(known_.begin(), known_.end(), key) == known_.end()) keys.push_back(key);
  }
  return keys;
}

std::vector<Error> Extras::errors() const {
  std::vector<Error> all = errors_;
  std::string list;
  for (const std::string& known : known_) list += (list.empty() ? "" : ", ") + known;
  for (const std::string& key : unknown()) {
    const std::string meant = meant_field(key, known_);
    if (meant.empty()) continue;
    all.push_back({owner_ + ": extras." + key, "is not a property that is known here",
                   "Did you mean " + meant + "? Use one of: " + list +
                       "; or begin the name with _ to have it ignored"});
  }
  return all;
}

std::vector<Error> Extras::foreign() const {
  std::vector<Error> all;
  for (const std::string& key : unknown()) {
    if (!meant_field(key, known_).empty()) continue;
    all.push_back({owner_ + ": extras." + key,
                   "is a custom property that slosh does not know, and is not read",
                   "Begin its name with _ if it is yours; scenes/FIELDS.md lists the known ones"});
  }
  return all;
}

std::optional<Error> Extras::error() const {
  const std::vector<Error> all = errors();
  return all.empty() ? std::nullopt : std::optional(all.front());
}

}  // namespace slosh::gltf
