// Bodies on a table: rest, drop, slide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/physics/lab.h"

namespace slosh::lab {
namespace {

constexpr double kSpacing = 0.01;

struct OnTable {
  SceneBuilder b;
  int box = 0;
};

// A box of 8 × 6 × 8 cm whose underside is `height` above a table whose top is y = 0.
OnTable box_on_table(double height, double friction = 0.4) {
  OnTable t;
  const int table = t.b.add_fixed("table", make::box({-0.4, -0.04, -0.3}, {0.4, 0.0, 0.3}));
  t.box = t.b.add_free("box", make::box({-0.04, 0.0, -0.04}, {0.04, 0.06, 0.04}), 0.5,
                       {{0.0, height, 0.0}, {1, 0, 0, 0}});
  t.b.scene.bodies[table].friction = t.b.scene.bodies[t.box].friction = friction;
  t.b.set_domain({-1, -1, -1}, {1, 1, 1});
  return t;
}

// 0.2 mm is a fiftieth of the spacing; a resting body that creeps faster than 1 mm/s is seen to.
TEST(Contact, box_at_rest_stays_and_does_not_sink) {
  OnTable t = box_on_table(0.0);
  Experiment e(t.b.scene, kSpacing);
  double sunk = 0.0, speed = 0.0;
  e.run(2.0, [&] {
    const BodyState& box = e.bodies().bodies[t.box];
    sunk = std::max(sunk, std::abs(box.pose.position.y));
    if (e.bodies().time > 0.2) speed = std::max(speed, glm::length(box.twist.linear));
  });
  report_value("box at rest, way up or down", 1e3 * sunk, "mm");
  report_value("box at rest, largest speed", 1e3 * speed, "mm/s");
  EXPECT_LT(sunk, 2e-4);
  EXPECT_LT(speed, 1e-3);
}

// Restitution 0; a box that bounced with 0.3 would rise 9 mm.
TEST(Contact, dropped_box_does_not_bounce) {
  OnTable t = box_on_table(0.1);
  Experiment e(t.b.scene, kSpacing);
  double deepest = 0.0, rebound = 0.0;
  bool landed = false;
  e.run(1.0, [&] {
    const double y = e.bodies().bodies[t.box].pose.position.y;
    deepest = std::min(deepest, y);
    landed = landed || y < 1e-3;
    if (landed) rebound = std::max(rebound, y);
  });
  EXPECT_TRUE(landed);
  report_value("dropped box, deepest overlap", -1e3 * deepest, "mm");
  report_value("dropped box, rebound", 1e3 * rebound, "mm");
  EXPECT_GT(deepest, -1e-3);
  EXPECT_LT(rebound, 1e-3);
  EXPECT_NEAR(e.bodies().bodies[t.box].pose.position.y, 0.0, 2e-4);
  EXPECT_LT(glm::length(e.bodies().bodies[t.box].twist.linear), 1e-3);
}

// A probe of thirty times its particle's mass, which no fluid holds up: it used to fall through the floor and
// out of the world.
TEST(Contact, a_probe_that_is_let_go_stays_in_its_tank) {
  for (const bool wet : {false, true}) {
    SceneBuilder b;
    b.add_fixed("tank", tank_at_floor({0.1, 0.1, 0.1}, 0.02));
    if (wet) {
      b.add_fluid(1000.0, 0.05);
      b.add_volume(make::box({-0.05, 0.0, -0.05}, {0.05, 0.06, 0.05}));
    }
    Body probe;
    probe.name = "probe";
    probe.motion = BodyMotion::kFree;
    probe.point_probe = true;
    probe.mass.mass = 0.05;
    probe.pose.position = {0.01, 0.08, 0.0};
    b.scene.bodies.push_back(probe);
    b.set_domain({-0.2, -0.2, -0.2}, {0.2, 0.3, 0.2});
    Experiment e(b.scene, kSpacing);
    double lowest = 1.0;
    e.run(1.5, [&] { lowest = std::min(lowest, e.bodies().bodies[1].pose.position.y); });
    const BodyState& rests = e.bodies().bodies[1];
    report_value(wet ? "probe in water, lowest" : "probe in an empty tank, lowest", 1e3 * lowest, "mm");
    EXPECT_GT(lowest, -1e-3);
    EXPECT_LT(rests.pose.position.y, 0.01);
    EXPECT_LT(glm::length(rests.twist.linear), wet ? 0.05 : 1e-3);
  }
}

struct BouncingBox {
  SceneBuilder b;
  int box = 0;
  SampledScene sampled;
};

BouncingBox bouncing_box() {
  BouncingBox t;
  t.b.add_fixed("table", make::box({-0.4, -0.04, -0.3}, {0.4, 0.0, 0.3}));
  t.box = t.b.add_free("box", make::box(glm::dvec3(-0.03), glm::dvec3(0.03)), 0.1);
  t.b.set_domain({-1, -1, -1}, {1, 2, 1});
  t.sampled = sample_scene(t.b.scene, kSpacing).value();
  return t;
}

// The height of a bounce over the height of the fall. The step is the world's own or a part of it.
double bounce(BouncingBox& t, double fall, double restitution, double part_of_step) {
  Scene& scene = t.b.scene;
  scene.bodies[t.box].restitution = restitution;
  scene.bodies[t.box].pose.position = {0.0, 0.03 + fall, 0.0};
  Plan plan = make_plan(scene, kSpacing);
  plan.time_step *= part_of_step;
  World world(scene, t.sampled, plan, {1, Backend::kCpu});
  BodySnapshot now;
  bool rising = false;
  double highest = 0.0;
  while (world.time() < 1.2 * std::sqrt(2.0 * fall / kGravity) * (1.0 + restitution)) {
    world.step({});
    world.fill(now);
    rising = rising || now.bodies[t.box].twist.linear.y > 0.0;
    if (rising) highest = std::max(highest, now.bodies[t.box].pose.position.y - 0.03);
  }
  return highest / fall;
}

// Whatever the step, and wherever in a step the two meet: the height goes with the square of the restitution.
TEST(Contact, bounces_with_its_restitution_at_any_step_and_phase) {
  BouncingBox t = bouncing_box();
  double lowest = 1e9, highest = 0.0;
  for (const double restitution : {0.6, 0.9}) {
    for (const double part : {1.0, 0.37, 0.1}) {
      for (int phase = 0; phase < 6; ++phase) {
        const double share = bounce(t, 0.3 + 0.0013 * phase, restitution, part) / (restitution * restitution);
        lowest = std::min(lowest, share);
        highest = std::max(highest, share);
      }
    }
  }
  report_value("bounce over its nominal height, least", lowest, "");
  report_value("bounce over its nominal height, most", highest, "");
  EXPECT_GT(lowest, 0.97);
  EXPECT_LT(highest, 1.03);
}

// 10 mm inside the table: it comes out, and stays where it comes out.
TEST(Contact, undoing_an_overlap_leaves_no_velocity) {
  OnTable t = box_on_table(-0.01);
  Experiment e(t.b.scene, kSpacing);
  double highest = -1.0;
  e.run(1.0, [&] { highest = std::max(highest, e.bodies().bodies[t.box].pose.position.y); });
  report_value("box that starts 10 mm inside the table, highest", 1e3 * highest, "mm");
  EXPECT_LT(highest, 1e-4);
  EXPECT_GT(e.bodies().bodies[t.box].pose.position.y, -1e-4);
}

// 12 cm a step against a plate of 12 mm: it is seen on its way.
TEST(Contact, nothing_is_too_fast_for_a_plate) {
  for (int phase = 0; phase < 10; ++phase) {
    SceneBuilder b;
    b.add_fixed("plate", make::box({-0.3, -0.012, -0.3}, {0.3, 0.0, 0.3}));
    const int ball =
        b.add_free("ball", make::sphere(0.02, 12, 24), 0.05, {{0.0, 0.3 + 0.012 * phase, 0.0}, {1, 0, 0, 0}});
    b.scene.bodies[ball].twist.linear = {0.0, -30.0, 0.0};
    b.set_domain({-1, -1, -1}, {1, 2, 1});
    Experiment e(b.scene, kSpacing);
    e.run(0.5);
    EXPECT_NEAR(e.bodies().bodies[ball].center_of_mass.y, 0.02, 2e-3) << "phase " << phase;
  }
}

// Cubes of 2 cm, one on the other, the top one of `top` kg.
SceneBuilder stack_of(int count, double top = 0.02) {
  SceneBuilder b;
  b.add_fixed("table", make::box({-0.1, -0.04, -0.1}, {0.1, 0.0, 0.1}));
  for (int i = 0; i < count; ++i) {
    b.add_free("cube", make::box(glm::dvec3(-0.01), glm::dvec3(0.01)), i + 1 < count ? 0.02 : top,
               {{0.0, 0.01 + 0.02 * i, 0.0}, {1, 0, 0, 0}});
  }
  b.set_domain({-1, -1, -1}, {1, 1, 1});
  return b;
}

// The way that they go from where they were put, m.
double stack_drift(int count, double seconds, double spacing = kSpacing, double top = 0.02) {
  const SceneBuilder b = stack_of(count, top);
  Experiment e(b.scene, spacing);
  double drift = 0.0;
  e.run(seconds, [&] {
    for (int i = 0; i < count; ++i) {
      const glm::dvec3 start(0.0, 0.01 + 0.02 * i, 0.0);
      drift = std::max(drift, glm::distance(e.bodies().bodies[i + 1].center_of_mass, start));
    }
  });
  return drift;
}

// Cubes of two spacings stand by their corners. Ten want what the last step's contacts gave to begin with.
TEST(Contact, stacked_cubes_stand) {
  for (const int count : {3, 10}) {
    const double drift = stack_drift(count, 60.0);
    report_value(std::to_string(count) + " stacked cubes, drift in a minute", 1e3 * drift, "mm");
    EXPECT_LT(drift, 1e-4) << count;
  }
}

// Whether or not the nodes of the cubes' distance fields lie on their edges: at 9.9 and 7.5 mm ten fell, at
// 10.2 they leaned by half a millimetre.
TEST(Contact, stacked_cubes_stand_at_any_spacing) {
  for (const double spacing : {0.0103, 0.0102, 0.0101, 0.0099, 0.0095, 0.008, 0.0075}) {
    const double drift = stack_drift(10, 10.0, spacing);
    report_value("ten stacked cubes, drift in 10 s, " + std::to_string(1e3 * spacing).substr(0, 4) + " mm",
                 1e3 * drift, "mm");
    EXPECT_LT(drift, 1e-4) << spacing;
  }
}

// What settles is each contact's speed: by 3e-7 and by 1e-5 of the largest impulse the light ones fell.
TEST(Contact, light_cubes_carry_a_heavy_one) {
  const double drift = stack_drift(5, 10.0, kSpacing, 2.0);
  report_value("a cube of 2 kg on four of 20 g, drift in 10 s", 1e3 * drift, "mm");
  EXPECT_LT(drift, 1e-4);
}

// What the contacts gave is part of a saved world: a stack that is restored goes on bitwise.
TEST(Contact, saved_stack_goes_on_to_the_bit) {
  const SceneBuilder b = stack_of(5);
  Experiment e(b.scene, kSpacing);
  for (int i = 0; i < 3; ++i) e.step();
  std::vector<std::uint8_t> saved;
  ASSERT_TRUE(e.world().save(saved));
  Experiment again(b.scene, e.sampled());
  ASSERT_TRUE(again.world().restore(saved));
  for (int i = 0; i < 50; ++i) {
    e.step();
    again.step();
  }
  EXPECT_EQ(again.world().hash(), e.world().hash());
}

class Slope : public ::testing::TestWithParam<double> {};

// A slope of 20° (as tilted gravity, tan 20° = 0.364): friction above that holds, below lets the box slide
// with a = g(sin θ − μ cos θ).
TEST_P(Slope, friction_cone) {
  const double friction = GetParam(), angle = 20.0 * kPi / 180.0;
  OnTable t = box_on_table(0.0, friction);
  t.b.scene.gravity = {kGravity * std::sin(angle), -kGravity * std::cos(angle), 0.0};
  Experiment e(t.b.scene, kSpacing);
  e.run(0.1);
  const double early = e.bodies().bodies[t.box].twist.linear.x, start = e.bodies().time;
  e.run(0.3);
  const BodyState& box = e.bodies().bodies[t.box];
  const std::string name = "box on a slope of 20°, friction " + std::to_string(friction).substr(0, 4);
  if (friction > std::tan(angle)) {
    report_value(name + ", speed", 1e3 * glm::length(box.twist.linear), "mm/s");
    EXPECT_LT(glm::length(box.twist.linear), 1e-3);
    EXPECT_LT(std::abs(box.pose.position.x), 1e-3);
  } else {
    const double measured = (box.twist.linear.x - early) / (e.bodies().time - start);
    const double expected = kGravity * (std::sin(angle) - friction * std::cos(angle));
    EXPECT_LT(std::abs(report(name + ", acceleration", measured, expected, "m/s²")), 0.10);
  }
}

// The same slope in every direction: friction is a cone.
TEST(Contact, friction_is_the_same_in_every_direction) {
  const double angle = 20.0 * kPi / 180.0, friction = 0.3;
  for (const double turned : {0.0, 22.5, 45.0, 70.0}) {
    OnTable t = box_on_table(0.0, friction);
    const double along = kGravity * std::sin(angle), phi = turned * kPi / 180.0;
    t.b.scene.gravity = {along * std::cos(phi), -kGravity * std::cos(angle), along * std::sin(phi)};
    Experiment e(t.b.scene, kSpacing);
    e.run(0.1);
    const glm::dvec3 early = e.bodies().bodies[t.box].twist.linear;
    const double start = e.bodies().time;
    e.run(0.2);
    const glm::dvec3 gained = e.bodies().bodies[t.box].twist.linear - early;
    const double measured = std::hypot(gained.x, gained.z) / (e.bodies().time - start);
    const double expected = kGravity * (std::sin(angle) - friction * std::cos(angle));
    EXPECT_LT(
        std::abs(report("slide at " + std::to_string(turned).substr(0, 4) + "°", measured, expected, "m/s²")),
        0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(frictions, Slope, ::testing::Values(0.0, 0.1, 0.25, 0.34, 0.39, 0.8));

}  // namespace
}  // namespace slosh::lab
