// Implicit viscosity: the same flow as by explicit steps, in a fraction of them; bitwise whatever the
// threads; bodies inside the solve; bounded where explicit steps would not come to an end.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/lab.h"

namespace slosh::lab {
namespace {

// A plate on a stiff hand in a tank of honey.
struct Stirred {
  SceneBuilder b;
  int tank, plate;
  explicit Stirred(double viscosity) {
    b.add_fluid(1200.0, viscosity);
    tank = b.add_fixed("tank", tank_at_floor({0.12, 0.14, 0.12}, 0.02));
    plate = b.add_free("plate", make::box({-0.02, -0.02, -0.008}, {0.02, 0.02, 0.008}), 0.06,
                       {{-0.02, 0.045, 0.0}, {1, 0, 0, 0}});
    b.set_viscosity({tank, plate}, viscosity);
    b.add_volume(make::box({-0.06, 0.0, -0.06}, {0.06, 0.09, 0.06}));
    b.add_grip(plate, 5e3, 20.0, 20.0, 0.1);
    b.set_domain({-0.1, -0.05, -0.1}, {0.1, 0.25, 0.1});
  }
};

// The force on the plate while the hand moves it, mean over the second half of the way.
glm::dvec3 force_on_plate(report::Trial& e, int plate, double speed, double seconds) {
  HandleInput& hand = e.handle(0);
  hand.engaged = true;
  hand.twist.linear.x = speed;
  const double from = hand.pose.position.x, begin = e.world().time();
  Average x, y, z;
  e.run(seconds, [&] {
    const double time = e.world().time() - begin;
    hand.pose.position.x = from + speed * time;
    if (time < 0.5 * seconds) return;
    const glm::dvec3 f = e.bodies().bodies[static_cast<std::size_t>(plate)].fluid.force;
    x.add(f.x), y.add(f.y), z.add(f.z);
  });
  return {x.mean(), y.mean(), z.mean()};
}

TEST(ImplicitViscosity, DragsLikeExplicitStepsASixthAsLong) {
  const Stirred s(50.0);
  Experiment solved(s.b.scene, 0.01), stepped(s.b.scene, 0.01, Experiment::Explicit{});
  ASSERT_TRUE(solved.world().plan().has(PassId::kImplicitViscosity));
  ASSERT_FALSE(stepped.world().plan().has(PassId::kImplicitViscosity));
  EXPECT_GT(solved.world().plan().time_step, 6.0 * stepped.world().plan().time_step);
  const glm::dvec3 a = force_on_plate(solved, s.plate, 0.05, 0.3);
  const glm::dvec3 b = force_on_plate(stepped, s.plate, 0.05, 0.3);
  report("drag on a plate in 50 Pa·s, solved against stepped", a.x, b.x, "N");
  EXPECT_LT(b.x, -1.0) << "the plate hardly felt the honey: the test tests nothing";
  EXPECT_NEAR(a.x / b.x, 1.0, 0.01);
  const double of_walls = solved.bodies().bodies[static_cast<std::size_t>(s.tank)].fluid.force.x;
  EXPECT_GT(of_walls, 0.5 * -a.x) << "the tank feels what the plate does to the honey";
}

// What models of the fluid's wrench go by (bodies/wrench_identifier.h) is there with explicit and implicit
// viscosity.
TEST(ImplicitViscosity, GivesTheDragMatrixOfExplicitSteps) {
  const Stirred s(50.0);
  Experiment solved(s.b.scene, 0.01), stepped(s.b.scene, 0.01, Experiment::Explicit{});
  for (Experiment* e : {&solved, &stepped}) {
    e->handle(0).engaged = true;
    e->step();
  }
  ASSERT_EQ(solved.world().drags().size(), s.b.scene.bodies.size());
  const Matrix6& a = solved.world().drags()[static_cast<std::size_t>(s.plate)];
  const Matrix6& b = stepped.world().drags()[static_cast<std::size_t>(s.plate)];
  ASSERT_GT(b[0][0], 1.0);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j)
      EXPECT_NEAR(a[i][j], b[i][j], 1e-4 * std::sqrt(b[i][i] * b[j][j])) << i << " " << j;
  }
}

// Chunks of work are handed out as threads come free; what they sum is not. How rows lie by fours decides a
// last bit once in some hundred steps, so it takes many steps to see a thread alone that parts them
// otherwise.
TEST(ImplicitViscosity, IsTheSameToTheBitWhateverTheThreadsAndFromASavedWorldOn) {
  const Stirred s(50.0);
  const SampledScene sampled = sample_scene(s.b.scene, 0.01).value();
  const Plan plan = make_plan(s.b.scene, 0.01);
  ASSERT_TRUE(plan.implicit_viscosity);
  std::vector<HandleInput> hands(1);
  hands[0].engaged = true;
  hands[0].pose.position = {0.0, 0.05, 0.01};
  const auto run = [&](World& world, int steps) {
    for (int i = 0; i < steps; ++i) world.step(hands);
  };
  World one(s.b.scene, sampled, plan, {1, Backend::kCpu});
  World three(s.b.scene, sampled, plan, {3, Backend::kCpu});
  run(one, 200);
  run(three, 200);
  EXPECT_EQ(one.hash(), three.hash());
  std::vector<std::uint8_t> saved;
  ASSERT_TRUE(one.save(saved));
  World other(s.b.scene, sampled, plan, {2, Backend::kCpu});
  ASSERT_TRUE(other.restore(saved));
  run(one, 20);
  run(other, 20);
  EXPECT_EQ(one.hash(), other.hash());
}

