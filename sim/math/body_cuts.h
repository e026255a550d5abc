// What cuts have left of bodies, for those who show and feel them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/math/cut_plane.h"
#include "sim/math/mass_properties.h"

namespace slosh {

struct BodyCut {
  std::vector<CutPlane> planes;  ///< in its mesh frame; at most kMaxCutPlanes; none: it is whole
  MassProperties mass{};         ///< of what is within them; meaningful where there are planes
};

/// All bodies of a world of which one at least is cut, from one tick on.
struct BodyCuts {
  std::uint64_t since = 0;  ///< tick of the first state that has them
  std::vector<BodyCut> bodies;

  /// Null where that one is whole.
  const BodyCut* of(std::size_t body) const {
    return body < bodies.size() && !bodies[body].planes.empty() ? &bodies[body] : nullptr;
  }
};

/// Those that bound a body now; none where it is whole.
inline std::span<const CutPlane> planes_of(const BodyCuts* cuts, std::size_t body) {
  const BodyCut* const cut = cuts ? cuts->of(body) : nullptr;
  return cut ? std::span<const CutPlane>(cut->planes) : std::span<const CutPlane>();
}

}  // namespace slosh
