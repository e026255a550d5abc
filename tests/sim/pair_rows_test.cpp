// Matrix3 of pairs against a plain double loop.
#include "sim/cpu/pair_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <glm/glm.hpp>
#include <map>
#include <random>

#include "sim/passes/pressure_force/pressure_loop.h"

namespace slosh {
namespace {

constexpr float kReach = 0.1f;  // m

// Particles, some of them crowded and some alone, with all that a walk asks for.
struct Crowd {
  std::size_t count;
  Column<float> x, y, z;
  FluidPress press;

  explicit Crowd(std::size_t particles) : count(particles) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> within(0.0f, 0.35f), small(-1.0f, 1.0f);
    for (Column<float>* column : {&x, &y, &z}) column->resize(count + kLanes);
    press.clear(count, 1);
    for (std::size_t p = 0; p < count; ++p) {
      // Each seventh is far from all others: its row is empty.
      const float away = p % 7 == 3 ? 10.0f + static_cast<float>(p) : 0.0f;
      x[p] = within(random) + away, y[p] = within(random), z[p] = within(random);
      press.places[p] = {x[p], y[p], z[p], 0.0f};
      press.velocities[p] = {small(random), small(random), small(random), 1.0f};
      press.drags[p] = {small(random), small(random), small(random), 1.0f + 0.1f * small(random)};
      press.tensors[p] = {small(random), small(random), small(random), press.drags[p].w,
                          small(random), small(random), small(random), 2.0f + small(random)};
      const auto some = [&](float fourth) {
        return Vector4{small(random), small(random), small(random), fourth};
      };
      press.passed.push_back(
          {some(press.drags[p].w), some(2.0f + small(random)), some(0.0f), press.drags[p]});
    }
    press.passed.resize(count + 4);
    // Nobody.
    press.places[count] = {1e9f, 1e9f, 1e9f, 0.0f};
  }

