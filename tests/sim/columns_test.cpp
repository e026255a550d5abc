#include "sim/columns.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <utility>

#include "sim/cpu/particles.h"
#include "tests/support/tank.h"

namespace slosh {
namespace {

TEST(Columns, EachHasANameAndAPlaceOfItsOwn) {
  std::set<std::string> names;
  std::set<std::pair<Pack, int>> places;
  for (const ColumnInfo& column : kFluidColumns) {
    EXPECT_TRUE(names.insert(column.name).second) << column.name;
    EXPECT_TRUE(places.insert({column.pack, column.lane}).second) << column.name;
    EXPECT_LT(column.lane * 4, 16) << column.name;
  }
}

// What a step writes anew needs neither to be carried along nor kept, and a fingerprint of it would depend on
// when it is taken.
TEST(Columns, OnlyWhatOutlivesAStepIsSavedOrHashed) {
  for (const ColumnInfo& column : kFluidColumns) {
    if (column.life == ColumnLife::kStep) {
      EXPECT_FALSE(column.saved || column.hashed) << column.name;
    }
    if (column.hashed) {
      EXPECT_TRUE(column.saved) << column.name << ": a restored world would have another hash";
    }
  }
}

TEST(Columns, WhatAPlanDoesNotNeedTakesNoMemory) {
  testing::Tank tank = testing::make_tank({});
  FluidParticles fluid;
  fluid.provide(make_plan(tank.scene, 0.01), 100);
  EXPECT_EQ(fluid.x.size(), 100 + kLanes);
  EXPECT_TRUE(fluid.viscosity.empty());
  tank.scene.fluids.push_back({"oil", 900.0, 1.0});
  tank.scene.fluid_volumes.push_back(tank.scene.fluid_volumes.front());
  tank.scene.fluid_volumes.back().fluid = 1;
  fluid.x[3] = 7.0f;
  fluid.provide(make_plan(tank.scene, 0.01), 100);
  EXPECT_EQ(fluid.viscosity.size(), 100 + kLanes);
  EXPECT_EQ(fluid.x[3], 7.0f) << "what is there stays";

  GatheredColumns gathered;
  gathered.provide(make_plan(tank.scene, 0.01), 100);
  EXPECT_EQ(gathered.volume.size(), 100 + kLanes);
  EXPECT_TRUE(gathered.pressure.empty());
  EXPECT_TRUE(gathered.key.empty());
  EXPECT_TRUE(gathered.solved.empty());
  tank.scene.model = ParticleModel::kIncompressible;
  gathered.provide(make_plan(tank.scene, 0.01), 100);
  EXPECT_EQ(gathered.solved.size(), 100 + kLanes);
}

}  // namespace
}  // namespace slosh
