// The shipped scenes, one function and one file each.
#pragma once

#include "scenes/make/writer.h"

namespace slosh::make {

/// Walls of vessels. m
inline constexpr double kWall = 0.014;

/// The shipped scenes come to rest in their hands before they begin. s
inline constexpr double kSettle = 1.0;

SceneWriter make_bucket();  ///< paper, section 6.4.4
SceneWriter make_spoon();   ///< paper, section 6.4.1
SceneWriter make_pour();    ///< paper, section 6.4.2
SceneWriter make_spin();    ///< paper, section 6.4.3
SceneWriter make_pool();    ///< paper, section 6.2
SceneWriter make_probe();   ///< paper, section 3
SceneWriter make_crepe();   ///< paper, section 6.5
SceneWriter make_mixer();   ///< paper's discussion: a mixer in a soup
SceneWriter make_vessel();  ///< paper's discussion: a probe in a vessel

/// A wooden slab, its top at y = 0: a fixed body, or only looked at.
void add_table(SceneWriter& writer, double width, double depth, bool solid = true);

/// A list for `extras`.
nlohmann::json list(const glm::dvec3& v);

}  // namespace slosh::make
