// What a plan leaves out changes nothing but what it costs.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/stirred_tank.h"

namespace slosh {
namespace {

using testing::add_probe;
using testing::make_tank;
using testing::paddle_hand;
using testing::stirred_tank;
using testing::Tank;
using testing::world_of;

// A fluid that no volume of the scene has is nowhere, and changes nothing: neither a wrench nor a probe's
// kind.
TEST(LeftOut, AnUnusedFluidChangesNothing) {
  Tank plain = stirred_tank(0.05);
  for (FluidVolume& volume : plain.scene.fluid_volumes) volume.fluid = 0;
  std::fill(plain.sampled.fluid_index.begin(), plain.sampled.fluid_index.end(), std::uint8_t{0});
  plain.scene.fluids.resize(1);
  add_probe(plain, {0.03, 0.05, 0.03});
  Tank with = plain;
  with.scene.fluids.insert(with.scene.fluids.begin(), Fluid{"honey", 1400.0, 20.0});
  for (FluidVolume& volume : with.scene.fluid_volumes) ++volume.fluid;
  for (std::uint8_t& index : with.sampled.fluid_index) ++index;
  World a = world_of(plain), b = world_of(with);
  ASSERT_TRUE(b.plan().has(PassId::kOneViscosity));
  BodySnapshot sa, sb;
  for (int i = 0; i < 50; ++i) {
    const HandleInput hand = paddle_hand(a.time());
    a.step({&hand, 1});
    b.step({&hand, 1});
    a.fill(sa);
    b.fill(sb);
    for (std::size_t body = 0; body < sa.bodies.size(); ++body)
      ASSERT_EQ(sa.bodies[body].fluid.force, sb.bodies[body].fluid.force)
          << "body " << body << ", step " << i;
  }
  EXPECT_EQ(a.hash(), b.hash());
}

// Leaving the per-particle viscosity out where there is one viscosity must change nothing but rounding.
TEST(LeftOut, OneViscosityGivesWhatPairsGive) {
  const Tank tank = make_tank({});
  Plan one = make_plan(tank.scene, 0.01);
  ASSERT_TRUE(one.has(PassId::kOneViscosity));
  Plan pairs = one;
  pairs.runs.set(PassId::kOneViscosity, false);
  pairs.runs.set(PassId::kPairViscosity, true);
  World a(tank.scene, tank.sampled, one, {1});
  World b(tank.scene, tank.sampled, pairs, {1});
  Snapshot sa, sb;
  for (int i = 0; i < 20; ++i) {
    a.step({});
    b.step({});
  }
  a.fill(sa);
  b.fill(sb);
  for (std::size_t p = 0; p < sa.positions.size(); ++p) {
    ASSERT_LE(glm::distance(sa.positions[p], sb.positions[p]), 1e-6f);
  }
}

TEST(LeftOut, AWrenchChangesNoMotion) {
  Tank tank = make_tank({});
  World measured = world_of(tank);
  tank.scene.bodies[0].measured = false;
  World blind = world_of(tank);
  ASSERT_FALSE(blind.plan().has(PassId::kWrenches));
  for (int i = 0; i < 30; ++i) {
    measured.step({});
    blind.step({});
  }
  EXPECT_EQ(measured.hash(), blind.hash());
}

}  // namespace
}  // namespace slosh
