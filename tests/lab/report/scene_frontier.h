// Where a setting stands in a shipped scene: the cases that tell what its hands and eyes get, judged
// together.
//
// One number of one case is met by accident where an error goes from −6 to +30 % as the spacing falls. So a
// scene's cases count with all their readings, each in units of the error that it may have, and the largest
// of them is what a setting misses by.
#pragma once

#include <string>
#include <vector>

#include "tests/lab/report/sweep.h"

namespace slosh::report {

struct SceneCases {
  const char* scene;
  std::vector<const char*> cases;  ///< ids
};

/// All shipped scenes.
const std::vector<SceneCases>& scene_cases();

/// A setting's cases, each at the finest spacing that keeps to a budget of wall time, as who plays a scene
/// would choose.
struct ScenePoint {
  const ErrorRow* setting = nullptr;  ///< one of its rows: model, backend, support ratio, share of the step
  double time = 0.0;                  ///< wall s a simulated s, the longest of the cases
  double miss = 0.0;  ///< the largest |error|, in units of what is allowed; 1: all targets are met
  const ErrorRow* worst = nullptr;  ///< the reading that misses by that
  bool frontier = false;            ///< no other takes no longer and misses by less
};

/// Of all settings in `rows`, at each budget that changes the choice; those with a case that does not fit in
/// it are left out. `rows` must outlive it.
std::vector<ScenePoint> points_of(const SceneCases& scene, const std::vector<ErrorRow>& rows);

}  // namespace slosh::report
