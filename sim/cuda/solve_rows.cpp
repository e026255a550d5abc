#include "sim/cuda/solve_rows.h"

#include <cmath>

namespace slosh::cuda {

std::uint32_t row_room(const Plan& plan) {
  const double ratio = plan.support_radius / plan.spacing;
  const double in_reach = 4.0 / 3.0 * 3.14159265358979323846 * ratio * ratio * ratio;
  return 8 * static_cast<std::uint32_t>(std::ceil(1.5 * in_reach / 8.0));
}

}  // namespace slosh::cuda
