// A vessel made of slabs that touch: fixed bodies of their own, but one solid to the fluid.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/physics/lab.h"

namespace slosh {
namespace {

// Water hurled at 4 m/s into the edges of a closed box of six slabs, far too soft for that (10 m²/s²):
// crushed as it is, only the penetration clamp holds it. While that knew each slab for itself, the joint
// between two was a way out: after 0.3 s 305 of 864 particles were outside.
TEST(Slabs, nothing_gets_out_between_two) {
  constexpr double kSpacing = 0.01, kThick = 0.05, kHalf = 0.06, kHigh = 0.1;
  constexpr double kOut = kHalf + kThick;
  report::SceneBuilder b;
  b.add_fluid(1000.0, 0.001);
  b.add_fixed("floor", make::box({-kOut, -kThick, -kOut}, {kOut, 0.0, kOut}));
  b.add_fixed("lid", make::box({-kOut, kHigh, -kOut}, {kOut, kHigh + kThick, kOut}));
  b.add_fixed("left", make::box({-kOut, 0.0, -kOut}, {-kHalf, kHigh, kOut}));
  b.add_fixed("right", make::box({kHalf, 0.0, -kOut}, {kOut, kHigh, kOut}));
  b.add_fixed("back", make::box({-kHalf, 0.0, -kOut}, {kHalf, kHigh, -kHalf}));
  b.add_fixed("front", make::box({-kHalf, 0.0, kHalf}, {kHalf, kHigh, kOut}));
  b.add_volume(make::box({-kHalf, 0.0, -kHalf}, {kHalf, 0.06, kHalf}));
  b.set_domain({-0.3, -0.3, -0.3}, {0.3, 0.4, 0.3});
  b.scene.spacing = kSpacing;
  b.scene.stiffness = 10.0;
  SampledScene sampled = sample_scene(b.scene, kSpacing).value();
  std::fill(sampled.fluid_velocities.begin(), sampled.fluid_velocities.end(), glm::vec3(-2.2f, -2.9f, -1.8f));
  World world(b.scene, sampled, make_plan(b.scene, kSpacing), WorldOptions{1, Backend::kCpu});
  while (world.time() < 0.3) world.step({});
  Snapshot snapshot;
  world.fill(snapshot);
  int outside = 0;
  for (std::size_t i = 0; i < snapshot.positions.size(); ++i) {
    const glm::vec3 p = snapshot.positions[i];
    const double beyond = std::max({std::abs(p.x) - kHalf, std::abs(p.z) - kHalf, -double{p.y}, p.y - kHigh});
    outside += snapshot.fluid_index[i] == 255 || beyond > kSpacing;
  }
  std::printf("%d of %zu outside\n", outside, snapshot.positions.size());
  EXPECT_EQ(outside, 0);
  EXPECT_TRUE(world.take_status() & kStatusClamped) << "nothing was put to the test";
}

}  // namespace
}  // namespace slosh
