// How a fluid lies and how fluids are mixed, of places whose answer is known.
#include "sim/fluid_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace slosh {
namespace {

constexpr double kApart = 0.01;  // m
const glm::dvec3 kUpward(0.0, 1.0, 0.0);

struct Places {
  std::vector<glm::vec3> at;
  std::vector<std::uint8_t> of_it;

  void add_lattice(const glm::ivec3& low, const glm::ivec3& high, bool it = true) {
    for (int x = low.x; x < high.x; ++x) {
      for (int y = low.y; y < high.y; ++y) {
        for (int z = low.z; z < high.z; ++z) {
          at.emplace_back(kApart * (glm::dvec3(x, y, z) + 0.5));
          of_it.push_back(it);
        }
      }
    }
  }
};

TEST(FluidMeasures, ALayerCoversItsArea) {
  Places one;
  one.add_lattice({0, 0, 0}, {20, 1, 30});
  const Spread layer = spread_of(one.at, kUpward, kApart);
  EXPECT_NEAR(layer.area, 0.2 * 0.3, 1e-9);
  EXPECT_NEAR(layer.evenness, 1.0, 1e-9);
  one.add_lattice({0, 1, 0}, {20, 4, 30});
  EXPECT_NEAR(spread_of(one.at, kUpward, kApart).area, 0.2 * 0.3, 1e-9) << "however deep it is";
  EXPECT_EQ(spread_of({}, kUpward, kApart).area, 0.0);
  EXPECT_EQ(spread_of({}, kUpward, kApart).evenness, 0.0);
}

TEST(FluidMeasures, UpIsWhereItIsSaidToBe) {
  Places wall;
  wall.add_lattice({0, 0, 0}, {1, 20, 30});
  EXPECT_NEAR(spread_of(wall.at, {1.0, 0.0, 0.0}, kApart).area, 0.2 * 0.3, 1e-9);
  EXPECT_LT(spread_of(wall.at, kUpward, kApart).area, 0.02);
}

// A half as deep again as the other: depths of 2 and 3, mean 2.5, deviation 0.5.
TEST(FluidMeasures, AStepIsUneven) {
  Places step;
  step.add_lattice({0, 0, 0}, {40, 2, 40});
  step.add_lattice({0, 2, 0}, {20, 3, 40});
  EXPECT_NEAR(spread_of(step.at, kUpward, kApart).evenness, 1.0 - 0.5 / 2.5, 1e-3);
}

TEST(FluidMeasures, WhatLiesApartIsNotMixed) {
  Places apart;
  apart.add_lattice({0, 0, 0}, {16, 16, 16});
  apart.add_lattice({16, 0, 0}, {32, 16, 16}, false);
  EXPECT_NEAR(mixing_index(apart.at, apart.of_it, kApart), 0.0, 1e-6);
}

TEST(FluidMeasures, WhatChanceSharesOutIsMixed) {
  Places mixed;
  mixed.add_lattice({0, 0, 0}, {30, 30, 30});
  std::mt19937 random(7);
  for (std::uint8_t& it : mixed.of_it) it = random() % 4 == 0;
  EXPECT_NEAR(mixing_index(mixed.at, mixed.of_it, kApart), 1.0, 0.01);
  // A half of it stays apart: the index goes with the variance between samples.
  Places half = mixed;
  for (std::size_t i = 0; i < half.at.size() / 2; ++i) half.of_it[i] = 0;
  const double index = mixing_index(half.at, half.of_it, kApart);
  EXPECT_NEAR(index, 1.0 - 0.125 * 0.125 / (0.125 * 0.875), 0.02);
}

TEST(FluidMeasures, OneFluidAloneIsNeither) {
  Places one;
  one.add_lattice({0, 0, 0}, {9, 9, 9});
  EXPECT_TRUE(std::isnan(mixing_index(one.at, one.of_it, kApart)));
  EXPECT_TRUE(std::isnan(mixing_index({}, {}, kApart)));
}

}  // namespace
}  // namespace slosh
