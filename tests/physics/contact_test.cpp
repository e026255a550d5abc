// Bodies on a table: rest, drop, slide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

// Restitution 0: what comes up again comes from undoing the overlap of the landing step (1.4 m/s · 4 ms = 6
// mm at worst, undone at 0.5 m/s at most), so at most 0.5²/2g = 13 mm; a box that bounced with 0.3 would rise
// 9 mm.
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

TEST(Contact, ball_bounces_with_its_restitution) {
  SceneBuilder b;
  b.add_fixed("table", make::box({-0.4, -0.04, -0.3}, {0.4, 0.0, 0.3}));
  const int ball = b.add_free("ball", make::sphere(0.03, 16, 32), 0.1, {{0.0, 0.33, 0.0}, {1, 0, 0, 0}});
  b.scene.bodies[ball].restitution = 0.6;
  b.set_domain({-1, -1, -1}, {1, 2, 1});
  Experiment e(b.scene, kSpacing);
  bool rising = false;
  double highest = 0.0;
  e.run(0.6, [&] {
    const BodyState& state = e.bodies().bodies[ball];
    rising = rising || state.twist.linear.y > 0.2;
    if (rising) highest = std::max(highest, state.pose.position.y - 0.03);
  });
  // Height goes with the square of the speed, which a step of 4 ms knows to 0.04 of 2.4 m/s, and the surface
  // particles stand up to a twentieth of a spacing inside the round.
  EXPECT_LT(std::abs(report("ball, height after a bounce of 0.6", highest, 0.36 * 0.3, "m")), 0.10);
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

INSTANTIATE_TEST_SUITE_P(frictions, Slope, ::testing::Values(0.0, 0.1, 0.25, 0.34, 0.39, 0.8));

}  // namespace
}  // namespace slosh::lab
