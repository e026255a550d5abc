// The simulated operator against its closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "peer/devices/operator_device.h"

namespace slosh {
namespace {

/// Steps of `dt` under a force from `since` on, tiny before so that no weight is taken on.
template <class Each>
void run(OperatorDevice& device, const glm::dvec3& force, double seconds, double dt, Each&& each) {
  const int steps = static_cast<int>(std::lround(seconds / dt));
  for (int i = 0; i <= steps; ++i) {
    const double time = dt * i;
    const DeviceReport report = device.read({time, dt});
    each(time, report);
    device.write({i == 0 ? glm::dvec3(1e-12) : force, glm::dvec3(0.0)});
    if (i == 0) device.write({force, glm::dvec3(0.0)});
  }
}

OperatorSettings blind(const std::string& options) {
  return parse_operator(options + ",correction=0").value();
}

/// Textbook step response of an underdamped second-order system.
double step_response(const ArmImpedance& arm, double force, double time) {
  const double w = std::sqrt(arm.stiffness / arm.mass);
  const double zeta = arm.damping / (2.0 * std::sqrt(arm.stiffness * arm.mass));
  const double wd = w * std::sqrt(1.0 - zeta * zeta);
  return force / arm.stiffness *
         (1.0 - std::exp(-zeta * w * time) *
                    (std::cos(wd * time) + zeta / std::sqrt(1.0 - zeta * zeta) * std::sin(wd * time)));
}

TEST(Operator, FollowsItsStepResponseAtAnyStep) {
  for (const char* grip : {"tight", "loose"}) {
    const OperatorSettings settings = blind(grip);
    for (const double dt : {0.0005, 0.001, 0.007}) {
      OperatorDevice device(PoseTrack({}, Pose{}), settings);
      double most = 0.0;
      run(device, {3.0, 0.0, 0.0}, 2.0, dt, [&](double time, const DeviceReport& report) {
        EXPECT_NEAR(report.pose.position.x, step_response(settings.arm, 3.0, time), 1e-10) << grip << time;
        most = std::max(most, report.pose.position.x);
      });
      EXPECT_GT(most, 1.02 * 3.0 / settings.arm.stiffness) << "a hand overshoots";
    }
  }
}

TEST(Operator, OverdampedAndCriticalArmsHaveClosedFormsToo) {
  // m = 1, k = 100: critical at b = 20; x(t) = F/k (1 − e^(−10t)(1 + 10t)); at b = 25 roots −5 and −20.
  OperatorDevice critical(PoseTrack({}, Pose{}), blind("mass=1,stiffness=100,damping=20"));
  run(critical, {0, 1.0, 0}, 1.0, 0.002, [&](double t, const DeviceReport& report) {
    EXPECT_NEAR(report.pose.position.y, 0.01 * (1.0 - std::exp(-10.0 * t) * (1.0 + 10.0 * t)), 1e-10);
  });
  OperatorDevice slow(PoseTrack({}, Pose{}), blind("mass=1,stiffness=100,damping=25"));
  run(slow, {0, 1.0, 0}, 1.0, 0.002, [&](double t, const DeviceReport& report) {
    const double wanted = 0.01 * (1.0 - (20.0 * std::exp(-5.0 * t) - 5.0 * std::exp(-20.0 * t)) / 15.0);
    EXPECT_NEAR(report.pose.position.y, wanted, 1e-10);
    EXPECT_NEAR(report.twist.linear.y, (std::exp(-5.0 * t) - std::exp(-20.0 * t)) / 15.0, 1e-10);
  });
}

TEST(Operator, TheWristTurnsAsTheArmMoves) {
  const OperatorSettings settings = blind("tight");
  OperatorDevice device(PoseTrack({}, Pose{}), settings);
  device.read({0.0, 0.001});
  device.write({glm::dvec3(0.0), glm::dvec3(1e-12)});
  DeviceReport report;
  for (int i = 1; i <= 1000; ++i) {
    device.write({glm::dvec3(0.0), glm::dvec3(0.0, 0.4, 0.0)});
    report = device.read({0.001 * i, 0.001});
  }
  const glm::dvec3 turn = rotation_between({1, 0, 0, 0}, report.pose.orientation);
  EXPECT_NEAR(turn.y, step_response(settings.wrist, 0.4, 1.0), 1e-9);
}

/// What it says of its turning is how its poses turn, however far the wrist is bent.
TEST(Operator, SaysHowItTurns) {
  OperatorDevice device(PoseTrack({}, Pose{}), blind("loose"));
  device.read({0.0, 0.001});
  device.write({glm::dvec3(0.0), glm::dvec3(1e-12)});
  DeviceReport before = device.read({0.001, 0.001});
  double bent = 0.0;
  for (int i = 2; i <= 1500; ++i) {
    const double t = 0.001 * i;
    device.write({glm::dvec3(0.0), {0.7 * std::sin(2.0 * t), 0.6 * std::cos(3.0 * t), 0.5}});
    const DeviceReport now = device.read({t, 0.001});
    const glm::dvec3 turned = rotation_between(before.pose.orientation, now.pose.orientation) / 0.001;
    const glm::dvec3 said = 0.5 * (before.twist.angular + now.twist.angular);
    EXPECT_NEAR(glm::length(turned - said), 0.0, 2e-3) << t;
    bent = std::max(bent, glm::length(rotation_between({1, 0, 0, 0}, now.pose.orientation)));
    before = now;
  }
  EXPECT_GT(bent, 1.0);
}

TEST(Operator, SeesAndMakesGoodOnlyAfterTheDelay) {
  OperatorDevice blind_hand(PoseTrack({}, Pose{}), blind("tight"));
  OperatorDevice seeing(PoseTrack({}, Pose{}), parse_operator("tight").value());
  std::vector<double> expected;
  run(blind_hand, {4.0, 0, 0}, 6.0, 0.001,
      [&](double, const DeviceReport& report) { expected.push_back(report.pose.position.x); });
  std::size_t i = 0;
  double last = 0.0;
  run(seeing, {4.0, 0, 0}, 6.0, 0.001, [&](double time, const DeviceReport& report) {
    if (time <= 0.2) {
      EXPECT_NEAR(report.pose.position.x, expected[i], 1e-12) << time;
    } else if (time > 0.25) {
      EXPECT_LT(report.pose.position.x, expected[i]) << time;
    }
    ++i;
    last = report.pose.position.x;
  });
  EXPECT_NEAR(last, 0.0, 1e-4) << "in the end the hand is back where it should be";
  EXPECT_NEAR(expected.back(), 4.0 / 800.0, 1e-6);
}

TEST(Operator, CarriesTheWeightThatItTakesHoldOf) {
  OperatorDevice device(PoseTrack({}, Pose{}), parse_operator("loose").value());
  for (int i = 0; i < 1000; ++i) {
    const DeviceReport report = device.read({0.001 * i, 0.001});
    EXPECT_NEAR(glm::length(report.pose.position), 0.0, 1e-9);
    device.write({{0.0, -12.0, 0.0}, {0.1, 0.0, 0.0}});
  }
}

TEST(Operator, FollowsItsMotionAndBeginsAgainWhenTimeDoes) {
  std::vector<PoseKey> keys(2);
  keys[1].time = 2.0;
  keys[1].pose.position.z = 1.0;
  OperatorDevice device(PoseTrack(keys, Pose{}), parse_operator("tight").value());
  DeviceReport report;
  for (int i = 0; i <= 1000; ++i) report = device.read({0.001 * i, 0.001});
  EXPECT_NEAR(report.pose.position.z, 0.5, 1e-9);
  EXPECT_GT(report.twist.linear.z, 0.4);
  report = device.read({0.0, 0.001});
  EXPECT_NEAR(report.pose.position.z, 0.0, 1e-9);
}

TEST(Operator, TremorStaysInItsBandAndItsVelocityIsItsOwn) {
  OperatorDevice device(PoseTrack({}, Pose{}), parse_operator("tremor=0.0002").value());
  double most = 0.0;
  glm::dvec3 before{0.0};
  for (int i = 0; i < 2000; ++i) {
    const DeviceReport report = device.read({0.0005 * i, 0.0005});
    most = std::max(most, std::abs(report.pose.position.x));
    if (i > 0) {
      // The mean velocity of the last step, half a step later: a² per cent of it at 12 Hz.
      EXPECT_NEAR(report.twist.linear.y, (report.pose.position.y - before.y) / 0.0005, 4e-4);
    }
    before = report.pose.position;
  }
  EXPECT_NEAR(most, 0.0002, 1e-6);
}

TEST(Operator, WhatItCannotHaveIsNamed) {
  for (const char* options : {"firm", "mass=0", "mass=", "tremor=nan", "delay=1", "tight,mass=2,x=1"}) {
    const Result<OperatorSettings> settings = parse_operator(options);
    ASSERT_FALSE(settings) << options;
    EXPECT_NE(settings.error().mend.find("tight or loose"), std::string::npos);
  }
  EXPECT_EQ(parse_operator("loose,mass=2").value().arm.mass, 2.0);
  EXPECT_EQ(parse_operator("loose,mass=2").value().arm.stiffness, 120.0);
}

TEST(Operator, AWristAsStiffAsIsSaidIsAsWellDamped) {
  const ArmImpedance usual = OperatorSettings{}.wrist, stiff = parse_operator("wrist=40").value().wrist;
  EXPECT_EQ(stiff.stiffness, 40.0);
  EXPECT_NEAR(stiff.damping / std::sqrt(stiff.stiffness * stiff.mass),
              usual.damping / std::sqrt(usual.stiffness * usual.mass), 1e-12);
  EXPECT_FALSE(parse_operator("wrist=0"));
}

}  // namespace
}  // namespace slosh
