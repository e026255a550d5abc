// A ball that is far lighter than the fluid about it, let go at the plan's own step: it rises as light things
// do and is not thrown about by single particles.
#include <gtest/gtest.h>

#include "tests/physics/lab.h"

namespace slosh::lab {
namespace {

class LightBall : public ::testing::TestWithParam<double> {};

// A massless ball is as fast as C_a = 1/2 lets it be for a moment, 2 g, and in 0.25 s and 70 mm of water
// reaches 1.2 m/s. With a step that was 1.4 times as long the lightest three reached 1.7, 2.2 and 3.1 m/s.
TEST_P(LightBall, let_go_in_water_rises_and_does_not_rattle) {
  constexpr double kRadius = 0.03;
  const make::Solid ball = make::sphere(kRadius, 20, 28);
  make::Solid hollow = make::sphere(kRadius + 0.003, 20, 28);
  for (glm::dvec3& p : hollow.points) p.y += 0.06;
  for (glm::uvec3& t : hollow.triangles) std::swap(t.y, t.z);
  SceneBuilder b;
  b.add_fluid(1000.0, 0.001);
  b.add_volume(make::merged(make::box({-0.08, 0.0, -0.08}, {0.08, 0.13, 0.08}), hollow));
  b.add_fixed("tank", tank_at_floor({0.16, 0.24, 0.16}, 0.03));
  const int body = b.add_free("ball", ball, GetParam() * 1000.0 * volume_of(ball),
                              {{0.0, 0.06, 0.0}, {1.0, 0.0, 0.0, 0.0}});
  b.set_domain({-0.3, -0.1, -0.3}, {0.3, 0.8, 0.3});
  Experiment e(b.scene, 0.010);
  e.settle(0.15);
  double fastest = 0.0;
  e.run(0.25, [&] { fastest = std::max(fastest, glm::length(e.bodies().bodies[body].twist.linear)); });
  report_value("ball of " + std::to_string(GetParam()) + " times the density let go, fastest", fastest,
               "m/s");
  EXPECT_GT(fastest, 0.85);
  EXPECT_LT(fastest, 1.35);
  EXPECT_EQ(e.world().take_status(), 0u);
}

INSTANTIATE_TEST_SUITE_P(density_ratios, LightBall, ::testing::Values(0.1, 0.05, 0.02, 0.01));

}  // namespace
}  // namespace slosh::lab
