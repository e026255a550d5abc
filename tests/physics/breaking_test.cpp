// Bodies that come apart while the world runs: what was one touches, and a shell lets its fluid out.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "tests/physics/lab.h"

namespace slosh::lab {
namespace {

// A block glued to a table, 20 mm above it: too heavy for the glue it falls onto that, and lies there.
TEST(GluedBlock, that_lets_go_lands_on_what_it_was_glued_to) {
  SceneBuilder b;
  const int table = b.add_fixed("table", make::box({-0.2, -0.05, -0.2}, {0.2, 0.0, 0.2}));
  const int block = b.add_free("block", make::box(glm::dvec3(-0.03), glm::dvec3(0.03)), 0.2,
                               {{0.0, 0.05, 0.0}, {1, 0, 0, 0}});
  Joint glue;
  glue.name = "glue";
  glue.kind = JointKind::kFixed;
  glue.body = block;
  glue.other = table;
  glue.breaks_force = 0.9 * 0.2 * kGravity;
  b.scene.joints.push_back(glue);
  b.set_domain(glm::dvec3(-1.0), glm::dvec3(1.0));
  Experiment e(b.scene, 0.01);
  e.run(1.0);
  EXPECT_FALSE(e.bodies().joints[0].joined);
  const BodyState& state = e.bodies().bodies[static_cast<std::size_t>(block)];
  EXPECT_NEAR(state.center_of_mass.y, 0.03, 2e-4);
  EXPECT_LT(glm::length(state.twist.linear), 1e-3);
}

/// Two cups mouth to mouth, glued, full of water, that fall onto a ledge with one of them.
struct Egg {
  static constexpr double kRadius = 0.02, kWall = 0.006, kHalf = 0.025, kSpacing = 0.005;  // m
  double inside = 0.0;  // share of the water
  bool whole = true;

  explicit Egg(double breaks_force) {
    SceneBuilder b;
    b.add_fluid(1000.0, 0.01);
    b.add_fixed("table", make::box({-0.2, -0.12, -0.2}, {0.2, -0.1, 0.2}));
    b.add_fixed("ledge", make::box({-0.08, -0.1, -0.08}, {-0.005, -0.05, 0.08}));
    const glm::dquat to_right = glm::angleAxis(-0.5 * kPi, glm::dvec3(0, 0, 1));
    const glm::dquat to_left = glm::angleAxis(0.5 * kPi, glm::dvec3(0, 0, 1));
    const make::Solid cup = report::glass_of(kRadius, kHalf, kWall);
    const int left = b.add_free("left", cup, 0.03, {{-kHalf, 0, 0}, to_right});
    const int right = b.add_free("right", cup, 0.03, {{kHalf, 0, 0}, to_left});
    b.add_volume(report::filling_of(kRadius, 2.0 * kHalf), 0, {{-kHalf, 0, 0}, to_right});
    Joint seam;
    seam.name = "seam";
    seam.kind = JointKind::kFixed;
    seam.body = left;
    seam.other = right;
    seam.pose = {{0.0, kHalf, 0.0}, {1, 0, 0, 0}};
    seam.breaks_force = breaks_force;
    b.scene.joints.push_back(seam);
    b.set_domain({-0.4, -0.15, -0.4}, {0.4, 0.4, 0.4});
    Experiment e(b.scene, kSpacing);
    const auto share_inside = [&] {
      const Snapshot picture = e.picture();
      std::size_t within = 0;
      for (const glm::vec3& at : picture.positions) {
        for (const int half : {left, right}) {
          const glm::dvec3 p = transform_point(
              inverse(e.bodies().bodies[static_cast<std::size_t>(half)].pose), glm::dvec3(at));
          if (p.y < 0.0 || p.y > kHalf || std::hypot(p.x, p.z) > kRadius + 0.5 * kWall) continue;
          ++within;
          break;
        }
      }
      return static_cast<double>(within) / static_cast<double>(picture.positions.size());
    };
    e.run(0.05);
    EXPECT_TRUE(e.bodies().joints[0].joined) << "nothing pulls at what falls";
    EXPECT_EQ(share_inside(), 1.0);
    e.run(0.75);
    whole = e.bodies().joints[0].joined;
    inside = share_inside();
  }
};

TEST(Egg, opens_by_its_fall_and_lets_its_fluid_out) {
  const Egg egg(5.0), stone(0.0);
  EXPECT_TRUE(stone.whole);
  EXPECT_FALSE(egg.whole);
  report_value("shell that holds, share of the fluid inside", stone.inside, "");
  report_value("shell that broke, share of the fluid inside", egg.inside, "");
  // Two bodies that touch are no one wall: a blow squeezes some through between them.
  EXPECT_GT(stone.inside, 0.9);
  EXPECT_LT(egg.inside, 0.5);
}

}  // namespace
}  // namespace slosh::lab