// A box that lies on the floor under honey: contacts are solved after the drag, by what they gave last.
TEST(ImplicitViscosity, ABoxLiesOnTheFloorUnderHoneyWithItsWeight) {
  SceneBuilder b;
  b.add_fluid(1000.0, 100.0);
  const int tank = b.add_fixed("tank", tank_at_floor({0.12, 0.14, 0.12}, 0.02));
  constexpr double kEdge = 0.04;
  const int box = b.add_free("box", make::box(glm::dvec3(-0.5 * kEdge), glm::dvec3(0.5 * kEdge)),
                             3000.0 * std::pow(kEdge, 3), {{0.0, 0.5 * kEdge + 0.001, 0.0}, {1, 0, 0, 0}});
  b.set_viscosity({tank, box}, 100.0);
  b.add_volume(make::box({-0.06, kEdge + 0.002, -0.06}, {0.06, 0.08, 0.06}));
  b.set_domain({-0.1, -0.05, -0.1}, {0.1, 0.25, 0.1});
  Experiment e(b.scene, 0.01);
  ASSERT_TRUE(e.world().plan().has(PassId::kImplicitViscosity));
  e.run(0.5);
  const glm::dvec3 start = e.bodies().bodies[static_cast<std::size_t>(box)].center_of_mass;
  double fastest = 0.0;
  e.run(0.5, [&] {
    fastest = std::max(fastest, glm::length(e.bodies().bodies[static_cast<std::size_t>(box)].twist.linear));
  });
  const BodyState& now = e.bodies().bodies[static_cast<std::size_t>(box)];
  report_value("box on the floor under honey, way in half a second",
               1e3 * glm::distance(now.center_of_mass, start), "mm");
  report_value("its fastest", 1e3 * fastest, "mm/s");
  EXPECT_NEAR(now.center_of_mass.y, 0.5 * kEdge, 5e-4);
  EXPECT_LT(glm::distance(now.center_of_mass, start), 1e-6);
  EXPECT_EQ(e.world().take_status() & (kStatusNonFinite | kStatusViscosityCut), 0u);
}

// Explicit, 100 000 Pa·s at a centimetre is a step of a tenth of a microsecond.
TEST(ImplicitViscosity, AColumnOfPitchHardlySagsAndStaysBounded) {
  SceneBuilder b;
  b.add_fluid(1300.0, 1e5);
  b.add_fixed("plate", make::box({-0.1, -0.02, -0.1}, {0.1, 0.0, 0.1}));
  b.add_volume(make::box({-0.03, 0.0, -0.03}, {0.03, 0.06, 0.03}));
  b.set_domain({-0.1, -0.05, -0.1}, {0.1, 0.2, 0.1});
  Experiment e(b.scene, 0.01);
  ASSERT_TRUE(e.world().plan().has(PassId::kImplicitViscosity));
  const double high = e.world().diagnostics().center.y;
  double most = 0.0;
  e.run(0.2, [&] { most = std::max(most, e.world().diagnostics().kinetic_energy); });
  const Diagnostics now = e.world().diagnostics();
  const double fall = now.mass * kGravity * high;
  report_value("column of pitch after 0.2 s, sagged", 1e3 * (high - now.center.y), "mm");
  report_value("its most kinetic energy, share of what it stands on", most / fall, "");
  // Without friction at its foot ρgh²t/9μ, 0.010 mm, and what the fluid is compressed by besides; water would
  // have fallen apart within 0.08 s.
  EXPECT_LT(high - now.center.y, 2.5e-5);
  EXPECT_LT(most, 1e-7 * fall);
  EXPECT_EQ(now.retired, 0u);
}

// Thinned while it runs, and thickened again; more than the solve can bear is refused with what it can.
TEST(ImplicitViscosity, ViscosityChangesWhileItRuns) {
  const Stirred s(50.0);
  Experiment e(s.b.scene, 0.01);
  ASSERT_TRUE(e.world().plan().implicit_viscosity);
  const double thick = force_on_plate(e, s.plate, 0.05, 0.1).x;
  ASSERT_TRUE(e.world().set_viscosity(0, 5.0));
  const double thin = force_on_plate(e, s.plate, 0.05, 0.1).x;
  EXPECT_LT(std::abs(thin), 0.7 * std::abs(thick));
  ASSERT_TRUE(e.world().set_viscosity(0, 0.0));
  EXPECT_TRUE(e.world().plan().implicit_viscosity);
  ASSERT_TRUE(e.world().set_viscosity(0, 500.0));
  EXPECT_TRUE(e.world().plan().has(PassId::kImplicitViscosity));
  e.run(0.02);
  EXPECT_TRUE(all_finite(e.world()));
  const Result<bool> refused = e.world().set_viscosity(0, 1e9);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().mend.find("Pa·s will do"), std::string::npos) << refused.error().text();
}

}  // namespace
}  // namespace slosh::lab
