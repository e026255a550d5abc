// What may be typed at a running host, and what each line means.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "host/server/link_role.h"
#include "net/console_verbs.h"
#include "net/console_words.h"
#include "sim/math/result.h"

namespace slosh {

struct ConsoleCommand {
  ConsoleVerb verb = ConsoleVerb::kNothing;
  std::string text;                 ///< a person's name, a link's id, a grip's or fluid's name or number
  LinkRole role = LinkRole::kHold;  ///< kLink, kRole
  std::int64_t lifetime_ns = 0;     ///< kLink, kExpire: 0 = for ever; kKick: 0 = may come again at once
  SetWish::What what = SetWish::What::kViscosity;  ///< kSet
  double value = 0.0;                              ///< kSet: Pa·s, or times the scene's
};

/// Errors say what was expected. Any bytes may come.
Result<ConsoleCommand> parse_console(std::string_view line);

/// "10m", "2h", "90s", "1d30m" to ns, 1 s to 10 years. Errors: anything else.
Result<std::int64_t> parse_duration(std::string_view text);

/// ns in words, coarsely: "2 h 10 min".
std::string duration_text(std::int64_t ns);

}  // namespace slosh
