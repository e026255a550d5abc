// Prints the hash of every shipped scene after a settling and some steps with its scripted hands, in both
// models and on one and two threads, and of small worlds that have what the scenes lack. A change that claims
// to change no result is run before and after, on one machine: between machines the last bits may differ, so
// nothing is committed. Usage: world_hashes [steps [scene…]]: 200 steps of all unless told otherwise. Exits 1
// where the thread count changes a hash.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "scenes/load.h"
#include "scenes/sample.h"
#include "sim/world.h"
#include "tests/support/stirred_tank.h"

namespace slosh {
namespace {

constexpr double kSettle = 0.1;  // s

// Where the scripted hand is, with the velocity between its two keys.
HandleInput scripted(const Grip& grip, const Pose& start, double time) {
  HandleInput hand{start, {}, true, 1.0};
  const std::vector<PoseKey>& keys = grip.hand_motion;
  for (std::size_t k = 0; k + 1 < keys.size(); ++k) {
    if (time > keys[k + 1].time && k + 2 < keys.size()) continue;
    const double span = keys[k + 1].time - keys[k].time;
    const double along = std::min(1.0, (time - keys[k].time) / span);
    hand.pose.position = glm::mix(keys[k].pose.position, keys[k + 1].pose.position, along);
    hand.pose.orientation = glm::slerp(keys[k].pose.orientation, keys[k + 1].pose.orientation, along);
    hand.twist.linear = (keys[k + 1].pose.position - keys[k].pose.position) / span;
    hand.twist.angular = rotation_between(keys[k].pose.orientation, keys[k + 1].pose.orientation) / span;
    break;
  }
  return hand;
}

std::uint64_t run(const Scene& scene, const SampledScene& sampled, int threads, int steps) {
  World world(scene, sampled, make_plan(scene, sampled.spacing), {threads, Backend::kCpu});
  BodySnapshot start;
  world.fill(start);
  // Six times as fast as the script, so that few steps see much of it.
  const auto hands = [&](double time) {
    std::vector<HandleInput> all;
    for (std::size_t g = 0; g < scene.grips.size(); ++g)
      all.push_back(scripted(scene.grips[g], start.grips[g].pose, 6.0 * time));
    return all;
  };
  world.settle(kSettle, hands(0.0));
  for (int i = 0; i < steps; ++i) world.step(hands(world.time()));
  return world.hash();
}

bool print(const std::string& name, const Scene& scene, const SampledScene& sampled, int steps) {
  const std::uint64_t one = run(scene, sampled, 1, steps);
  const std::uint64_t two = run(scene, sampled, 2, steps);
  std::printf("%-28s %016llx%s\n", name.c_str(), static_cast<unsigned long long>(one),
              one == two ? "" : "  AND ANOTHER ON TWO THREADS");
  std::fflush(stdout);
  return one == two;
}

bool print_shipped(const std::string& name, int steps) {
  const auto file = find_scene(name);
  if (!file) throw std::runtime_error(file.error().text());
  auto read = load_scene(file.value());
  if (!read) throw std::runtime_error(read.error().text());
  Scene scene = read.value();
  const auto sampled = sample_scene(scene, scene.spacing_max);
  if (!sampled) throw std::runtime_error(sampled.error().text());
  bool same = true;
  for (const ParticleModel model :
       {ParticleModel::kCorrected, ParticleModel::kPaper, ParticleModel::kIncompressible}) {
    scene.model = model;
    same &= print(name + " " + slosh::name(model), scene, sampled.value(), steps);
  }
  return same;
}

bool print_small(int steps) {
  bool same = true;
  for (const ParticleModel model :
       {ParticleModel::kCorrected, ParticleModel::kPaper, ParticleModel::kIncompressible}) {
    const std::string word = std::string(" ") + slosh::name(model);
    testing::Tank tank = testing::stirred_tank(0.1);
    tank.scene.model = model;
    same &= print("two fluids, paddle" + word, tank.scene, tank.sampled, steps);
    tank = testing::make_tank({});
    tank.scene.model = model;
    tank.scene.tension = 0.5;
    same &= print("one fluid, tension" + word, tank.scene, tank.sampled, steps);
    tank.scene.fluids[0].dynamic_viscosity = 0.0;
    same &= print("no viscosity" + word, tank.scene, tank.sampled, steps);
  }
  testing::Tank tank = testing::make_tank({});
  tank.scene.support_ratio = 2.5;
  return same & print("support ratio 2.5", tank.scene, tank.sampled, steps);
}

}  // namespace
}  // namespace slosh

int main(int argc, char** argv) {
  const int steps = argc > 1 ? std::atoi(argv[1]) : 200;
  bool same = true;
  if (argc > 2) {
    for (int i = 2; i < argc; ++i) same &= slosh::print_shipped(argv[i], steps);
    return same ? 0 : 1;
  }
  for (const char* name : {"bucket", "spoon", "pour", "spin", "pool", "probe", "crepe", "mixer", "vessel"})
    same &= slosh::print_shipped(name, steps);
  same &= slosh::print_small(steps);
  return same ? 0 : 1;
}
