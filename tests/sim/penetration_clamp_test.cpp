// A particle's way against walls, one by one: thin ones, moving ones, corners, joints.
#include "sim/walls/penetration_clamp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scenes/sample.h"
#include "sim/bodies/rigid_body.h"
#include "sim/walls/clamp_bodies.h"
#include "sim/walls/clamp_impulse.h"

namespace slosh {
namespace {

constexpr float kSpacing = 0.01f;
constexpr float kDepth = 0.35f * kSpacing;
constexpr float kRounding = 1e-6f;  // m

/// A solid given by its exact distance on a grid as the sampler's, moving from `before` to `after`.
struct Solid {
  std::vector<float> values;
  ClampBody body;

  template <class Distance>
  Solid(const glm::vec3& low, const glm::vec3& high, Distance distance) {
    DistanceFieldView& f = body.field;
    f.cell = 0.5f * kSpacing;
    // Off the solid's own planes, as any mesh is.
    f.origin = low - 3.0f * kSpacing - 0.17f * f.cell;
    f.size = glm::ivec3(glm::ceil((high - low + 6.0f * kSpacing) / f.cell)) + 2;
    for (int k = 0; k < f.size.z; ++k) {
      for (int j = 0; j < f.size.y; ++j) {
        for (int i = 0; i < f.size.x; ++i) values.push_back(distance(f.origin + f.cell * glm::vec3(i, j, k)));
      }
    }
    body.depth = kDepth;
    view();
  }
  Solid(const Solid& other) : values(other.values), body(other.body) { view(); }
  void view() { body.field.distance = values.data(); }
  float distance(const glm::vec3& world) const {
    return sample_distance(body.field, glm::transpose(body.after.turn) * (world - body.after.shift)).distance;
  }
};

float box_distance(const glm::vec3& p, const glm::vec3& low, const glm::vec3& high) {
  const glm::vec3 q = glm::max(low - p, p - high);
  return glm::length(glm::max(q, 0.0f)) + std::min(std::max({q.x, q.y, q.z}), 0.0f);
}

Solid box(const glm::vec3& low, const glm::vec3& high) {
  return Solid(low, high, [&](const glm::vec3& p) { return box_distance(p, low, high); });
}
/// A plate with x from 0 to `thickness` spacings.
Solid plate(float thickness) {
  return box({0.0f, -0.06f, -0.06f}, {thickness * kSpacing, 0.06f, 0.06f});
}

/// Rules nobody out.
BoundingSphere everywhere(std::uint32_t) {
  return {glm::vec3(0.0f), 10.0f};
}

/// From -1 to 1, the same in each run.
struct Noise {
  unsigned state;
  float operator()() {
    state = state * 1664525u + 1013904223u;
    return static_cast<float>(state >> 8) / 8388608.0f - 1.0f;
  }
};

TEST(PenetrationClamp, leaves_alone_what_stays_outside) {
  const Solid wall = plate(1.5f);
  const glm::vec3 from(-0.5f * kSpacing, 0.0f, 0.0f);
  glm::vec3 x(-0.1f * kSpacing, 0.3f * kSpacing, 0.0f), v(1.0f, 2.0f, 3.0f);
  const glm::vec3 x_before = x, v_before = v;
  EXPECT_FALSE(clamp_particle(wall.body, from, x, v));
  x.x = 0.3f * kSpacing;
  EXPECT_FALSE(clamp_particle(wall.body, from, x, v)) << "shallower than the depth";
  EXPECT_EQ(x.y, x_before.y);
  EXPECT_EQ(v, v_before);
}

class Thickness : public ::testing::TestWithParam<float> {};

// From fast to slow, over the whole plate and half of it, at every place in the field's cells.
TEST_P(Thickness, no_way_leads_through) {
  const Solid wall = plate(GetParam());
  const float back = GetParam() * kSpacing;
  for (int place = 0; place < 40; ++place) {
    const float y = -0.04f + 0.002f * static_cast<float>(place);
    for (const float length : {0.02f, 0.1f, 0.5f, 1.0f, 2.5f, 8.0f}) {
      glm::vec3 x(-0.4f * kSpacing, y, 0.003f), v;
      for (int step = 0; step < 200; ++step) {
        const glm::vec3 from = x;
        v = {1.0f, 0.2f, 0.0f};
        x += length * kSpacing * glm::vec3(1.0f, 0.0f, 0.0f);
        clamp_particle(wall.body, from, x, v);
        ASSERT_LT(x.x, 0.5f * back) << "length " << length << ", step " << step << ", y " << y;
      }
      EXPECT_LE(v.x, 1e-6f);
      EXPECT_NEAR(v.y, 0.2f, 1e-3f) << "it slides";
      EXPECT_GE(wall.distance(x), -kDepth - kRounding);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(spacings, Thickness, ::testing::Values(1.0f, 1.2f, 1.33f, 1.5f, 3.0f));

// Two plates with less between them than the field tells apart, and a particle that is pushed out of the one
// and into the other: it got as fast as particles may be, and stayed so where it was.
TEST(PenetrationClamp, a_slit_takes_the_speed_of_what_is_pressed_into_it) {
  for (const float slit : {0.1f, 0.2f, 0.3f}) {
    const float far = 1.0f + slit;
    const Solid plates(
        glm::vec3(0.0f, -0.06f, -0.06f), {(far + 1.0f) * kSpacing, 0.06f, 0.06f}, [&](const glm::vec3& p) {
          return std::min(
              box_distance(p, {0.0f, -0.06f, -0.06f}, {kSpacing, 0.06f, 0.06f}),
              box_distance(p, {far * kSpacing, -0.06f, -0.06f}, {(far + 1.0f) * kSpacing, 0.06f, 0.06f}));
        });
    constexpr float kStep = 0.002f, kPush = 0.5f;  // s, m/s a step
    glm::vec3 x(0.9f * kSpacing, 0.0f, 0.0f), v(0.0f);
    int held = 0;
    for (int step = 0; step < 50; ++step) {
      v.x += kPush;
      const glm::vec3 from = x;
      x += kStep * v;
      held += clamp_particle(plates.body, from, x, v) ? 1 : 0;
      EXPECT_LT(v.x, 2.5f * kPush) << "slit of " << slit << " spacings, step " << step;
    }
    EXPECT_GT(held, 15) << slit;
  }
}

// A particle at rest, and a wall that comes over it: up to eight spacings a step.
TEST(PenetrationClamp, wall_that_overtakes_takes_the_particle_along) {
  for (const float way : {0.2f, 1.0f, 4.0f, 8.0f}) {
    Solid wall = plate(1.0f);
    const float dt = 0.002f;
    wall.body.after.velocity = glm::vec3(-way * kSpacing / dt, 0.0f, 0.0f);
    glm::vec3 x(-0.5f * kSpacing, 0.0f, 0.0f), v(0.0f);
    for (int step = 0; step < 50; ++step) {
      wall.body.before.shift = wall.body.after.shift;
      wall.body.after.shift += dt * wall.body.after.velocity;
      const glm::vec3 from = x;
      x += dt * v;
      clamp_particle(wall.body, from, x, v);
      ASSERT_LT(x.x - wall.body.after.shift.x, 0.5f * kSpacing) << way << " spacings a step, step " << step;
    }
    EXPECT_NEAR(v.x / wall.body.after.velocity.x, 1.0f, 1e-4f) << way;
  }
}

// Turned by 20° in a step about a far axis: what it pushes goes as fast as the wall does there.
TEST(PenetrationClamp, wall_that_turns) {
  Solid wall = plate(1.0f);
  const float angle = 0.35f, dt = 0.01f, c = std::cos(angle), s = std::sin(angle);
  wall.body.after.turn = glm::mat3(c, s, 0.0f, -s, c, 0.0f, 0.0f, 0.0f, 1.0f);
  wall.body.after.angular_velocity = {0.0f, 0.0f, angle / dt};
  const glm::vec3 from(-0.5f * kSpacing, 0.05f, 0.0f);
  glm::vec3 x = from, v(0.0f);
  EXPECT_TRUE(clamp_particle(wall.body, from, x, v));
  EXPECT_GE(wall.distance(x), -kDepth - kRounding);
  const glm::vec3 normal = wall.body.after.turn * glm::vec3(-1.0f, 0.0f, 0.0f);
  EXPECT_LT(glm::dot(x, normal), kDepth);
  EXPECT_NEAR(glm::dot(v, normal), glm::dot(wall.body.after.velocity_at(x), normal), 1e-3f);
}

// Into the corner of a vessel, along no wall in particular.
TEST(PenetrationClamp, corner_of_a_vessel_holds) {
  const glm::vec3 half(0.04f), wall(1.5f * kSpacing);
  const Solid vessel(-half - wall, half + wall, [&](const glm::vec3& p) {
    return std::max(box_distance(p, -half - wall, half + wall), -box_distance(p, -half, half));
  });
  Noise noise{3};
  for (int particle = 0; particle < 200; ++particle) {
    glm::vec3 x = 0.035f * glm::vec3(noise(), noise(), noise()), v(0.0f);
    glm::vec3 way = glm::normalize(glm::vec3(noise(), noise(), noise())) * kSpacing;
    for (int step = 0; step < 60; ++step) {
      if (step % 20 == 0) way = glm::normalize(glm::vec3(noise(), noise(), noise())) * 1.5f * kSpacing;
      const glm::vec3 from = x;
      x += way;
      clamp_particle(vessel.body, from, x, v);
      const glm::vec3 out = glm::abs(x) - half;
      ASSERT_LT(std::max({out.x, out.y, out.z}), 0.5f * kSpacing) << "particle " << particle;
    }
  }
}

// Within a cell of a convex corner the field has no slope, as in the middle of a wall. Taken for one, whoever
// grazed it was drawn a third of a spacing into it, and who was pressed there was kept: it gained speed step
// by step, until it left at the limit.
class ConvexCorner : public ::testing::TestWithParam<float> {};  // where in a cell of the field, cells

TEST_P(ConvexCorner, lets_go_whom_walls_push_out) {
  const float half = 0.02f + GetParam() * 0.5f * kSpacing;
  const Solid cube = box(glm::vec3(-half), glm::vec3(half));
  int within = 0;
  for (int n = 0; n < 8 * 8 * 8; ++n) {
    const glm::vec3 behind = 0.07f * kSpacing * (glm::vec3(n % 8, n / 8 % 8, n / 64) + 0.5f);
    const glm::vec3 from = glm::vec3(half) - behind;
    if (cube.distance(from) < -kDepth) continue;
    for (const float length : {0.1f, 0.3f, 1.0f}) {
      for (const glm::vec3& way :
           {glm::vec3(1.0f), glm::vec3(0.9f, 1.2f, 0.8f), glm::vec3(2.0f, 1.0f, 1.0f)}) {
        glm::vec3 x = from + length * kSpacing * glm::normalize(way), v = way;
        EXPECT_FALSE(clamp_particle(cube.body, from, x, v))
            << length << " spacings from " << behind.x << " " << behind.y << " " << behind.z
            << " m behind its faces";
        ++within;
      }
    }
  }
  EXPECT_GT(within, 2000);
}

TEST_P(ConvexCorner, lets_pass_whoever_grazes_it) {
  const float half = 0.02f + GetParam() * 0.5f * kSpacing;
  const glm::vec3 corner(half);
  const Solid cube = box(-corner, corner);
  Noise noise{7};
  int grazing = 0;
  for (int n = 0; n < 20000; ++n) {
    const glm::vec3 from = corner + 0.5f * kSpacing * glm::vec3(noise(), noise(), noise());
    const glm::vec3 to = corner + 0.5f * kSpacing * glm::vec3(noise(), noise(), noise());
    float deepest = 0.0f;
    for (int i = 0; i <= 50; ++i)
      deepest = std::max(deepest,
                         -box_distance(glm::mix(from, to, 0.02f * static_cast<float>(i)), -corner, corner));
    if (deepest == 0.0f || deepest > 0.3f * kDepth) continue;
    ++grazing;
    glm::vec3 x = to, v = to - from;
    EXPECT_FALSE(clamp_particle(cube.body, from, x, v)) << deepest / kSpacing << " spacings deep";
  }
  EXPECT_GT(grazing, 1000);
}

INSTANTIATE_TEST_SUITE_P(cells, ConvexCorner, ::testing::Values(0.0f, 0.15f, 0.3f, 0.45f, 0.6f, 0.75f));

// Floor and wall are two bodies that touch: one sends the particle to the other and back.
TEST(PenetrationClamp, joint_of_two_bodies_holds) {
  const Solid bodies[] = {box({-0.06f, -0.015f, -0.06f}, {0.06f, 0.0f, 0.06f}),
                          box({0.0f, -0.015f, -0.06f}, {0.015f, 0.06f, 0.06f})};
  const auto at = [&](std::uint32_t b) -> const ClampBody& { return bodies[b].body; };
  glm::vec3 x(-0.5f * kSpacing, 0.5f * kSpacing, 0.0f), v(1.0f, -1.0f, 0.5f);
  int taken[2] = {0, 0};
  for (int step = 0; step < 50; ++step) {
    const glm::vec3 from = x;
    x += glm::vec3(0.8f, -0.8f, 0.1f) * kSpacing;
    clamp_against_all(everywhere, at, 2, true, from, x, v, [&](std::uint32_t b, auto&&...) { ++taken[b]; });
    ASSERT_LT(x.x, 0.5f * kSpacing);
    ASSERT_GT(x.y, -0.5f * kSpacing);
    x.z = 0.0f;
  }
  EXPECT_GT(taken[0], 0);
  EXPECT_GT(taken[1], 0);
  EXPECT_LE(v.x, 1e-5f);
  EXPECT_GE(v.y, -1e-5f);
  EXPECT_NEAR(v.z, 0.5f, 1e-4f);
}

TEST(PenetrationClamp, far_particles_meet_fast_bodies_only) {
  Solid wall = plate(1.5f);
  const auto at = [&](std::uint32_t) -> const ClampBody& { return wall.body; };
  for (const bool fast : {false, true}) {
    wall.body.fast = fast;
    glm::vec3 x(kSpacing, 0.0f, 0.0f), v(1.0f, 0.0f, 0.0f);
    EXPECT_EQ(clamp_against_all(everywhere, at, 1, false, {-kSpacing, 0.0f, 0.0f}, x, v, [](auto&&...) {}),
              fast);
  }
}

// A ball that flies and spins, and particles around it that go up to two spacings.
TEST(PenetrationClamp, bounding_spheres_rule_out_nobody_who_is_bent) {
  const float radius = 2.5f * kSpacing;
  const Solid ball(glm::vec3(-radius), glm::vec3(radius),
                   [&](const glm::vec3& p) { return glm::length(p) - radius; });
  const DistanceFieldView& view = ball.body.field;
  const DistanceField field{view.origin, view.cell, view.size, ball.values};
  const ClampSolid solid = clamp_solid(field, view);
  EXPECT_LT(solid.radius, radius + 3.0f * view.cell);
  Plan plan;
  plan.spacing = kSpacing;
  plan.support_radius = 2.0 * kSpacing;
  Noise noise{11};
  const auto any = [&] { return glm::vec3(noise(), noise(), noise()); };
  int bent = 0, ruled_out = 0;
  for (int n = 0; n < 20000; ++n) {
    RigidBody before, after;
    after.position = glm::dvec3(kSpacing * any());
    after.velocity = after.position / 0.01;
    after.orientation = glm::angleAxis(0.3 * noise(), glm::normalize(glm::dvec3(any())));
    ClampBodies placed;
    place_clamp_bodies({&solid, 1}, plan, {&before, 1}, {&after, 1}, placed);
    const glm::vec3 from = 6.0f * kSpacing * any(), to = from + 2.0f * kSpacing * any();
    const auto end = [&](auto&& sphere_at) {
      glm::vec3 x = to, v = 100.0f * (to - from);
      clamp_against_all(
          sphere_at, [&](std::uint32_t) -> const ClampBody& { return placed.bodies[0]; }, 1, true, from, x, v,
          [](auto&&...) {});
      return std::pair(x, v);
    };
    const auto all = end(everywhere);
    ASSERT_EQ(end([&](std::uint32_t) { return placed.spheres[0]; }), all) << "particle " << n;
    bent += all.first != to;
    ruled_out += !placed.spheres[0].meets(to, glm::distance(from, to));
  }
  EXPECT_GT(bent, 200);
  EXPECT_GT(ruled_out, 2000);
}

// Bodies that are away cannot be met, and every particle near a wall would look at each.
TEST(PenetrationClamp, looks_at_bodies_that_are_there) {
  const glm::vec3 half(2.0f * kSpacing, kSpacing, kSpacing);
  const Solid box(-half, half, [&](const glm::vec3& p) {
    const glm::vec3 off = glm::abs(p) - half;
    return glm::length(glm::max(off, 0.0f)) + std::min(std::max({off.x, off.y, off.z}), 0.0f);
  });
  const DistanceFieldView& view = box.body.field;
  const ClampSolid solid = clamp_solid({view.origin, view.cell, view.size, box.values}, view);
  const std::vector<ClampSolid> solids{solid, {}, solid, solid, solid};
  std::vector<RigidBody> before(5);
  put_away(before[2]);
  put_away(before[3]);
  std::vector<RigidBody> after = before;
  after[3] = RigidBody{};
  Plan plan;
  plan.spacing = kSpacing;
  plan.support_radius = 2.0 * kSpacing;
  ClampBodies placed;
  for (int again = 0; again < 2; ++again) place_clamp_bodies(solids, plan, before, after, placed);
  EXPECT_EQ(placed.numbers, (std::vector<std::uint32_t>{0, 3, 4})) << "one without a solid, one that is away";
  EXPECT_EQ(placed.bodies.size(), 3u);
  EXPECT_EQ(placed.spheres.size(), 3u);
}

// A part of a body has the whole's grid, and a ball of its own.
TEST(PenetrationClamp, bounding_spheres_are_around_the_solid_alone) {
  const glm::vec3 half(4.0f * kSpacing, kSpacing, kSpacing);
  const auto clamped = [&](float least) {
    const Solid part(-half, half, [&](const glm::vec3& p) {
      const glm::vec3 off = glm::abs(p) - half;
      return std::max(std::max({off.x, off.y, off.z}), least - p.x);
    });
    const DistanceFieldView& view = part.body.field;
    return clamp_solid({view.origin, view.cell, view.size, part.values}, view);
  };
  const ClampSolid whole = clamped(-half.x), quarter = clamped(0.5f * half.x);
  EXPECT_NEAR(quarter.middle.x, 0.75f * half.x, kSpacing);
  EXPECT_LT(quarter.radius, 0.6f * whole.radius);
}

// What a particle loses, in momentum and in angular momentum about any point, is what is written down, in
// whatever order it is added.
TEST(ClampImpulse, is_what_the_particle_lost) {
  const ImpulseUnits units = impulse_units(1e-3, 10.0, 0.01);
  const PutBack p{1e-3f, {0.1f, 0.2f, 0.3f}, {0.09f, 0.2f, 0.31f}, {3.0f, -2.0f, 1.0f}, {0.0f, -2.0f, 1.5f}};
  const glm::dvec3 center(0.5, -0.1, 0.2);
  ImpulseSums sums = no_impulses(1);
  impulse_on_body(p, center, units,
                  [&](int word, std::int64_t value) { sums[static_cast<std::size_t>(word)] += value; });
  const Wrench w = impulse_wrench(sums, units, 0.5);
  const double mass = p.mass;
  const glm::dvec3 before = mass * glm::dvec3(p.before), after = mass * glm::dvec3(p.after);
  const glm::dvec3 lost = glm::cross(glm::dvec3(p.from), before) - glm::cross(glm::dvec3(p.to), after);
  EXPECT_LT(glm::distance(0.5 * w.force, before - after), 1e-12);
  EXPECT_LT(glm::distance(0.5 * w.torque + glm::cross(center, 0.5 * w.force), lost), 1e-11);
  EXPECT_EQ(in_units(1e300, units.linear), -in_units(-1e300, units.linear)) << "bounded";
}

}  // namespace
}  // namespace slosh
