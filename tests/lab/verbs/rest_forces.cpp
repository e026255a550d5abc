#include "tests/lab/verbs/rest_forces.h"

#include <algorithm>
#include <cmath>

#include "sim/math/format.h"

namespace slosh {
namespace {

constexpr double kShortest = 0.2;   // s of a rest
constexpr double kStill = 1e-9;     // m and rad between two steps
constexpr double kSettled = 0.01;   // of the force
constexpr double kChanging = 0.4;   // of what runs differ by
constexpr double kAtLeast = 0.005;  // N: less is a device's own noise

bool moved(const Pose& a, const Pose& b) {
  return glm::distance(a.position, b.position) > kStill ||
         glm::length(rotation_between(a.orientation, b.orientation)) > kStill;
}

double mean_force(const WrenchSeries& felt, std::size_t begin, std::size_t end) {
  double sum = 0.0;
  for (std::size_t k = begin; k < end; ++k) sum += glm::length(felt.on_hand[k].force);
  return sum / static_cast<double>(end - begin);
}

RestForce rest_of(const WrenchSeries& felt, std::size_t begin, std::size_t end) {
  const std::size_t middle = begin + (end - begin) / 2;
  const double force = mean_force(felt, middle, end);
  return {felt.time[begin], felt.time[end - 1], force, force - mean_force(felt, begin, middle)};
}

}  // namespace

std::vector<RestForce> rest_forces(const WrenchSeries& felt, const std::vector<Pose>& poses) {
  std::vector<RestForce> rests;
  const std::size_t count = std::min(felt.time.size(), poses.size());
  if (count < 2) return rests;
  std::size_t first = 1, last = count - 1;  // steps that moved
  while (first < count && !moved(poses[first - 1], poses[first])) ++first;
  while (last > 0 && !moved(poses[last - 1], poses[last])) --last;
  const auto add = [&](std::size_t begin, std::size_t end) {
    if (begin < end && felt.time[end - 1] - felt.time[begin] >= kShortest)
      rests.push_back(rest_of(felt, begin, end));
  };
  add(0, first);
  if (first < count) add(last, count);
  return rests;
}

std::string unsettled_text(const std::string& hand, const std::vector<std::vector<RestForce>>& runs) {
  if (runs.size() < 2) return {};
  std::size_t rests = runs.front().size();
  for (const std::vector<RestForce>& run : runs) rests = std::min(rests, run.size());
  for (std::size_t r = 0; r < rests; ++r) {
    double least = INFINITY, most = 0.0, change = 0.0;
    for (const std::vector<RestForce>& run : runs) {
      least = std::min(least, run[r].force);
      most = std::max(most, run[r].force);
      change = std::max(change, std::abs(run[r].change));
    }
    const double apart = most - least;
    if (apart <= std::max(kSettled * most, kAtLeast)) continue;
    const RestForce& when = runs.front()[r];
    std::string text = format(
        "%s stands still from %.3g to %.3g s and feels %.4g to %.4g N, %.2g %% apart by "
        "viscosity alone. ",
        hand.c_str(), when.from, when.to, least, most, 100.0 * apart / most);
    if (change < kChanging * apart)
      return text +
             "The fluid's particles came to rest otherwise, and so much that is at this spacing: a finer "
             "--spacing makes it less";
    return text + "The fluid has not settled: that still changed meanwhile. " +
           (r == 0 ? "A longer settle_s of the scene lets it"
                   : "Let the hand stand longer: a last key later, and --seconds");
  }
  return {};
}

}  // namespace slosh
