// The plan in words.
#include <cmath>

#include "sim/math/format.h"
#include "sim/passes/pass.h"

namespace slosh {

std::string describe(const Plan& plan) {
  std::string text;
  text += format("model           %s\n", name(plan.model));
  text += format("spacing         %.4g mm\n", plan.spacing * 1e3);
  text += format("support radius  %.4g mm\n", plan.support_radius * 1e3);
  if (plan.has(PassId::kPressureSolve)) {
    text += format("stiffness       none: pressure projection (artificial viscosity as of %.4g m²/s²)\n",
                   plan.stiffness);
  } else {
    text +=
        format("stiffness       %.4g m²/s² (sound at %.3g m/s)\n", plan.stiffness, std::sqrt(plan.stiffness));
  }
  if (plan.driven_speed > 0.0)
    text += format("driven          at up to %.3g m/s, by start velocities, keys and scripted hands\n",
                   plan.driven_speed);
  text +=
      format("time step       %.4g ms, limited by %s\n", plan.time_step * 1e3, plan.time_step_reason.c_str());
  text += format("speed limit     %.3g m/s\n", plan.max_speed);
  text += "\nEach step\n";
  const auto list = [&](const std::vector<Pass>& passes) {
    for (const Pass& pass : passes) text += format("  %-38s %s\n", entry(pass.id).words, pass.reason.c_str());
  };
  list(plan.passes);
  if (!plan.left_out.empty()) text += "Left out\n";
  list(plan.left_out);
  return text;
}

}  // namespace slosh