  glm::dvec3 way(std::size_t p, std::size_t i) const {
    return glm::dvec3(glm::vec3(x[p], y[p], z[p]) - glm::vec3(x[i], y[i], z[i]));
  }
  bool near(std::size_t p, std::size_t i) const { return p != i && glm::length(way(p, i)) < kReach; }
};

// Weights that two particles have alike, by who they are.
float weight_of(std::size_t p, std::size_t i) {
  return 0.5f + 0.01f * static_cast<float>((p * i) % 37) + 0.1f * static_cast<float>(p + i);
}

// Matrix3 of those within reach, candidates in batches that begin and end anywhere: [0, split), [split,
// count).
void write(const Crowd& crowd, PairRows& rows) {
  rows.clear(1);
  PairRows::Writer writer(rows, 0);
  const std::size_t split = crowd.count / 3;
  for (std::size_t p = 0; p < crowd.count; ++p) {
    writer.begin(static_cast<std::uint32_t>(p));
    for (const auto& [begin, end] : {std::array{std::size_t{0}, split}, std::array{split, crowd.count}}) {
      for (std::size_t j = begin; j < end; j += kLanes) {
        alignas(64) float weights[kLanes] = {};
        PickedLanes picked = 0;
        for (std::size_t lane = 0; lane < kLanes && j + lane < end; ++lane) {
          weights[lane] = weight_of(p, j + lane);
          if (crowd.near(p, j + lane)) picked |= PickedLanes{1} << lane;
        }
        writer.add(static_cast<std::uint32_t>(j), FloatBatch::load_aligned(weights), picked);
      }
    }
    writer.end();
  }
}

// The same by the two steps of the density pass: who, then weights group by group.
void write_weighed(const Crowd& crowd, PairRows& rows) {
  rows.clear(1);
  PairRows::Writer writer(rows, 0);
  const auto put = [&] {
    const std::uint32_t first = writer.first();
    writer.put_weighed(static_cast<std::uint32_t>(crowd.count), [&](const PairRows::Others& others) {
      float of[16];
      for (std::uint32_t a = 0; a < 4; ++a) {
        const auto other = static_cast<std::size_t>(others[a]);
        const float w = other == crowd.count ? 0.0f : weight_of(first + a, other);
        std::fill_n(of + 4 * a, 4, w);
      }
      Sixteen weights;
      std::memcpy(&weights, of, sizeof weights);
      return weights;
    });
  };
  for (std::size_t p = 0; p < crowd.count; ++p) {
    std::int32_t* to = writer.begin(static_cast<std::uint32_t>(p), crowd.count);
    for (std::size_t i = 0; i < crowd.count; ++i) {
      if (crowd.near(p, i)) *to++ = static_cast<std::int32_t>(i);
    }
    if (writer.end_at(to)) put();
  }
  if (writer.waits()) put();
}

using Matrix3 = std::vector<std::map<std::size_t, float>>;

// Who is in whose row, with their weights; what fills rows up is left out.
Matrix3 read(const Crowd& crowd, const PairRows& rows) {
  Matrix3 found(crowd.count);
  std::size_t next = 0;
  rows.for_each_group(0, [&](const PairRows::Walk& walk) {
    EXPECT_EQ(walk.first, next);
    next += walk.count;
    walk.for_each_way(crowd.press.places.data(), [&](Sixteen, const PairRows::Pair* four) {
      for (std::uint32_t a = 0; a < 4; ++a) {
        if (four[a].weight == 0.0f) continue;
        ASSERT_LT(a, walk.count);
        const auto other = static_cast<std::size_t>(four[a].other);
        EXPECT_TRUE(found[walk.first + a].emplace(other, four[a].weight).second) << "twice";
      }
    });
  });
  EXPECT_EQ(next, crowd.count);
  return found;
}

Matrix3 expected_rows(const Crowd& crowd) {
  Matrix3 rows(crowd.count);
  for (std::size_t p = 0; p < crowd.count; ++p) {
    for (std::size_t i = 0; i < crowd.count; ++i) {
      if (crowd.near(p, i)) rows[p][i] = weight_of(p, i);
    }
  }
  return rows;
}

glm::dvec3 vec3(const Vector4& v) {
  return {v.x, v.y, v.z};
}

glm::dmat3 matrix(const PressureTensor& t) {
  return {{t.xx, t.xy, t.xz}, {t.xy, t.yy, t.yz}, {t.xz, t.yz, t.zz}};
}

// f(p, others' sum as floats of four) for each particle of a walk's result.
template <class F, class G>
void for_each_result(const PairRows& rows, F&& walked, G&& g) {
  rows.for_each_group(0, [&](const PairRows::Walk& walk) {
    const Sixteen result = walked(walk);
    float of[16];
    std::memcpy(of, &result, sizeof of);
    for (std::uint32_t a = 0; a < walk.count; ++a)
      g(walk.first + a, glm::dvec3(of[4 * a], of[4 * a + 1], of[4 * a + 2]));
  });
}

// Counts around what a batch and a group of four hold: one row alone, groups that are not full, none.
class PairRowsOf : public ::testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Particles, PairRowsOf, ::testing::Values(0, 1, 3, 4, 5, 31, 64, 97, 150));

TEST_P(PairRowsOf, HoldWhoIsInReachOnce) {
  const Crowd crowd(GetParam());
  PairRows rows;
  write(crowd, rows);
  EXPECT_EQ(read(crowd, rows), expected_rows(crowd));
  // Written anew, nothing is left of what was there.
  write_weighed(crowd, rows);
  EXPECT_EQ(read(crowd, rows), expected_rows(crowd));
}

TEST_P(PairRowsOf, TakenAgainHaveTheirNewWeightsAndWhatGoesBehind) {
  const Crowd crowd(GetParam());
  PairRows rows, again;
  write_weighed(crowd, rows);
  again.clear(1);
  {
    PairRows::Writer writer(again, 0);
    rows.for_each_group(0, [&](const PairRows::Walk& walk) {
      PairRows::Pair* to = writer.take(walk);
      walk.for_each_way(crowd.press.places.data(), [&](Sixteen, const PairRows::Pair* four) {
        const Sixteen twice = 2.0f * each_even_four_times(&four->weight);
        const PairRows::Others others{four[0].other, four[1].other, four[2].other, four[3].other};
        put_pairs(twice, others.data(), to);
        to += PairRows::kTogether;
      });
      for (std::uint32_t a = 0; a < walk.count; ++a) {
        writer.begin(walk.first + a);
        // Each third has two more, who are numbered on behind the particles.
        if ((walk.first + a) % 3 == 0)
          writer.add(static_cast<std::uint32_t>(crowd.count), FloatBatch(9.0f), PickedLanes{0b101});
        writer.end();
      }
    });
  }
  Matrix3 expected = expected_rows(crowd);
  for (std::size_t p = 0; p < crowd.count; ++p) {
    for (auto& [other, weight] : expected[p]) weight *= 2.0f;
    if (p % 3 == 0) expected[p][crowd.count] = expected[p][crowd.count + 2] = 9.0f;
  }
  // Those two are nowhere: only who is in a row is asked for here.
  Crowd with_more(crowd.count);
  with_more.press.places.resize(crowd.count + 8);
  EXPECT_EQ(read(with_more, again), expected);
}

