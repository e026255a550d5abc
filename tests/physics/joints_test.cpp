// Linkages against closed forms: periods, energy, and a stirrer's torque.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/physics/lab.h"
#include "tests/support/linkage.h"

namespace slosh::lab {
namespace {

using slosh::testing::add_pendulum;
using slosh::testing::energy_of;
using slosh::testing::frame_along;
using slosh::testing::Linkage;
using slosh::testing::run_for;
using slosh::testing::state_of;

const glm::dvec3 kHingeAxis(0, 0, 1);

// T = 4 √((I + mL²)/(mgL)) K(sin θ₀/2), at the step of bodies alone, 4 ms.
TEST(Pendulum, has_the_period_of_its_swing) {
  constexpr double kMass = 2.0, kLength = 0.25, kInertia = 0.03;
  for (const double swing : {0.05, 1.0, 2.5}) {
    Linkage link;
    link.time_step = 0.004;
    add_pendulum(link, kMass, kInertia, kLength, -swing);
    World world = link.world();
    // The joint counts from the scene's pose: its lowest place is at the swing.
    double first = 0.0, last = 0.0, before = -swing;
    constexpr int kSwings = 10;
    for (int passed = 0; passed <= kSwings;) {
      world.step({});
      const double now = state_of(world).joints[0].position - swing;
      if (before < 0.0 && now >= 0.0) {
        last = world.time() - world.plan().time_step * now / (now - before);
        if (passed++ == 0) first = last;
      }
      before = now;
    }
    const double expected = 4.0 *
                            std::sqrt((kInertia + kMass * kLength * kLength) / (kMass * kGravity * kLength)) *
                            std::comp_ellint_1(std::sin(0.5 * swing));
    const double error =
        report("pendulum, period at a swing of " + std::to_string(swing).substr(0, 4) + " rad",
               (last - first) / kSwings, expected, "s");
    EXPECT_LT(std::abs(error), 1e-3);
  }
}

// A bob fixed to the end of a rod: with the rod one body, whose moment is the sum by Steiner.
TEST(Pendulum, of_two_that_are_fixed_to_each_other_has_the_period_of_one) {
  constexpr double kRodMass = 0.5, kRodLength = 0.3, kBob = 2.0, kBobInertia = 0.004, kDown = 0.4,
                   kSwing = 1.0;
  constexpr double kRodInertia = kRodMass * kRodLength * kRodLength / 12.0;
  Linkage link;
  link.time_step = 0.004;
  const glm::dquat turn = glm::angleAxis(-kSwing, kHingeAxis);
  const int rod =
      link.add(kRodMass, glm::dvec3(kRodInertia), {turn * glm::dvec3(0, -0.5 * kRodLength, 0), turn});
  const int bob = link.add(kBob, glm::dvec3(kBobInertia), {turn * glm::dvec3(0, -kDown, 0), turn});
  link.join(JointKind::kHinge, rod, -1, frame_along(kHingeAxis, {0, 0, 0}));
  link.join(JointKind::kFixed, bob, rod, {turn * glm::dvec3(0, -kRodLength, 0), turn});
  World world = link.world();
  double first = 0.0, last = 0.0, before = -kSwing;
  constexpr int kSwings = 10;
  for (int passed = 0; passed <= kSwings;) {
    world.step({});
    const double now = state_of(world).joints[0].position - kSwing;
    if (before < 0.0 && now >= 0.0) {
      last = world.time() - world.plan().time_step * now / (now - before);
      if (passed++ == 0) first = last;
    }
    before = now;
  }
  const double moment =
      kRodInertia + kRodMass * 0.25 * kRodLength * kRodLength + kBobInertia + kBob * kDown * kDown;
  const double pull = kGravity * (kRodMass * 0.5 * kRodLength + kBob * kDown);
  const double expected = 4.0 * std::sqrt(moment / pull) * std::comp_ellint_1(std::sin(0.5 * kSwing));
  EXPECT_LT(
      std::abs(report("rod and bob fixed to each other, period", (last - first) / kSwings, expected, "s")),
      1e-3);
}

// Rods of 0.3 m that hang on each other by hinges about z and start out straight at an angle.
Linkage chain_of(int count, double start, double last_mass = 0.1) {
  constexpr double kRod = 0.3, kMass = 0.1;
  Linkage link;
  link.time_step = 0.004;
  const glm::dquat turn = glm::angleAxis(start, kHingeAxis);
  int above = -1;
  for (int i = 0; i < count; ++i) {
    const double mass = i + 1 == count ? last_mass : kMass;
    const double across = mass * kRod * kRod / 12.0;
    const int rod =
        link.add(mass, {across, 1e-2 * across, across}, {turn * glm::dvec3(0, -(i + 0.5) * kRod, 0), turn});
    link.join(JointKind::kHinge, rod, above, frame_along(kHingeAxis, turn * glm::dvec3(0, -i * kRod, 0)));
    above = rod;
  }
  return link;
}

// m by which the ends of a chain's rods are apart at most.
double gap_in(const BodySnapshot& state) {
  double worst = 0.0;
  glm::dvec3 end(0.0);
  for (const BodyState& rod : state.bodies) {
    worst = std::max(worst, glm::distance(end, transform_point(rod.pose, {0, 0.15, 0})));
    end = transform_point(rod.pose, {0, -0.15, 0});
  }
  return worst;
}

// Largest gain and loss of energy over `seconds`, as shares of what the chain can give from start to rest.
struct EnergyDrift {
  double gain = 0.0, loss = 0.0, gap = 0.0;
};
EnergyDrift drift_of(const Linkage& link, double seconds) {
  World world = link.world();
  double scale = 0.0;
  for (std::size_t b = 0; b < link.scene.bodies.size(); ++b)
    scale += link.scene.bodies[b].mass.mass * kGravity * 0.3 * (static_cast<double>(b) + 0.5);
  const double start = energy_of(link.scene, state_of(world));
  EnergyDrift drift;
  const int steps = static_cast<int>(seconds / world.plan().time_step);
  for (int i = 0; i < steps; ++i) {
    world.step({});
    const BodySnapshot state = state_of(world);
    const double change = (energy_of(link.scene, state) - start) / scale;
    drift.gain = std::max(drift.gain, change);
    drift.loss = std::max(drift.loss, -change);
    drift.gap = std::max(drift.gap, gap_in(state));
  }
  return drift;
}

// Velocities are half a step behind places, so the energy that is read sways by ω·dt: it neither grows nor
// is lost in a minute.
TEST(Pendulum, keeps_its_energy_for_a_minute) {
  for (const int rods : {1, 2}) {
    const EnergyDrift early = drift_of(chain_of(rods, 1.8), 5.0), all = drift_of(chain_of(rods, 1.8), 60.0);
    const std::string name = std::to_string(rods) + " rods in a minute, ";
    report_value(name + "energy gained", all.gain, "of their fall");
    report_value(name + "energy lost", all.loss, "of their fall");
    report_value(name + "gap in the hinges", all.gap, "m");
    EXPECT_LT(all.gain, early.gain + 0.01);
    EXPECT_LT(all.loss, early.loss + 0.05);
    EXPECT_LT(all.gap, 1e-6);
  }
}

// Ten rods that whip, and a thousand times the weight at their end.
TEST(Chain, of_ten_holds_whatever_hangs_on_it) {
  for (const double last : {0.1, 100.0, 1e-4}) {
    const Linkage link = chain_of(10, 1.5, last);
    World world = link.world();
    double worst = 0.0, most = -1e300;
    const double start = energy_of(link.scene, state_of(world));
    for (int i = 0; i < 2500; ++i) {
      world.step({});
      const BodySnapshot state = state_of(world);
      worst = std::max(worst, gap_in(state));
      most = std::max(most, energy_of(link.scene, state) - start);
    }
    const std::string name = "ten rods, the last of " + std::to_string(last).substr(0, 6) + " kg, ";
    report_value(name + "gap in the hinges", worst, "m");
    report_value(name + "energy gained", most, "J");
    EXPECT_LT(worst, 1e-4);
    EXPECT_LT(most, 0.2 * (1.0 + last) * kGravity * 3.0);
  }
}

// A plank on a hinge that lies on a narrow block behind its middle. A motor presses it down: what the block
// bears follows from the torques about the hinge, and the hinge has the rest.
TEST(HingedPlank, lies_on_a_block_by_what_statics_says) {
  for (const double torque : {0.0, 4.0}) {
    constexpr double kMass = 2.0, kHalf = 0.2, kBlock = 0.1;  // kg; m from the plank's middle
    SceneBuilder b;
    b.add_fixed("block", make::box({kBlock - 0.005, -0.1, -0.05}, {kBlock + 0.005, -0.02, 0.05}));
    const int plank = b.add_free("plank", make::box({-kHalf, -0.02, -0.03}, {kHalf, 0.02, 0.03}), kMass);
    Joint joint;
    joint.name = "hinge";
    joint.body = plank;
    joint.pose = frame_along({0, 0, -1}, {-kHalf, 0.0, 0.0});  // onto the block is forwards
    joint.motor_speed = torque > 0.0 ? 10.0 : 0.0;
    joint.motor_limit = torque;
    b.scene.joints.push_back(joint);
    b.set_domain(glm::dvec3(-1.0), glm::dvec3(1.0));
    Experiment e(b.scene, 0.01);
    e.run(2.0);
    const JointState& state = e.bodies().joints[0];
    EXPECT_NEAR(state.position, 0.0, 2e-3);
    EXPECT_NEAR(state.motor, torque, 1e-9);
    const double on_block = kMass * kGravity - state.reaction.force.y;
    const std::string name = torque > 0.0 ? "pressed plank" : "plank";
    const double expected = (kMass * kGravity * kHalf + torque) / (kHalf + kBlock);
    EXPECT_LT(std::abs(report(name + " on a hinge, force on its block", on_block, expected, "N")), 0.02);
  }
}

// A plate that goes by its keys at 0.2 m/s pushes a box along a table, and leaves it where it stops.
TEST(DrivenPlate, pushes_a_box_along) {
  SceneBuilder b;
  b.add_fixed("table", make::box({-1.0, -0.05, -0.2}, {1.0, 0.0, 0.2}));
  const int box = b.add_free("box", make::box(glm::dvec3(-0.03), glm::dvec3(0.03)), 0.2,
                             {{0.1, 0.03, 0.0}, {1, 0, 0, 0}});
  const int plate = b.add_fixed("plate", make::box({-0.02, -0.05, -0.05}, {0.0, 0.05, 0.05}));
  Body& driven = b.scene.bodies[static_cast<std::size_t>(plate)];
  driven.motion = BodyMotion::kDriven;
  driven.keys = {{0.0, {{0.0, 0.06, 0.0}, {1, 0, 0, 0}}}, {1.0, {{0.2, 0.06, 0.0}, {1, 0, 0, 0}}}};
  driven.pose = driven.keys.front().pose;
  b.set_domain(glm::dvec3(-2.0), glm::dvec3(2.0));
  Experiment e(b.scene, 0.01);
  e.run(0.9);
  const BodyState& pushed = e.bodies().bodies[static_cast<std::size_t>(box)];
  EXPECT_NEAR(pushed.twist.linear.x, 0.2, 2e-3);
  EXPECT_NEAR(pushed.center_of_mass.x, 0.18 + 0.03, 1e-3);
  EXPECT_NEAR(e.bodies().bodies[static_cast<std::size_t>(plate)].pose.position.x, 0.18, 1e-12);
  e.run(1.0);
  EXPECT_NEAR(pushed.twist.linear.x, 0.0, 1e-3);
  EXPECT_LT(pushed.center_of_mass.x, 0.245) << "friction of 0.4 stops 0.2 m/s within 5 mm";
}

struct Stirrer {
  static constexpr double kInner = 0.03, kOuter = 0.06, kTurning = 2.0;  // m, rad/s
  double motor = 0.0, fluid = 0.0, speed = 0.0;                          // N·m, rad/s

