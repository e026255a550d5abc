// What `slosh report picture` says of fluid outside of a vessel: streams, sheets, strings, puddles, films and
// drops of few particles, beside the same simulated finely.
#pragma once

#include <string>
#include <vector>

#include "render/context.h"
#include "render/image.h"
#include "sim/math/result.h"
#include "tests/lab/picture/score/shape.h"
#include "tests/lab/report/trial.h"

namespace slosh {

struct ShapeRow {
  std::string name;
  double spacing = 0.0;  ///< m, of what was drawn
  score::ShapeScore score;
  double by_ray =
      0.0;  ///< ShapeScore::overlap of the same particles' surface by ray: what is the simulation's
};
struct ShapeStudy {
  double right_spacing = 0.0;  ///< m, of what it is compared with
  std::vector<ShapeRow> rows;
  Image sheet;  ///< a row a case: as it should be, then as it is drawn, coarser to the right
};

/// `setting`: its spacing is not used. Errors: no renderer, built without Embree. Throws report::Refused,
/// report::Stopped.
Result<ShapeStudy> study_shapes(Context& context, report::Setting setting, bool quick, int threads);

/// As Markdown.
std::string shape_table(const ShapeStudy& study);

}  // namespace slosh
