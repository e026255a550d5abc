#include "tests/lab/coupling/link_count.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slosh::coupling {
namespace {

constexpr double kWeight = 31.2;            // N, bucket and water
constexpr double kStiffness = 2000.0;       // N/m, of each grip
constexpr double kTurningStiffness = 20.0;  // N·m/rad
constexpr double kHeld =
    0.125 * kWeight * kWeight / kStiffness;  // J, in each grip's spring by the weight alone
constexpr double kCompared = 3.0;            // s from which on forces are compared: both have taken hold
constexpr double kBegun = 0.5;               // N: less is no force yet

std::size_t beginning_of(const Felt& felt) {
  const auto begun = std::find_if(felt.force.begin(), felt.force.end(),
                                  [](const glm::dvec3& force) { return glm::length(force) > kBegun; });
  return std::min(static_cast<std::size_t>(begun - felt.force.begin()), felt.force.size() - 1);
}

}  // namespace

void Felt::add(double at, const Pose& hand, const Wrench& on_hand) {
  double sum = 0.0;
  if (!time.empty()) {
    const Wrench mean{0.5 * (on_hand.force + felt_.force), 0.5 * (on_hand.torque + felt_.torque)};
    sum = put_in.back() - glm::dot(mean.force, hand.position - last_.position) -
          glm::dot(mean.torque, rotation_between(last_.orientation, hand.orientation));
  }
  time.push_back(at);
  force.push_back(on_hand.force);
  put_in.push_back(sum);
  height.push_back(hand.position.y);
  held.push_back(0.5 * (glm::dot(on_hand.force, on_hand.force) / kStiffness +
                        glm::dot(on_hand.torque, on_hand.torque) / kTurningStiffness));
  last_ = hand;
  felt_ = on_hand;
}

std::size_t row_at(const Felt& felt, double time) {
  const auto at = std::lower_bound(felt.time.begin(), felt.time.end(), time);
  return std::min(static_cast<std::size_t>(at - felt.time.begin()), felt.time.size() - 1);
}

double generated_by(const std::array<Felt, 2>& people) {
  const std::array<std::size_t, 2> begun{beginning_of(people[0]), beginning_of(people[1])};
  double most = 0.0;
  for (const double now : people[0].time) {
    double came_out = 0.0, sank = 0.0, held = 0.0;
    for (std::size_t p = 0; p < people.size(); ++p) {
      const Felt& felt = people[p];
      const std::size_t first = begun[p], row = row_at(felt, now);
      held += row < first ? kHeld : felt.held[row];
      if (row < first) continue;
      came_out -= felt.put_in[row] - felt.put_in[first];
      sank += 0.5 * (felt.height[first] - felt.height[row]);
    }
    const double gave = std::max(2.0 * kHeld - held, 0.0);
    most = std::max(most, came_out - gave - kWeight * std::max(sank, 0.0));
  }
  return most;
}

double error_of(const Felt& felt, const Felt& reference) {
  if (reference.time.empty()) return std::numeric_limits<double>::quiet_NaN();
  double off = 0.0, all = 0.0;
  for (std::size_t i = row_at(reference, kCompared); i < reference.time.size(); ++i) {
    const glm::dvec3 difference = felt.force[row_at(felt, reference.time[i])] - reference.force[i];
    off += glm::dot(difference, difference);
    all += glm::dot(reference.force[i], reference.force[i]);
  }
  return all > 0.0 ? std::sqrt(off / all) : 0.0;
}

}  // namespace slosh::coupling
