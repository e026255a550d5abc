// The water that `slosh report picture` draws: still, let go, stirred.
#pragma once

#include <utility>
#include <vector>

#include "tests/lab/picture/score/score.h"
#include "tests/lab/report/scene_builder.h"
#include "tests/lab/report/trial.h"

namespace slosh {

/// Water in a glass tank on a table; the dam: all of it at one end, twice as high.
report::SceneBuilder tank_scene(bool dam);

/// That many pictures 1/30 s apart of the still water, stirred slowly by a rod, at that spacing, m; and their
/// scene.
std::pair<Scene, std::vector<Snapshot>> stirred_water(const report::Setting& setting, double spacing,
                                                      int pictures);

/// The still water's upper side as the camera should see it, away from walls by four spacings, m; in a
/// picture of that size.
score::Exact still_surface(const View& view, double spacing, int width, int height);

}  // namespace slosh
