// A scene file's field as people write it: its unit stands behind the number, not in the name.
#pragma once

#include <string>

namespace slosh {

/// "viscosity_pa_s", "0.5" → "viscosity = 0.5 Pa·s"; a field without a unit in its name as it is, "model =
/// paper".
std::string field_in_words(const std::string& field, const std::string& value);

}  // namespace slosh
