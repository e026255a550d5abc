#include "sim/bodies/hands.h"

#include <algorithm>
#include <cmath>

#include "sim/math/limits.h"

namespace slosh {

namespace {

// Handles beyond these are broken devices, not hands.
constexpr double kFastestHandle = 1.0e3;      // m/s
constexpr double kFastestHandleTurn = 1.0e4;  // rad/s

bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

bool usable(const HandleInput& input) {
  const glm::dquat& q = input.pose.orientation;
  const double norm = glm::dot(q, q);
  return finite(input.pose.position) && finite(input.twist.linear) && finite(input.twist.angular) &&
         glm::length(input.pose.position) < kFarthestHandle && std::isfinite(norm) &&
         glm::length(input.twist.linear) < kFastestHandle &&
         glm::length(input.twist.angular) < kFastestHandleTurn && std::abs(norm - 1.0) < 0.1 &&
         std::isfinite(input.scale);
}

Hands::Hands(const Scene& scene)
    : grips_(scene.grips),
      last_(scene.grips.size()),
      stiffness_{std::vector<double>(scene.grips.size(), 1.0), std::vector<double>(scene.grips.size(), 1.0)} {
}

std::uint32_t Hands::take(std::span<const HandleInput> handles, double time_step) {
  std::uint32_t status = 0;
  for (std::size_t g = 0; g < last_.size(); ++g) {
    stiffness_.acting[g] = toward_stiffness(stiffness_.acting[g], stiffness_.wanted[g], time_step);
    HandleInput input = g < handles.size() ? handles[g] : HandleInput{};
    if (input.engaged && !usable(input)) {
      status |= kStatusInputRejected;
      input = last_[g];
      input.twist = {};
    }
    last_[g] = input;
  }
  return status;
}

const std::vector<ActiveCoupling>& Hands::couple(const std::vector<RigidBody>& bodies, double elapsed) {
  couplings_.clear();
  for (std::size_t g = 0; g < grips_.size(); ++g) {
    const HandleInput& input = last_[g];
    if (!input.engaged) continue;
    const Grip& grip = grips_[g];
    if (bodies[grip.body].gone) continue;
    const double scale = std::clamp(input.scale, 0.0, 1.0);
    ActiveCoupling coupling;
    coupling.grip = static_cast<int>(g);
    coupling.body = grip.body;
    const double spring = scale * stiffness_.acting[g];
    coupling.gains = {spring * grip.stiffness, scale * grip.damping, spring * grip.rotational_stiffness,
                      scale * grip.rotational_damping};
    coupling.handle = input.pose;
    coupling.handle.orientation = glm::normalize(input.pose.orientation);
    if (elapsed > 0.0) coupling.handle = extrapolate(coupling.handle, input.twist, elapsed);
    coupling.handle_twist = input.twist;
    coupling.grip_pose = compose(bodies[grip.body].mesh_pose(), grip.pose);
    coupling.arm = coupling.grip_pose.position - bodies[grip.body].position;
    couplings_.push_back(coupling);
  }
  std::stable_sort(couplings_.begin(), couplings_.end(),
                   [](const ActiveCoupling& a, const ActiveCoupling& b) { return a.body < b.body; });
  return couplings_;
}

}  // namespace slosh
