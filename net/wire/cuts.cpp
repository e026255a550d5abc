#include "net/wire/cuts.h"

namespace slosh::wire {

Cuts to_message(const BodyCuts& cuts, std::uint32_t run) {
  Cuts message{run, cuts.since, {}};
  for (std::size_t b = 0; b < cuts.bodies.size(); ++b)
    if (const BodyCut* cut = cuts.of(b)) message.bodies.push_back({static_cast<std::uint32_t>(b), *cut});
  return message;
}

BodyCuts to_cuts(const Cuts& message, std::size_t bodies) {
  BodyCuts cuts{message.since, std::vector<BodyCut>(bodies)};
  for (const CutEntry& entry : message.bodies)
    if (entry.body < bodies) cuts.bodies[entry.body] = entry.cut;
  return cuts;
}

}  // namespace slosh::wire
