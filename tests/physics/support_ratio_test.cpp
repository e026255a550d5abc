// How wide the kernels may be.
#include <gtest/gtest.h>

#include <string>

#include "tests/lab/report/surface.h"
#include "tests/physics/lab.h"

namespace slosh::lab {
namespace {

// The support ratios that a scene file may have (scenes/reading): walls hold, at rest and with the fluid
// thrown to one side. At 3 they lost a tenth within seconds.
TEST(SupportRatio, walls_hold_at_both_ends_of_its_range) {
  for (const double ratio : {1.5, 2.6}) {
    for (const double sideways : {0.0, 2.0}) {
      SceneBuilder b;
      b.add_fluid(1000.0, 0.001);
      b.add_fixed("tank", tank_at_floor({0.2, 0.16, 0.2}, 0.05));
      b.add_volume(make::box({-0.1, 0.0, -0.1}, {0.1, 0.1, 0.1}));
      b.set_domain({-0.3, -0.2, -0.3}, {0.3, 0.4, 0.3});
      b.scene.support_ratio = ratio;
      b.scene.gravity.x = sideways;
      Experiment e(b.scene, 0.01);
      if (sideways == 0.0) e.world().settle(0.5);
      e.run(1.0);
      EXPECT_EQ(report::count_outside(e.picture(), Pose{}, {{-0.105, -0.005, -0.105}, {0.105, 1.0, 0.105}}),
                0u)
          << "ratio " << ratio << ", sideways " << sideways;
      const double weight = -e.bodies().bodies[0].fluid.force.y / (e.fluid_mass() * kGravity);
      report_value("support ratio " + std::to_string(ratio).substr(0, 3) + ", weight over its own", weight,
                   "");
      // Thrown to one side it still swings a second later.
      EXPECT_NEAR(weight, 1.0, sideways == 0.0 ? 0.015 : 0.1);
    }
  }
}

}  // namespace
}  // namespace slosh::lab