TEST_P(PairRowsOf, PushAndFlowAsADoubleLoop) {
  const Crowd crowd(GetParam());
  PairRows rows;
  write(crowd, rows);
  const FluidPress& press = crowd.press;
  const Matrix3 expected = expected_rows(crowd);
  for_each_result(
      rows, [&](const PairRows::Walk& w) { return w.push(press.places.data(), press.tensors.data()); },
      [&](std::size_t p, const glm::dvec3& found) {
        glm::dvec3 sum(0.0);
        double size = 0.0;
        for (const auto& [i, weight] : expected[p]) {
          const glm::dvec3 part = matrix(press.tensors[i]) * (static_cast<double>(weight) * crowd.way(p, i));
          sum += part;
          size += glm::length(part);
        }
        EXPECT_LE(glm::length(found - sum), 1e-6 * size);
      });
  for_each_result(
      rows,
      [&](const PairRows::Walk& w) {
        return w.flow(press.places.data(), press.tensors.data(), press.velocities.data());
      },
      [&](std::size_t p, const glm::dvec3& parts) {
        double sum = 0.0, size = 0.0;
        for (const auto& [i, weight] : expected[p]) {
          const glm::dvec3 g = static_cast<double>(weight) * crowd.way(p, i);
          sum += glm::dot(g, matrix(press.tensors[p]) * vec3(press.velocities[i]));
          size += glm::length(g) * 3.0;
        }
        EXPECT_LE(std::abs(parts.x + parts.y + parts.z - sum), 1e-6 * size);
      });
}

// Viscous pairs: a double loop, and the momentum of all.
TEST_P(PairRowsOf, DragAsADoubleLoopAndKeepMomentumToRounding) {
  const Crowd crowd(GetParam());
  PairRows rows;
  write(crowd, rows);
  const FluidPress& press = crowd.press;
  glm::dvec3 momentum(0.0);
  double all = 0.0;
  const Matrix3 expected = expected_rows(crowd);
  for_each_result(
      rows, [&](const PairRows::Walk& w) { return w.dragged(press.places.data(), press.velocities.data()); },
      [&](std::size_t p, const glm::dvec3& found) {
        glm::dvec3 sum(0.0);
        double size = 0.0;
        for (const auto& [i, weight] : expected[p]) {
          const glm::dvec3 d = crowd.way(p, i),
                           faster = vec3(press.velocities[i]) - vec3(press.velocities[p]);
          const glm::dvec3 part = static_cast<double>(weight) * d * glm::dot(d, faster);
          sum += part;
          size += glm::length(part);
        }
        EXPECT_LE(glm::length(found - sum), 2e-6 * size);
        momentum += found;
        all += size;
      });
  EXPECT_LE(glm::length(momentum), 2e-8 * all);
}

