// The volume of closed parts as one solid, where they overlap too.
#pragma once

#include "scenes/mesh/closed.h"

namespace slosh::mesh {

/// A solid that is its parts together.
struct United {
  VolumeIntegrals solid;
  double overlap = 0.0;  ///< m³ that integrate_volume counts more than once; 0 below kMinOverlap of it
};

/// Of the sum of the parts' volumes: less counts as none, so that a handle's root in a wall changes nothing.
inline constexpr double kMinOverlap = 0.02;

/// As integrate_volume of all parts, less what lies in several of them, which is measured along 256² lines:
/// to about a thousandth of the overlap. Precondition: no defects.
United integrate_union(const WeldedMesh& mesh, const Components& components);

}  // namespace slosh::mesh
