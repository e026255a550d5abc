// A scene with one or two of everything, small enough to damage in every place.
#pragma once

#include "scenes/scene.h"

namespace slosh::test {

/// A free bucket with a grip and its hand, a table, a probe without a mesh, water, a picture.
Scene small_scene();

}  // namespace slosh::test
