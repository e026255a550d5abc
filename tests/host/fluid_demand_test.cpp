// Models of the fluid's wrench are made for whom somebody asks, and change nothing in the world.
#include "host/fluid_demand.h"

#include "tests/host/world_kit.h"

namespace slosh {
namespace {

using testing::Rig;

HostOptions asking(const FluidDemand* demand) {
  HostOptions options;
  options.until = 0.2;
  options.fluid_demand = demand;
  return options;
}

std::vector<FluidWrenchModel> newest(Rig& rig) {
  rig.channel.bodies().update();
  return rig.channel.bodies().front().fluid_models;
}

TEST(FluidDemand, NobodyAsksSoNobodyIsModelled) {
  FluidDemand nobody, of_no_grip;
  of_no_grip.want(std::uint64_t{1} << 40);
  for (const FluidDemand* demand :
       {static_cast<const FluidDemand*>(nullptr), static_cast<const FluidDemand*>(&nobody),
        static_cast<const FluidDemand*>(&of_no_grip)}) {
    Rig rig(asking(demand));
    rig.run();
    EXPECT_EQ(rig.host.report().fluid_models, 0u);
    EXPECT_TRUE(newest(rig).empty());
  }
}

TEST(FluidDemand, AHeldBodyIsModelledInEachStepAndTheWorldIsTheSame) {
  FluidDemand demand;
  demand.want(1);
  Rig asked(asking(&demand));
  asked.run();
  Rig alone(asking(nullptr));
  alone.run();
  EXPECT_EQ(asked.host.world().hash(), alone.host.world().hash());
  // All but the first few, in which the hand was not there yet.
  EXPECT_GE(asked.host.report().fluid_models + 3, asked.host.report().steps);
  const std::vector<FluidWrenchModel> models = newest(asked);
  ASSERT_EQ(models.size(), 1u);
  const int body = testing::small_world().scene.grips[0].body;
  EXPECT_EQ(models[0].body, static_cast<std::uint32_t>(body));
  EXPECT_EQ(models[0].tick, asked.host.world().tick());
  BodySnapshot now;
  asked.host.world().fill(now);
  EXPECT_EQ(models[0].reference.position, now.bodies[static_cast<std::size_t>(body)].center_of_mass);
}

TEST(FluidDemand, AResetBeginsAnew) {
  FluidDemand demand;
  demand.want(1);
  Rig rig(asking(&demand));
  bool seen = false;
  testing::AtTick at(20, [&] {
    rig.host.post({HostAction::kReset}, [&](const Result<bool>& done) {
      EXPECT_TRUE(done);
      seen = true;
      EXPECT_TRUE(newest(rig).empty()) << "what was learnt went with the run before";
    });
  });
  rig.host.add_tap(at);
  rig.run();
  EXPECT_TRUE(seen);
  ASSERT_EQ(newest(rig).size(), 1u);
  EXPECT_LE(newest(rig)[0].tick, rig.host.world().tick());
}

}  // namespace
}  // namespace slosh