TEST_P(PairRowsOf, SquaresAndRatesAsADoubleLoop) {
  const Crowd crowd(GetParam());
  PairRows rows;
  write(crowd, rows);
  const FluidPress& press = crowd.press;
  const Matrix3 expected = expected_rows(crowd);
  const auto check = [&](auto&& walked, auto&& factor) {
    rows.for_each_group(0, [&](const PairRows::Walk& walk) {
      const PairRows::Walk::SumOfSquares found = walked(walk);
      float even[16], odd[16];
      std::memcpy(even, &found.even, sizeof even);
      std::memcpy(odd, &found.odd, sizeof odd);
      for (std::uint32_t a = 0; a < walk.count; ++a) {
        glm::dmat3 sum(0.0);
        double size = 0.0;
        for (const auto& [i, weight] : expected[walk.first + a]) {
          const glm::dvec3 d = crowd.way(walk.first + a, i);
          sum += factor(i, static_cast<double>(weight)) * glm::outerProduct(d, d);
          size += std::abs(factor(i, static_cast<double>(weight))) * glm::dot(d, d);
        }
        for (int k = 0; k < 3; ++k) {
          EXPECT_NEAR(even[4 * a + static_cast<std::uint32_t>(k)], sum[k][k], 1e-6 * size);
          EXPECT_NEAR(odd[4 * a + static_cast<std::uint32_t>(k)], sum[k][(k + 1) % 3], 1e-6 * size);
        }
      }
    });
  };
  check([&](const PairRows::Walk& w) { return w.rates(press.places.data()); },
        [](std::size_t, double weight) { return weight; });
  check(
      [&](const PairRows::Walk& w) { return w.squares(press.places.data(), press.drags.data()); },
      [&](std::size_t i, double weight) { return weight * weight * static_cast<double>(press.drags[i].w); });
}

constexpr DragShape<float> kShape{0.7f, 0.9f / kReach};
double drags_by(double reach) {
  return reach * (static_cast<double>(kShape.level) + static_cast<double>(kShape.growth) * reach);
}

// T d by its own nine numbers.
glm::dvec3 pushed(const Passed& t, const glm::dvec3& d) {
  return vec3(t.straight) * d + vec3(t.turning) * glm::dvec3(d.y, d.z, d.x) +
         vec3(t.back) * glm::dvec3(d.z, d.x, d.y);
}

// What a force pass finds over rows: `forces` against a double loop over what others push with, `push(i, d)`,
// the artificial viscosity and Eq 9 of each one's own viscosity.
template <class Forces, class Push, class Viscosity>
void expect_forces(const Crowd& crowd, Forces&& forces, Push&& push, Viscosity&& viscosity) {
  const FluidPress& press = crowd.press;
  const Matrix3 expected = expected_rows(crowd);
  for_each_result(
      press.rows,
      [&](const PairRows::Walk& w) {
        const GroupForces found = forces(w);
        return found.pressed + found.dragged;
      },
      [&](std::size_t p, const glm::dvec3& found) {
        glm::dvec3 sum(0.0);
        double size = 0.0;
        for (const auto& [i, weight] : expected[p]) {
          const glm::dvec3 d = crowd.way(p, i);
          const double r = glm::length(d);
          const glm::dvec3 u = vec3(press.drags[i]) - vec3(press.drags[p]);
          const glm::dvec3 v = vec3(press.velocities[i]) - vec3(press.velocities[p]);
          const glm::dvec3 by = u + 0.5 * (viscosity(p) + viscosity(i)) * v;
          const glm::dvec3 part =
              push(i, static_cast<double>(weight) * d) +
              (static_cast<double>(press.drags[i].w) * drags_by(kReach - r) / (r * r) * glm::dot(d, by)) * d;
          sum += part;
          size += glm::length(part) + 3.0 * (kReach - r);
        }
        EXPECT_LE(glm::length(found - sum), 3e-6 * size);
      });
}

TEST_P(PairRowsOf, ForcesAsADoubleLoop) {
  Crowd crowd(GetParam());
  write_weighed(crowd, crowd.press.rows);
  const FluidPress& press = crowd.press;
  expect_forces(
      crowd,
      [&](const PairRows::Walk& w) {
        return walk_forces<true, true, true>(press, w, kReach, kShape, [](const auto&...) {});
      },
      [&](std::size_t i, const glm::dvec3& g) { return matrix(press.tensors[i]) * g; },
      [&](std::size_t i) { return static_cast<double>(press.tensors[i].viscosity); });
}

TEST_P(PairRowsOf, ForcesByWhatIsPassedOnAsADoubleLoop) {
  Crowd crowd(GetParam());
  write_weighed(crowd, crowd.press.rows);
  const FluidPress& press = crowd.press;
  expect_forces(
      crowd, [&](const PairRows::Walk& w) { return walk_passed(press, w, kReach, kShape); },
      [&](std::size_t i, const glm::dvec3& g) { return pushed(press.passed[i], g); },
      [&](std::size_t i) { return static_cast<double>(press.passed[i].turning.w); });
}

}  // namespace
}  // namespace slosh
