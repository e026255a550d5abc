// Fixed bodies that touch: their particles lie as far behind the common surface as one body's do, without a
// hole.
#include "sim/walls/joined_walls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/walls/joined_fields.h"

namespace slosh {
namespace {

constexpr float kSpacing = 0.01f;
constexpr float kDepth = 0.7f * kSpacing;

/// A box with its exact distance and a particle a square of its surface, each `apart` m wide or nearly so.
struct Box {
  glm::vec3 low, high;
  SurfaceSamples surface;
  std::vector<float> values;
  DistanceFieldView field;

  Box(const glm::vec3& from, const glm::vec3& to, float apart = kSpacing, float cell = 0.5f * kSpacing)
      : low(from), high(to) {
    surface.apart = apart;
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const glm::ivec3 many = glm::max(glm::ivec3(glm::round((high - low) / apart)), 1);
      const glm::vec3 pitch = (high - low) / glm::vec3(many);
      for (int i = 0; i < many[u] * many[v]; ++i) {
        for (const float side : {-1.0f, 1.0f}) {
          glm::vec3 p, normal(0.0f);
          p[axis] = side < 0.0f ? low[axis] : high[axis];
          p[u] = low[u] + (static_cast<float>(i % many[u]) + 0.5f) * pitch[u];
          p[v] = low[v] + (static_cast<float>(i / many[u]) + 0.5f) * pitch[v];
          normal[axis] = side;
          surface.positions.push_back(p);
          surface.normals.push_back(normal);
        }
      }
    }
    field.cell = cell;
    field.origin = low - 3.0f * kSpacing - 0.17f * field.cell;
    field.size = glm::ivec3(glm::ceil((high - low + 6.0f * kSpacing) / field.cell)) + 2;
    for (int k = 0; k < field.size.z; ++k) {
      for (int j = 0; j < field.size.y; ++j) {
        for (int i = 0; i < field.size.x; ++i) {
          const glm::vec3 p = field.origin + field.cell * glm::vec3(i, j, k);
          const glm::vec3 q = glm::max(low - p, p - high);
          values.push_back(glm::length(glm::max(q, 0.0f)) + std::min(std::max({q.x, q.y, q.z}), 0.0f));
        }
      }
    }
  }
  FixedSolid solid(const Pose& pose = {}) {
    field.distance = values.data();
    return {&surface, field, pose, kDepth};
  }
};

// An L in x and y, long in z: a floor 12 by 5 cm, a wall of 5 by 8 cm on its left end.
constexpr glm::vec3 kFloorLow(-0.06f, -0.05f, -0.06f), kFloorHigh(0.06f, 0.0f, 0.06f);
constexpr glm::vec3 kWallLow(-0.06f, 0.0f, -0.06f), kWallHigh(-0.01f, 0.08f, 0.06f);
const std::vector<glm::vec2> kOutline = {{-0.06f, -0.05f}, {0.06f, -0.05f}, {0.06f, 0.0f},
                                         {-0.01f, 0.0f},   {-0.01f, 0.08f}, {-0.06f, 0.08f}};

float distance_to_outline(const glm::vec2& p) {
  float least = 1.0f;
  for (std::size_t i = 0; i < kOutline.size(); ++i) {
    const glm::vec2 a = kOutline[i], along = kOutline[(i + 1) % kOutline.size()] - a;
    const float at = std::clamp(glm::dot(p - a, along) / glm::dot(along, along), 0.0f, 1.0f);
    least = std::min(least, glm::distance(p, a + at * along));
  }
  return least;
}

// Both bodies' particles in the world, those near the ends in z left out.
std::vector<glm::vec3> in_the_middle(const std::vector<std::vector<LayerParticle>>& layers,
                                     const std::vector<Pose>& poses) {
  std::vector<glm::vec3> all;
  for (std::size_t b = 0; b < layers.size(); ++b) {
    for (const LayerParticle& p : layers[b]) {
      const glm::vec3 world = moved(poses[b], p).position;
      if (std::abs(world.z) < 0.04f) all.push_back(world);
    }
  }
  return all;
}

void expect_one_sheet(const std::vector<glm::vec3>& particles, float apart = kSpacing) {
  ASSERT_FALSE(particles.empty());
  for (const glm::vec3& p : particles) {
    const float depth = distance_to_outline({p.x, p.y}) / kSpacing;
    EXPECT_NEAR(depth, 0.7f, 0.06f) << "at " << p.x << ", " << p.y;
  }
  // The line at that depth, walked along: a particle is near everywhere.
  for (float x = -0.07f; x < 0.07f; x += 0.1f * kSpacing) {
    for (float y = -0.06f; y < 0.09f; y += 0.1f * kSpacing) {
      const bool inside = (x > kFloorLow.x && x < kFloorHigh.x && y > kFloorLow.y && y < kFloorHigh.y) ||
                          (x > kWallLow.x && x < kWallHigh.x && y >= kWallLow.y && y < kWallHigh.y);
      if (!inside || std::abs(distance_to_outline({x, y}) - kDepth) > 0.05f * kSpacing) continue;
      float nearest = 1.0f;
      for (const glm::vec3& p : particles)
        nearest = std::min(nearest, glm::distance(p, glm::vec3(x, y, 0.0f)));
      EXPECT_LT(nearest / apart, 0.9f) << "hole at " << x << ", " << y;
    }
  }
}

TEST(JoinedWalls, AWallOnAFloorIsOneSolid) {
  Box floor(kFloorLow, kFloorHigh), wall(kWallLow, kWallHigh);
  const std::vector<FixedSolid> solids = {floor.solid(), wall.solid()};
  expect_one_sheet(in_the_middle(joined_layers(solids, kSpacing), {Pose{}, Pose{}}));
}

// Along free-slip walls layers are finer (boundary_spacing), and so is what fills their edges. With a floor
// along which fluid slides and a wall at which it stands each has its own.
TEST(JoinedWalls, FinerSheetsMeetAsWell) {
  constexpr float kFine = 0.7f * kSpacing;
  for (const float of_wall : {kFine, kSpacing}) {
    Box floor(kFloorLow, kFloorHigh, kFine), wall(kWallLow, kWallHigh, of_wall);
    const std::vector<FixedSolid> solids = {floor.solid(), wall.solid()};
    expect_one_sheet(in_the_middle(joined_layers(solids, kSpacing), {Pose{}, Pose{}}), of_wall);
  }
}

TEST(JoinedWalls, EachHasItsOwnFrame) {
  const Pose turned{{0.3, -0.2, 0.1}, glm::angleAxis(0.5 * 3.14159265358979, glm::dvec3(0.0, 0.0, 1.0))};
  const auto local = [&](const glm::vec3& p) {
    return glm::vec3(transform_point(inverse(turned), glm::dvec3(p)));
  };
  const glm::vec3 a = local(kWallLow), b = local(kWallHigh);
  Box floor(kFloorLow, kFloorHigh), wall(glm::min(a, b), glm::max(a, b));
  const std::vector<FixedSolid> solids = {floor.solid(), wall.solid(turned)};
  expect_one_sheet(in_the_middle(joined_layers(solids, kSpacing), {Pose{}, turned}));
}

TEST(JoinedWalls, OverlappingOnesToo) {
  Box floor(kFloorLow, kFloorHigh), wall({kWallLow.x, -0.021f, kWallLow.z}, kWallHigh);
  const std::vector<FixedSolid> solids = {floor.solid(), wall.solid()};
  expect_one_sheet(in_the_middle(joined_layers(solids, kSpacing), {Pose{}, Pose{}}));
}

// Round the edge between floor and wall each place is as near to the one face as to the other. As that was
// told by discs around samples, rounding decided whose a whole edge was: side walls read 3 % more or less.
TEST(JoinedWalls, WhatFillsAnEdgeIsOfTheFaceItIsFartherBehind) {
  int found[2] = {};
  for (const float apart : {1.0f, 0.97f, 0.93f, 0.9f, 0.83f}) {
    Box floor(kFloorLow, kFloorHigh, apart * kSpacing), wall(kWallLow, kWallHigh, kSpacing);
    const std::vector<FixedSolid> solids = {floor.solid(), wall.solid()};
    const std::vector<std::vector<LayerParticle>> layers = joined_layers(solids, kSpacing);
    for (std::size_t b = 0; b < 2; ++b) {
      for (const LayerParticle& particle : layers[b]) {
        const glm::vec3& p = particle.position;
        const float below = kFloorHigh.y - p.y, behind = kWallHigh.x - p.x;
        const bool in_edge =
            below > 0.0f && behind > 0.0f && glm::length(glm::vec2(below, behind)) < 1.2f * kDepth;
        if (!in_edge || std::abs(p.z) > 0.04f || std::abs(below - behind) < 0.02f * kDepth) continue;
        EXPECT_EQ(b, below > behind ? 0u : 1u) << apart << ": " << below << " below, " << behind << " behind";
        ++found[b];
      }
    }
  }
  EXPECT_GT(found[0], 20);
  EXPECT_GT(found[1], 20);
}

TEST(JoinedWalls, ThoseThatStandApartAreLeftAlone) {
  for (const float gap : {0.2f, 0.4f}) {
    Box floor(kFloorLow, kFloorHigh), table({0.1f, -0.05f, -0.06f}, {0.2f, 0.0f, 0.06f});
    const glm::vec3 up(0.0f, gap * kSpacing, 0.0f);
    Box wall(kWallLow + up, kWallHigh + up);
    const std::vector<FixedSolid> solids = {floor.solid(), table.solid(), wall.solid()};
    const std::vector<std::vector<LayerParticle>> layers = joined_layers(solids, kSpacing);
    EXPECT_TRUE(layers[1].empty());
    for (const std::size_t b : {0u, 2u}) EXPECT_EQ(layers[b].empty(), gap > 0.25f) << gap << ", body " << b;
  }
}

// Where three bodies meet, the end of a hidden face lies at the edges of both others, where a field is round:
// layers bent round what was taken for open there, and still water left through it. On the other hand no
// sample of what is open may be hidden.
TEST(JoinedWalls, FacesAreHiddenUpToTheirEnds) {
  for (const float cell : {0.3f, 0.5f, 0.76f}) {
    for (const float off : {0.0f, 0.13f, 0.31f, 0.5f}) {
      const glm::vec3 by = off * kSpacing * glm::vec3(1.0f, 0.0f, 0.4f);
      const std::vector<std::pair<glm::vec3, glm::vec3>> sides = {
          {glm::vec3(-0.11f, -0.05f, -0.11f), glm::vec3(0.06f, 0.0f, 0.06f)},        // floor
          {glm::vec3(-0.11f, 0.0f, -0.11f) - by, glm::vec3(-0.06f, 0.08f, 0.06f)},   // left
          {glm::vec3(-0.06f, 0.0f, -0.11f), glm::vec3(0.06f, 0.08f, -0.06f) + by}};  // back
      std::vector<Box> boxes;
      boxes.reserve(sides.size());
      std::vector<FixedSolid> solids;
      for (const auto& [low, high] : sides) {
        boxes.emplace_back(low, high, kSpacing, cell * kSpacing);
        solids.push_back(boxes.back().solid());
      }
      const auto beyond = [&](std::size_t b, const glm::vec3& p) {
        const glm::vec3 q = glm::max(boxes[b].low - p, p - boxes[b].high);
        return std::max({q.x, q.y, q.z});
      };
      const TouchingSolids touch = touching(solids, kSpacing);
      for (std::size_t b = 0; b < solids.size(); ++b) {
        for (const SolidSample& s : touch.samples[b]) {
          const glm::vec3 before = s.position + 0.25f * kSpacing * s.normal;
          float least = 1.0f;
          for (std::size_t o = 0; o < solids.size(); ++o)
            if (o != b) least = std::min(least, beyond(o, before));
          if (least < -1e-6f || least > 0.21f * kSpacing) {
            EXPECT_EQ(s.hidden, least < 0.0f) << b << " of cells of " << cell << ", off by " << off;
          }
        }
      }
    }
  }
}

// What drags stands on the surface: where a wall stands on a floor, neither's face under it does.
TEST(JoinedWalls, WhatAnotherHidesIsNotExposed) {
  Box floor(kFloorLow, kFloorHigh), wall(kWallLow, kWallHigh);
  const std::vector<FixedSolid> solids = {floor.solid(), wall.solid()};
  const std::vector<std::vector<std::uint32_t>> exposed = exposed_samples(solids, kSpacing);
  for (std::size_t b = 0; b < solids.size(); ++b) {
    const std::vector<glm::vec3>& all = solids[b].surface->positions;
    EXPECT_LT(exposed[b].size(), all.size());
    std::size_t open = 0;
    for (const glm::vec3& p : all) open += sample_distance(solids[1 - b].field, p).distance > 0.5f * kSpacing;
    EXPECT_GE(exposed[b].size(), open);
    for (const std::uint32_t i : exposed[b])
      EXPECT_GT(sample_distance(solids[1 - b].field, all[i]).distance, -0.3f * kSpacing);
  }
  const std::vector<FixedSolid> alone = {floor.solid()};
  EXPECT_EQ(exposed_samples(alone, kSpacing)[0].size(), alone[0].surface->positions.size());
}

// What the clamp reads between two that touch is as deep as in one piece; where fluid is, and within open
// faces, it reads what it did.
TEST(JoinedWalls, AJointIsAsDeepAsOnePiece) {
  for (const float cell : {0.5f, 0.76f}) {
    Box floor(kFloorLow, kFloorHigh, kSpacing, cell * kSpacing);
    Box wall(kWallLow, kWallHigh, kSpacing, cell * kSpacing);
    const std::vector<FixedSolid> solids = {floor.solid(), wall.solid()};
    std::vector<DistanceField> own, closed;
    for (const FixedSolid& s : solids) {
      const std::size_t nodes = static_cast<std::size_t>(s.field.size.x) * s.field.size.y * s.field.size.z;
      own.push_back(
          {s.field.origin, s.field.cell, s.field.size, {s.field.distance, s.field.distance + nodes}});
    }
    closed = own;
    close_joints(solids, kSpacing, std::vector<DistanceField*>{&closed[0], &closed[1]});
    for (float y = -0.4f; y < 0.45f; y += 0.1f) {
      for (float behind = 0.6f; behind < 2.8f; behind += 0.1f) {
        const glm::vec3 p(kWallHigh.x - behind * kSpacing, y * kSpacing, 0.0f);
        const float depth = std::min(glm::length(glm::vec2(behind, std::min(y, 0.0f))), 2.0f) * kSpacing;
        for (const DistanceField& field : closed)
          EXPECT_LT(sample_distance(field.view(), p).distance, -0.75f * depth)
              << y << ", " << behind << " behind";
      }
    }
    for (std::size_t b = 0; b < 2; ++b) {
      for (float x = 0.02f; x < 0.055f; x += 0.1f * kSpacing) {
        for (float y = -0.6f * kSpacing; y < 2.0f * kSpacing; y += 0.1f * kSpacing) {
          const glm::vec3 p(x, y, 0.0f);
          EXPECT_EQ(sample_distance(closed[b].view(), p).distance, sample_distance(own[b].view(), p).distance)
              << x << ", " << y;
        }
      }
    }
  }
}

// A plate of a spacing on a block: nothing of it is inside the block, all of what it covers is
// hidden.
TEST(JoinedWalls, AThinPlateHasItsOuterFace) {
  Box block(kFloorLow, kFloorHigh), plate({-0.06f, 0.0f, -0.06f}, {0.06f, kSpacing, 0.06f});
  const std::vector<FixedSolid> solids = {block.solid(), plate.solid()};
  const std::vector<std::vector<LayerParticle>> layers = joined_layers(solids, kSpacing);
  int top = 0;
  for (const std::vector<LayerParticle>& sheet : layers) {
    for (const LayerParticle& particle : sheet) {
      const glm::vec3& p = particle.position;
      if (glm::max(std::abs(p.x), std::abs(p.z)) > 0.04f || p.y < -0.02f) continue;
      EXPECT_NEAR(p.y / kSpacing, 1.0f - 0.7f, 0.06f);
      ++top;
    }
  }
  EXPECT_NEAR(top, 64, 12);  // 8 by 8 spacings
}

}  // namespace
}  // namespace slosh
