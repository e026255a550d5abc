// Bodies of all weights in fluid, thin walls, and fluid with nowhere to go.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <vector>

#include "tests/lab/report/stress/scenes.h"
#include "tests/lab/report/surface.h"
#include "tests/physics/lab.h"

namespace slosh::lab {
namespace {

constexpr double kSpacing = 0.01;

class Floating : public ::testing::TestWithParam<double> {};

// A free box of 4 cm of ρ_body = share · ρ_fluid, put just over the surface. It floats or sinks as it should,
// and nothing diverges: explicit exchange is said to, below a share of ½.
TEST_P(Floating, box_of_any_density) {
  const double share = GetParam();
  constexpr double kEdge = 0.04;
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  b.add_fixed("tank", tank_at_floor({0.16, 0.3, 0.16}, 0.03));  // a drop of its splash went over a rim at 0.2
  const int box = b.add_free("box", make::box(glm::dvec3(-0.5 * kEdge), glm::dvec3(0.5 * kEdge)),
                             share * 1000.0 * std::pow(kEdge, 3), {{0.0, 0.115, 0.0}, {1, 0, 0, 0}});
  b.add_volume(make::box({-0.08, 0.0, -0.08}, {0.08, 0.08, 0.08}));
  b.set_domain({-0.4, -0.3, -0.4}, {0.4, 1.0, 0.4});
  Experiment e(b.scene, kSpacing);
  e.run(3.0);
  double fastest = 0.0, height = 0.0, count = 0.0;
  e.run(0.5, [&] {
    fastest = std::max(fastest, glm::length(e.bodies().bodies[box].twist.linear));
    height += e.bodies().bodies[box].center_of_mass.y;
    count += 1.0;
  });
  height /= count;
  ASSERT_TRUE(all_finite(e.world()));
  // A heavy box comes down at 1 m/s and shuts the last spacings of fluid between itself and the floor, which
  // some particles leave through the floor.
  const double lost =
      static_cast<double>(e.world().diagnostics().retired) / static_cast<double>(e.world().fluid_count());
  EXPECT_LE(lost, share > 1.0 ? 0.02 : 0.0);
  const std::string name = "box of " + std::to_string(share).substr(0, 5) + " times the fluid's density, ";
  report_value(name + "height", height, "m");
  report_value(name + "speed", fastest, "m/s");
  EXPECT_LT(fastest, 0.2);
  if (share < 0.6) {
    EXPECT_GT(height, 0.06) << "it should float";
  } else if (share > 2.0) {
    EXPECT_LT(height, 0.03) << "it should lie on the floor";
  }
  EXPECT_GT(height, 0.5 * kEdge - 0.005) << "it sank into the floor";
}

INSTANTIATE_TEST_SUITE_P(shares, Floating, ::testing::Values(0.01, 0.1, 0.5, 20.0));

struct Honey {
  double share = 1.0;      // of the fluid's density
  double viscosity = 1.0;  // Pa·s
};

class Drifting : public ::testing::TestWithParam<Honey> {};

// A free box of three spacings, tilted, half in a fluid that holds on to it. However light it is, it goes
// where its weight says, has no more energy than a fall or rise through its own height gives, and soon lies
// still. With drag from the velocities that a step begins with, the lightest spun at 1200 and 30000 rad/s.
TEST_P(Drifting, box_in_a_viscous_fluid) {
  const Honey honey = GetParam();
  constexpr double kCoarse = 0.02, kEdge = 0.06, kSurface = 0.12;
  SceneBuilder b;
  b.add_fluid(1000.0, honey.viscosity);
  b.add_fixed("tank", tank_at_floor({0.2, 0.3, 0.2}, 0.06));
  const Pose tilted{{0.0, kSurface, 0.0}, glm::angleAxis(0.3, glm::normalize(glm::dvec3(1.0, 0.3, 0.2)))};
  const int box = b.add_free("box", make::box(glm::dvec3(-0.5 * kEdge), glm::dvec3(0.5 * kEdge)),
                             honey.share * 1000.0 * std::pow(kEdge, 3), tilted);
  b.add_volume(make::box({-0.1, 0.0, -0.1}, {0.1, kSurface, 0.1}));
  b.set_domain({-0.4, -0.3, -0.4}, {0.4, 1.0, 0.4});
  Experiment e(b.scene, kCoarse);
  const MassProperties mass = b.scene.bodies[box].mass;
  double spin = 0.0, late_spin = 0.0, energy = 0.0;
  const double half = honey.viscosity > 100.0 ? 0.1 : 0.5;  // s
  const auto look = [&] {
    const BodyState& now = e.bodies().bodies[box];
    const double rate = glm::length(now.twist.angular);
    double& fastest = e.world().time() > half ? late_spin : spin;
    fastest = std::max(fastest, rate);
    energy = std::max(energy, 0.5 * mass.mass * glm::dot(now.twist.linear, now.twist.linear) +
                                  0.5 * mass.inertia[0][0] * rate * rate);
  };
  e.run(2.0 * half, look);
  ASSERT_TRUE(all_finite(e.world()));
  const std::uint32_t status = e.world().take_status();
  EXPECT_EQ(status & (kStatusNonFinite | kStatusEscaped), 0u) << status_text(status);
  char name[80];
  std::snprintf(name, sizeof name, "box of %g times the density in %g Pa·s, ", honey.share, honey.viscosity);
  const double fall = std::max(1.0, honey.share) * 1000.0 * std::pow(kEdge, 3) * kGravity * kEdge;
  report_value(std::string(name) + "fastest turn", spin, "rad/s");
  report_value(std::string(name) + "fastest turn, later", late_spin, "rad/s");
  report_value(std::string(name) + "kinetic energy, share of a fall's", energy / fall, "");
  const double rise = e.bodies().bodies[box].center_of_mass.y - kSurface;
  report_value(std::string(name) + "rise", 1e3 * rise, "mm");
  EXPECT_LT(energy, (honey.share > 1.0 ? 1.2 : 0.15) * fall);
  EXPECT_LT(spin, honey.viscosity > 100.0 ? 1.5 : honey.viscosity > 10.0 ? 20.0 : 120.0);
  EXPECT_LT(late_spin, honey.viscosity > 10.0 ? 1.0 : 10.0);
  if (honey.share > 1.0) {
    EXPECT_LT(rise, -0.2 * kEdge) << "it should sink";
  } else if (honey.viscosity < 100.0 && honey.share < 0.5) {
    EXPECT_GT(rise, 0.2 * kEdge) << "it should rise";
  }
}

std::vector<Honey> honeys() {
  std::vector<Honey> all;
  for (const double viscosity : {1.0, 30.0, 1000.0}) {
    for (const double share : {0.01, 0.1, 0.9, 20.0}) all.push_back({share, viscosity});
  }
  return all;
}

INSTANTIATE_TEST_SUITE_P(densities, Drifting, ::testing::ValuesIn(honeys()));

// The thinnest wall the sampler takes: as thick as the spacing. Fluid stays inside for 2 s, upright and
// shaken.
TEST(Walls, as_thick_as_the_spacing_do_not_leak) {
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  const int cup = b.add_free("cup", tank_at_floor({0.12, 0.14, 0.12}, kSpacing), 0.5);
  b.add_volume(make::box({-0.06, 0.0, -0.06}, {0.06, 0.07, 0.06}));
  b.add_grip(cup, 2e4, 200.0, 100.0, 5.0);
  b.set_domain({-0.4, -0.3, -0.4}, {0.4, 0.8, 0.4});
  Experiment e(b.scene, kSpacing);
  e.handle(0).engaged = true;
  e.world().settle(0.5);
  e.run(2.0, [&] {
    const double rate = 2.0 * kPi * 1.0, angle = rate * e.world().time();
    e.handle(0).pose.position.x = 0.02 * (1.0 - std::cos(angle));
    e.handle(0).twist.linear.x = 0.02 * rate * std::sin(angle);
  });
  ASSERT_TRUE(all_finite(e.world()));
  const double off = 0.5 * kSpacing;
  const std::size_t outside =
      report::count_outside(e.picture(), e.bodies().bodies[cup].pose,
                            {{-0.06 - off, -off, -0.06 - off}, {0.06 + off, 1.0, 0.06 + off}});
  report_value("wall as thick as the spacing, particles under the floor or beside the walls",
               static_cast<double>(outside), "");
  EXPECT_EQ(outside, 0u);
}

TEST(Walls, thinner_than_the_spacing_are_refused) {
  SceneBuilder b;
  b.add_fluid(1000.0, 0.05);
  b.add_free("cup", tank_at_floor({0.12, 0.14, 0.12}, 0.5 * kSpacing), 0.5);
  b.add_volume(make::box({-0.06, 0.0, -0.06}, {0.06, 0.07, 0.06}));
  const Result<SampledScene> sampled = sample_scene(b.scene, kSpacing);
  ASSERT_FALSE(sampled);
  EXPECT_NE(sampled.error().text().find("thick"), std::string::npos) << sampled.error().text();
}

// A press: a stiff hand drives a lid that fits the tank 3 cm into fluid that cannot get out but through the
// gap around it. The fluid is crushed: the status says so or the fluid escapes past the lid; either way all
// stays finite, and when the lid goes up again the fluid comes to rest.
TEST(Walls, press_crushes_fluid) {
  Experiment e(report::press_scene(), kSpacing);
  const std::size_t count = e.world().fluid_count();
  e.handle(0).engaged = true;
  // What spurts past the lid may come over the rim, and lie on it or fall; of all else nothing is outside.
  const double off = 0.8 * kSpacing, rim = 0.2 - off, half = 0.06 + off;
  std::set<std::size_t> over, passed;
  const auto look = [&] {
    const Snapshot now = e.picture();
    for (std::size_t i = 0; i < now.positions.size(); ++i) {
      const glm::vec3& p = now.positions[i];
      if (now.fluid_index[i] == report::kRetired) continue;
      if (p.y > rim)
        over.insert(i);
      else if ((std::abs(p.x) > half || std::abs(p.z) > half || p.y < -off) && !over.contains(i))
        passed.insert(i);
    }
  };
  const auto lid_to = [&](double y, double seconds) {
    const double from = e.handle(0).pose.position.y, start = e.world().time();
    e.run(seconds, [&] {
      look();
      e.handle(0).pose.position.y = glm::mix(from, y, std::min(1.0, (e.world().time() - start) / seconds));
      e.handle(0).twist.linear.y = (y - from) / seconds;
    });
    e.handle(0).twist = {};
  };
  lid_to(0.02, 0.5);
  e.run(0.5, look);
  ASSERT_TRUE(all_finite(e.world()));
  EXPECT_TRUE(passed.empty()) << passed.size() << " passed a wall";
  report_value("press, largest compression", e.world().diagnostics().max_compression, "");
  const std::uint32_t status = e.world().take_status();
  EXPECT_EQ(status & kStatusNonFinite, 0u);
  lid_to(0.15, 0.5);
  e.run(1.5);
  // Fluid that was pressed through a wall takes its time to fall out of the domain.
  const std::uint32_t whole = status | e.world().take_status();
  EXPECT_NE(whole & (kStatusCompressed | kStatusEscaped), 0u) << status_text(whole);
  ASSERT_TRUE(all_finite(e.world()));
  const Diagnostics fluid = e.world().diagnostics();
  EXPECT_EQ(fluid.particles + fluid.retired, count);
  // What the lid lifts over the rim as it goes up.
  const double lost = static_cast<double>(fluid.retired) / static_cast<double>(count);
  report_value("press, share of the fluid lost", lost, "");
  EXPECT_LT(lost, 0.33);
  // The lid lifts what came past it over the rim, from where it falls half a metre; the gap spits drops.
  EXPECT_LT(fluid.max_speed, 5.0);
}

// Five boxes dropped on each other in a heap: no explosion, none through the table.
TEST(Bodies, heap_comes_to_rest) {
  SceneBuilder b;
  b.add_fixed("table", make::box({-0.3, -0.04, -0.3}, {0.3, 0.0, 0.3}));
  for (int i = 0; i < 5; ++i) {
    b.add_free("box", make::box(glm::dvec3(-0.03), glm::dvec3(0.03)), 0.2,
               {{0.005 * (i % 2), 0.04 + 0.07 * i, 0.004 * (i % 3)}, {1, 0, 0, 0}});
  }
  b.set_domain({-1, -1, -1}, {1, 1, 1});
  Experiment e(b.scene, kSpacing);
  double fastest = 0.0;
  e.run(2.0, [&] {
    for (const BodyState& body : e.bodies().bodies)
      fastest = std::max(fastest, glm::length(body.twist.linear));
  });
  ASSERT_TRUE(all_finite(e.world()));
  // A fall over the heap's height is 2.6 m/s.
  EXPECT_LT(fastest, 3.0);
  for (std::size_t i = 1; i < e.bodies().bodies.size(); ++i) {
    EXPECT_LT(glm::length(e.bodies().bodies[i].twist.linear), 0.05);
    EXPECT_GT(e.bodies().bodies[i].center_of_mass.y, 0.028);
  }
}

}  // namespace
}  // namespace slosh::lab
