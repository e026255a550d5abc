// What of a fluid warms, thickens and sets.
#include <algorithm>
#include <cmath>

#include "scenes/reading/reading.h"

namespace slosh::reading {
namespace {

using gltf::Extras;
using gltf::Range;

constexpr Range kSeconds{0.0, 86400.0, true};
constexpr Range kViscosities{0.0, 1e7, true};

/// Pa·s at `temperature`, °C, by pairs of °C and Pa·s.
double viscosity_at(const std::vector<double>& pairs, double temperature) {
  if (temperature <= pairs[0]) return pairs[1];
  for (std::size_t i = 2; i < pairs.size(); i += 2) {
    if (temperature > pairs[i]) continue;
    const double share = (temperature - pairs[i - 2]) / (pairs[i] - pairs[i - 2]);
    return std::exp(std::lerp(std::log(pairs[i - 1]), std::log(pairs[i + 1]), share));
  }
  return pairs.back();
}

void read_viscosities(Extras& extras, Fluid& fluid) {
  const char* const key = "viscosity_at_c";
  const std::vector<double> pairs = extras.pairs(key, kMaxViscosityPoints, Range{kColdest, 1e7});
  if (pairs.empty()) return;
  const std::string mend = "Give pairs of °C, rising, and Pa·s above 0, such as [20, 1.5, 60, 0.2]";
  if (extras.has("viscosity_pa_s"))
    return extras.fail("viscosity_pa_s", "is given together with viscosity_at_c", "Keep one of the two");
  for (std::size_t i = 0; i < pairs.size(); i += 2) {
    if (i > 0 && !(pairs[i] > pairs[i - 2]))
      return extras.fail(key, "has temperatures that do not rise", mend);
    if (pairs[i] > kHottest || !(pairs[i + 1] > 0.0))
      return extras.fail(
          key, "has " + gltf::short_number(pairs[i + 1]) + " Pa·s at " + gltf::short_number(pairs[i]) + " °C",
          mend);
  }
  fluid.dynamic_viscosity = viscosity_at(pairs, fluid.heat.temperature);
  for (std::size_t i = 0; i < pairs.size(); i += 2)
    fluid.heat.viscosity.push_back({pairs[i], pairs[i + 1] / fluid.dynamic_viscosity});
}

/// `when`: one of the temperatures says where it happens.
void read_time(Extras& extras, const char* key, bool when, const char* of, double& seconds) {
  seconds = extras.number(key, 0.0, kSeconds);
  if (when == extras.has(key)) return;
  if (when)
    extras.fail(key, std::string("is missing beside ") + of, "Say within how many seconds, for example 5");
  else
    extras.fail(key, std::string("is given without ") + of,
                std::string("Give ") + of + " in °C, or leave it out");
}

}  // namespace

void read_heat(Extras& extras, Fluid& fluid) {
  Heat& heat = fluid.heat;
  heat.temperature = extras.number("temperature_c", heat.temperature, kTemperatures);
  heat.capacity = extras.number("heat_capacity_j_kg_k", heat.capacity, Range{1.0, 1e5});
  heat.conductivity = extras.number("conductivity_w_m_k", heat.conductivity, Range{0.0, 1e4});
  read_viscosities(extras, fluid);
  heat.sets_above = extras.number("sets_above_c", heat.sets_above, kTemperatures);
  heat.sets_below = extras.number("sets_below_c", heat.sets_below, kTemperatures);
  heat.melts_above = extras.number("melts_above_c", heat.melts_above, kTemperatures);
  const bool sets = extras.has("sets_above_c") || extras.has("sets_below_c");
  const bool melts = extras.has("melts_above_c");
  read_time(extras, "sets_in_s", sets, "sets_above_c or sets_below_c", heat.sets_in);
  read_time(extras, "melts_in_s", melts, "melts_above_c", heat.melts_in);
  heat.starts_set = extras.flag("starts_set", false);
  if (heat.starts_set && !melts)
    extras.fail("starts_set", "is true for a fluid that never melts",
                "Give melts_above_c and melts_in_s, too");
  heat.modulus = extras.number("set_modulus_pa", 0.0, Range{0.0, 1e9, true});
  heat.tears_at = extras.number("tears_at", heat.tears_at, Range{0.0, 10.0, true});
  if (!sets && !melts && extras.has("set_modulus_pa"))
    extras.fail("set_modulus_pa", "is given for a fluid that does not set",
                "Give sets_above_c and sets_in_s, too");
  if (extras.has("tears_at") && !extras.has("set_modulus_pa"))
    extras.fail("tears_at", "is given for what does not become elastic", "Give set_modulus_pa, too");
  const char* const stiff = "set_viscosity_pa_s";
  const double set_viscosity = extras.number(stiff, 0.0, kViscosities);
  if (!extras.has(stiff)) {
    if (sets || melts)
      extras.fail(stiff, "is missing on a fluid that sets or melts",
                  "Give what it has when it has set, in Pa·s");
    return;
  }
  if (!sets && !melts)
    return extras.fail(stiff, "is given for a fluid that does not set",
                       "Give sets_above_c and sets_in_s, too");
  if (fluid.dynamic_viscosity > 0.0)
    heat.set_times = set_viscosity / fluid.dynamic_viscosity;
  else
    extras.fail("viscosity_pa_s", "is 0 for a fluid that sets", "Give what it has before, in Pa·s");
}

}  // namespace slosh::reading