  // A rod that turns in a cup filled to `height`, by a motor on a hinge or by keys.
  Stirrer(double height, double viscosity, bool by_motor) {
    SceneBuilder b;
    b.add_fluid(1000.0, viscosity);
    b.add_fixed("cup", report::glass_of(kOuter, height + 0.03, 0.02));
    const make::Solid rod =
        make::lathe({{0.0, 0.02}, {kInner, 0.02}, {kInner, height + 0.04}, {0.0, height + 0.04}}, 64);
    const int turned = by_motor ? b.add_free("rod", rod, 0.3) : b.add_fixed("rod", rod);
    if (by_motor) {
      Joint joint;
      joint.name = "hinge";
      joint.body = turned;
      joint.motor_speed = kTurning;
      joint.motor_limit = 10.0;
      b.scene.joints.push_back(joint);
    } else {
      Body& body = b.scene.bodies[static_cast<std::size_t>(turned)];
      body.motion = BodyMotion::kDriven;
      for (int k = 0; k <= 120; ++k)
        body.keys.push_back(
            {k / 60.0, {{0, 0, 0}, glm::angleAxis(kTurning * k / 60.0, glm::dvec3(0, 1, 0))}});
    }
    for (Body& body : b.scene.bodies) body.dynamic_viscosity = kFluidsViscosity;
    b.add_volume(make::lathe(
        {{0.0, 0.0}, {kOuter, 0.0}, {kOuter, height}, {kInner, height}, {kInner, 0.02}, {0.0, 0.02}}, 96));
    b.set_domain({-0.2, -0.1, -0.2}, {0.2, 0.3, 0.2});
    Experiment e(b.scene, 0.006);
    e.settle(0.3);
    e.run(0.3);
    Average of_motor, of_fluid, of_speed;
    e.run(0.3, [&] {
      const BodyState& state = e.bodies().bodies[static_cast<std::size_t>(turned)];
      of_fluid.add(-state.fluid.torque.y);
      of_speed.add(state.twist.angular.y);
      if (by_motor) of_motor.add(e.bodies().joints[0].motor);
    });
    if (by_motor) motor = of_motor.mean();
    fluid = of_fluid.mean();
    speed = of_speed.mean();
  }
};

// Two fillings: the rod's lower end and the floor are in both, so the difference is an endless rod's,
// 4πμω R₁²R₂²/(R₂² − R₁²) a length (Couette).
double couette(double viscosity) {
  constexpr double kFirst = Stirrer::kInner * Stirrer::kInner, kSecond = Stirrer::kOuter * Stirrer::kOuter;
  return 4.0 * kPi * viscosity * Stirrer::kTurning * kFirst * kSecond / (kSecond - kFirst);
}

TEST(Stirrer, has_the_torque_of_couette_on_its_motor) {
  constexpr double kLow = 0.06, kHigh = 0.1;
  const Stirrer low(kLow, 5.0, true), high(kHigh, 5.0, true);
  EXPECT_NEAR(high.speed, Stirrer::kTurning, 1e-3);
  const double error = report("stirrer, its motor's torque a length",
                              (high.motor - low.motor) / (kHigh - kLow), couette(5.0), "N");
  EXPECT_LT(std::abs(error), 0.06);
  EXPECT_NEAR(high.motor, high.fluid, 0.01 * high.motor)
      << "at one speed the motor gives what the fluid takes";
}

TEST(Stirrer, is_felt_the_same_where_it_is_driven) {
  for (const double viscosity : {0.5, 5.0}) {  // explicit, then implicit viscosity
    const Stirrer motor(0.06, viscosity, true), driven(0.06, viscosity, false);
    const std::string name = "stirrer in " + std::to_string(viscosity).substr(0, 3) + " Pa·s, ";
    EXPECT_NEAR(driven.speed, Stirrer::kTurning, 1e-6);
    EXPECT_LT(std::abs(report(name + "driven against by motor", driven.fluid, motor.fluid, "N·m")), 0.02);
  }
}

}  // namespace
}  // namespace slosh::lab
