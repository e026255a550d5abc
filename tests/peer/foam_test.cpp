// Foam: the three potentials on states whose answer is known, and what a viewer makes of them.
#include "peer/view/foam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace slosh {
namespace {

constexpr float kSpacing = 0.01f;

Scene water(double viscosity = 0.001, float extinction = 5.0f) {
  Scene scene;
  scene.fluids.emplace_back();
  scene.fluids[0].dynamic_viscosity = viscosity;
  scene.fluids[0].extinction = glm::vec3(extinction);
  scene.domain_min = glm::dvec3(-10.0);
  scene.domain_max = glm::dvec3(10.0);
  return scene;
}

/// A jittered lattice where `inside` holds; the first particle is the one nearest to the origin.
template <class Inside>
std::vector<glm::vec3> lattice(int half, Inside&& inside) {
  std::vector<glm::vec3> points;
  std::uint32_t state = 7;
  const auto jitter = [&] {
    state = state * 1664525u + 1013904223u;
    return (static_cast<float>(state >> 8) / 16777216.0f - 0.5f) * 0.2f * kSpacing;
  };
  for (int z = -half; z <= half; ++z)
    for (int y = -half; y <= half; ++y)
      for (int x = -half; x <= half; ++x) {
        const glm::vec3 p = glm::vec3(x, y, z) * kSpacing + glm::vec3(jitter(), jitter(), jitter());
        if (inside(p)) points.push_back(p);
      }
  std::ranges::partial_sort(points, points.begin() + 1, {},
                            [](const glm::vec3& p) { return glm::length(p); });
  return points;
}

template <class Velocity>
FoamPotential of_first(const std::vector<glm::vec3>& points, Velocity&& velocity) {
  static const Scene scene = water();
  Foam foam(scene, kSpacing);
  std::vector<glm::vec3> velocities;
  for (const glm::vec3& p : points) velocities.push_back(velocity(p));
  return foam.potential(0, points, velocities);
}

TEST(FoamPotentials, AirIsTrappedWhereFluidMeetsFluid) {
  const auto block = lattice(5, [](const glm::vec3&) { return true; });
  const auto side = [](const glm::vec3& p) { return p.x < 0.0f ? 1.0f : -1.0f; };
  EXPECT_EQ(of_first(block, [](const glm::vec3&) { return glm::vec3(2.0f, 1.0f, 0.0f); }).trapped_air, 0.0f)
      << "all go one way";
  const float meet =
      of_first(block, [&](const glm::vec3& p) { return glm::vec3(side(p), 0, 0); }).trapped_air;
  const float part =
      of_first(block, [&](const glm::vec3& p) { return glm::vec3(-side(p), 0, 0); }).trapped_air;
  EXPECT_GT(meet, 0.8f);
  EXPECT_LT(part, 0.3f * meet);
  const float slow =
      of_first(block, [&](const glm::vec3& p) { return glm::vec3(0.1f * side(p), 0, 0); }).trapped_air;
  EXPECT_LT(slow, 0.05f);
}

TEST(FoamPotentials, ACrestIsConvexAndLeads) {
  const glm::vec3 up(0.0f, 1.5f, 0.0f);
  const auto rising = [&](const glm::vec3&) { return up; };
  const auto ridge = lattice(6, [](const glm::vec3& p) { return p.y < 0.004f - 0.8f * std::abs(p.x); });
  const auto flat = lattice(6, [](const glm::vec3& p) { return p.y < 0.004f; });
  const auto valley = lattice(6, [](const glm::vec3& p) { return p.y < 0.004f + 0.8f * std::abs(p.x); });
  const float crest = of_first(ridge, rising).wave_crest;
  EXPECT_GT(crest, 0.5f);
  EXPECT_LT(of_first(flat, rising).wave_crest, 0.15f);
  EXPECT_LT(of_first(valley, rising).wave_crest, 0.3f * crest);
  EXPECT_EQ(of_first(ridge, [&](const glm::vec3&) { return -up; }).wave_crest, 0.0f) << "it falls back";
  EXPECT_EQ(of_first(ridge, [](const glm::vec3&) { return glm::vec3(0, 0, 1.5f); }).wave_crest, 0.0f)
      << "it goes along the ridge";
  const auto inside = lattice(5, [](const glm::vec3&) { return true; });
  EXPECT_EQ(of_first(inside, rising).wave_crest, 0.0f) << "no surface";
}

TEST(FoamPotentials, EnergyIsHalfTheSpeedSquared) {
  const auto block = lattice(3, [](const glm::vec3&) { return true; });
  const auto at = [&](float speed) {
    return of_first(block, [&](const glm::vec3&) { return glm::vec3(0, speed, 0); }).energy;
  };
  EXPECT_EQ(at(0.0f), 0.0f);
  EXPECT_NEAR(at(0.6f), 0.0f, 1e-6f);
  EXPECT_NEAR(at(std::sqrt(2.0f * 0.69f)), 0.5f, 1e-3f) << "0.69 J/kg is halfway";
  EXPECT_EQ(at(1.6f), 1.0f);
}

Snapshot snapshot(double time, std::vector<glm::vec3> positions) {
  Snapshot s;
  s.rigid.time = time;
  s.fluid_index.assign(positions.size(), 0);
  s.positions = std::move(positions);
  return s;
}

/// Two blocks that run into each other at `speed`, `frames` pictures of it.
void collide(Foam& foam, float speed, int frames, int half = 5, std::uint8_t fluid = 0) {
  const auto block = lattice(half, [](const glm::vec3&) { return true; });
  for (int frame = 0; frame < frames; ++frame) {
    const float time = static_cast<float>(frame) / 60.0f;
    std::vector<glm::vec3> points = block;
    for (glm::vec3& p : points) p.x += (p.x < 0.0f ? 1.0f : -1.0f) * (speed * time - 0.03f);
    Snapshot s = snapshot(time, points);
    s.fluid_index.assign(points.size(), fluid);
    foam.record(s);
  }
}

TEST(FoamOnAPeer, IsLeftOutWhereTheSceneDoesNotNeedIt) {
  const Scene thin = water(), thick = water(5.0), milk = water(0.001, 500.0f);
  EXPECT_TRUE(plan_foam(thin).any());
  for (const Scene* scene : {&thick, &milk}) {
    EXPECT_FALSE(plan_foam(*scene).any());
    EXPECT_NE(plan_foam(*scene).reason.find("every fluid"), std::string::npos);
    Foam foam(*scene, kSpacing);
    collide(foam, 2.0f, 10);
    EXPECT_TRUE(foam.points().empty());
    EXPECT_EQ(foam.looked_at(), 0u);
  }
  // Water that moves gently is looked at for its speeds alone.
  Foam foam(thin, kSpacing);
  collide(foam, 0.3f, 20);
  EXPECT_TRUE(foam.points().empty());
  EXPECT_EQ(foam.looked_at(), 0u);
  EXPECT_EQ(plan_foam(Scene{}).reason, "there is no fluid");
}

TEST(FoamOnAPeer, IsThereWhereFluidIsViolentAndGoesAgain) {
  const Scene scene = water();
  Foam foam(scene, kSpacing);
  collide(foam, 2.0f, 4);
  ASSERT_GT(foam.points().size(), 20u);
  // It begins where the blocks meet.
  glm::vec3 mean(0.0f);
  for (const FoamPoint& p : foam.points()) {
    mean += p.position / static_cast<float>(foam.points().size());
    EXPECT_GT(p.opacity, 0.0f);
    EXPECT_LE(p.opacity, 1.0f);
    EXPECT_GT(p.radius, 0.0f);
    EXPECT_LT(p.radius, 0.5f * kSpacing);
  }
  EXPECT_LT(std::abs(mean.x), 0.02f);
  // The fluid rests: all of it is gone within the longest of its lives.
  const auto rest = lattice(5, [](const glm::vec3&) { return true; });
  for (int frame = 4; frame < 4 + 150; ++frame) foam.record(snapshot(frame / 60.0, rest));
  EXPECT_TRUE(foam.points().empty());
  EXPECT_EQ(foam.looked_at(), 0u);
}

/// A thin upright wall between x = `at` and `at` + 1 mm.
TriangleMesh thin_wall(float at) {
  TriangleMesh mesh;
  const glm::vec3 low(at, -0.3f, -0.3f), high(at + 0.001f, 0.3f, 0.3f);
  for (int corner = 0; corner < 8; ++corner)
    mesh.positions.emplace_back(corner & 1 ? high.x : low.x, corner & 2 ? high.y : low.y,
                                corner & 4 ? high.z : low.z);
  mesh.normals.assign(8, glm::vec3(0, 1, 0));
  for (const glm::uvec4& face : {glm::uvec4(0, 4, 6, 2), glm::uvec4(1, 3, 7, 5), glm::uvec4(0, 1, 5, 4),
                                 glm::uvec4(2, 6, 7, 3), glm::uvec4(0, 2, 3, 1), glm::uvec4(4, 5, 7, 6)}) {
    mesh.triangles.emplace_back(face.x, face.y, face.z);
    mesh.triangles.emplace_back(face.x, face.z, face.w);
  }
  return mesh;
}

TEST(FoamOnAPeer, NoDropPassesAWallHoweverThin) {
  Scene open = water();
  Scene walled = water();
  walled.meshes.push_back(thin_wall(0.02f));
  walled.bodies.emplace_back().mesh = 0;
  Foam with(walled, kSpacing), without(open, kSpacing);
  const auto beyond = [](const Foam& foam) {
    return std::ranges::count_if(foam.points(), [](const FoamPoint& p) { return p.position.x > 0.0205f; });
  };
  // Two blocks meet and go on together towards the wall, where a third rests behind it: there are particles
  // on both sides, so that nothing else takes a drop away.
  const auto block = lattice(5, [](const glm::vec3& p) { return p.x < 0.0f; });
  const auto behind = lattice(5, [](const glm::vec3& p) { return p.x > 0.025f; });
  long through = 0;
  for (int frame = 0; frame < 8; ++frame) {
    const float time = static_cast<float>(frame) / 60.0f;
    std::vector<glm::vec3> points = block;
    for (glm::vec3& p : points) p.x = std::min(p.x + (p.y < 0.0f ? 2.5f : 1.2f) * time, 0.019f);
    points.insert(points.end(), behind.begin(), behind.end());
    Snapshot now = snapshot(time, points);
    without.record(now);
    now.rigid.bodies.resize(1);
    with.record(now);
    through += beyond(without);
    EXPECT_EQ(beyond(with), 0);
  }
  EXPECT_GT(through, 10) << "without the wall some would";
  EXPECT_GT(with.points().size(), 20u);
}

TEST(FoamOnAPeer, AWallThatMovesTakesDropsAlong) {
  Scene scene;
  scene.meshes.push_back(thin_wall(0.0f));
  scene.bodies.emplace_back().mesh = 0;
  BodyWalls walls(scene, 0.001f);
  BodySnapshot now;
  now.bodies.resize(1);
  walls.move(now);
  const glm::vec3 still(0.05f, 0.0f, 0.0f);
  EXPECT_FALSE(walls.stop(still, still));
  now.bodies[0].pose.position.x = 0.1;  // it sweeps over the drop
  walls.move(now);
  const auto stopped = walls.stop(still, still);
  ASSERT_TRUE(stopped);
  EXPECT_NEAR(stopped->x, 0.102f, 1e-5f);
  EXPECT_FALSE(walls.stop_now(still, still));
  EXPECT_TRUE(walls.stop_now(still, {0.2f, 0.0f, 0.0f}));
  EXPECT_FALSE(walls.stop_now(still, {0.05f, 0.2f, 0.0f})) << "along the wall";
}

TEST(BodyWalls, TheNearestFaceIsThatOfTheBodyAsItStands) {
  Scene scene;
  for (int i = 0; i < 2; ++i) {
    scene.meshes.push_back(thin_wall(0.0f));
    scene.bodies.emplace_back().mesh = i;
  }
  BodyWalls walls(scene, 0.0f);
  BodySnapshot now;
  now.bodies.resize(2);
  std::vector<BodyState>& bodies = now.bodies;
  bodies[0].pose.position.x = 0.1;
  bodies[1].pose.position.x = 0.1;
  bodies[1].pose.orientation = glm::angleAxis(glm::half_pi<double>(), glm::dvec3(0.0, 0.0, 1.0));
  walls.move(now);
  const auto upright = walls.nearest({0.11f, 0.05f, 0.0f}, 0.02f);
  ASSERT_TRUE(upright);
  EXPECT_NEAR(upright->normal.x, 1.0f, 1e-5f);
  EXPECT_NEAR(upright->at.y, 0.05f, 1e-5f);
  EXPECT_LT(upright->at.x, 0.11f);
  const auto level = walls.nearest({0.15f, -0.01f, 0.0f}, 0.02f);
  ASSERT_TRUE(level);
  EXPECT_NEAR(level->normal.y, -1.0f, 1e-5f);
  EXPECT_NEAR(level->at.x, 0.15f, 1e-5f);
  EXPECT_FALSE(walls.nearest({0.15f, 0.05f, 0.0f}, 0.02f)) << "too far from both";
}

TEST(FoamOnAPeer, SprayIsGoneWhereNoParticleIs) {
  // It must not fly on alone.
  const Scene scene = water();
  Foam foam(scene, kSpacing);
  collide(foam, 2.0f, 4);
  ASSERT_FALSE(foam.points().empty());
  const auto block = lattice(5, [](const glm::vec3&) { return true; });
  const std::vector<glm::vec3> away(block.size(), glm::vec3(5.0f));
  foam.record(snapshot(4.0 / 60.0, away));
  EXPECT_TRUE(foam.points().empty());
}

TEST(FoamOnAPeer, CostsNoMoreThanItsBounds) {
  const Scene scene = water();
  Foam foam(scene, kSpacing);
  collide(foam, 3.0f, 12, 16);  // 35 937 particles, all fast
  EXPECT_LE(foam.points().size(), Foam::kMax);
  EXPECT_LE(foam.looked_at(), Foam::kMaxLooked);
  EXPECT_GT(foam.points().size(), Foam::kMax / 8);
}

TEST(FoamOnAPeer, RepeatsAndStartsAnewWithTheWorld) {
  const Scene scene = water();
  Foam a(scene, kSpacing), b(scene, kSpacing);
  collide(a, 2.0f, 6);
  collide(b, 2.0f, 6);
  ASSERT_EQ(a.points().size(), b.points().size());
  for (std::size_t i = 0; i < a.points().size(); ++i)
    EXPECT_EQ(a.points()[i].position, b.points()[i].position);
  a.record(snapshot(0.0, lattice(5, [](const glm::vec3&) { return true; })));
  EXPECT_TRUE(a.points().empty());
  // Particles that are not drawn, and numbers that are none, do no harm.
  Foam c(scene, kSpacing);
  collide(c, 2.0f, 6, 4, 255);
  EXPECT_TRUE(c.points().empty());
  for (int frame = 0; frame < 4; ++frame) {
    auto wild = lattice(4, [](const glm::vec3&) { return true; });
    wild[3].y = std::nanf("");
    wild[4].x = 1e30f * static_cast<float>(frame);
    for (glm::vec3& p : wild) p.z += 0.05f * static_cast<float>(frame);
    c.record(snapshot(frame / 60.0, wild));
  }
}

}  // namespace
}  // namespace slosh
