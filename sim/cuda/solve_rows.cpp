#include "sim/cuda/solve_rows.h"

#include <cmath>

namespace slosh::cuda {

std::uint32_t row_room(const Plan& plan) {
  const double ratio = plan.support_radius / plan.spacing;
  const double in_reach = 4.0 / 3.0 * 3.14159265358979323846 * ratio * ratio * ratio;
  return 8 * static_cast<std::uint32_t>(std::ceil(1.5 * in_reach / 8.0));
}

std::vector<BodyRange> ranges_of(std::span<const SurfaceParticle> moving, std::size_t body_count) {
  std::vector<BodyRange> ranges(body_count);
  for (std::uint32_t i = 0; i < moving.size(); ++i) {
    BodyRange& range = ranges[moving[i].body];
    if (range.end == 0) range.begin = i;
    range.end = i + 1;
  }
  return ranges;
}

}  // namespace slosh::cuda
