#include "peer/output/field_words.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace slosh {
namespace {

// What ends another stands before it.
constexpr std::array<std::pair<std::string_view, const char*>, 21> kUnits{{
    {"_nm_s_rad", "N\xC2\xB7m\xC2\xB7s/rad"},
    {"_nm_rad", "N\xC2\xB7m/rad"},
    {"_n_s_m", "N\xC2\xB7s/m"},
    {"_rad_s", "rad/s"},
    {"_kg_m3", "kg/m\xC2\xB3"},
    {"_kg_m2", "kg\xC2\xB7m\xC2\xB2"},
    {"_m2_s2", "m\xC2\xB2/s\xC2\xB2"},
    {"_pa_s", "Pa\xC2\xB7s"},
    {"_m_s2", "m/s\xC2\xB2"},
    {"_per_m", "1/m"},
    {"_n_m", "N/m"},
    {"_m_s", "m/s"},
    {"_deg", "\xC2\xB0"},
    {"_hz", "Hz"},
    {"_kg", "kg"},
    {"_mm", "mm"},
    {"_nm", "N\xC2\xB7m"},
    {"_pa", "Pa"},
    {"_n", "N"},
    {"_m", "m"},
    {"_s", "s"},
}};

}  // namespace

std::string field_in_words(const std::string& field, const std::string& value) {
  for (const auto& [ending, unit] : kUnits) {
    if (!field.ends_with(ending) || field.size() == ending.size()) continue;
    std::string name = field.substr(0, field.size() - ending.size());
    std::replace(name.begin(), name.end(), '_', ' ');
    return name + " = " + value + " " + unit;
  }
  return field + " = " + value;
}

}  // namespace slosh
