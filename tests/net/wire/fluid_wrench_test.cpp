// A body's fluid wrench on the wire: what comes back, what is refused, what a Writer makes of a bad one.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "net/wire/all_messages.h"
#include "tests/net/wire/damage.h"

namespace slosh {
namespace {

using namespace wire;

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kEndless = std::numeric_limits<double>::infinity();

// BᵀB of random rows: positive semidefinite, of this rank.
Matrix6 random_matrix(std::mt19937_64& random, int rank, double size) {
  std::normal_distribution<double> normal;
  Matrix6 matrix{};
  for (int r = 0; r < rank; ++r) {
    Vector6 v;
    for (double& each : v) each = size * normal(random);
    for (std::size_t i = 0; i < 6; ++i) {
      for (std::size_t j = 0; j < 6; ++j) matrix[i][j] += v[i] * v[j];
    }
  }
  return matrix;
}

TEST(SemidefiniteCode, ComesBackWithinItsGrain) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    const int rank = i % 7;
    const Matrix6 sent = random_matrix(random, rank, std::pow(10.0, i % 8 - 4));
    const SemidefiniteCode code = to_code(sent);
    ASSERT_TRUE(is_semidefinite(code)) << "rank " << rank;
    const Matrix6 back = to_matrix(code);
    for (std::size_t a = 0; a < 6; ++a) {
      for (std::size_t b = 0; b < 6; ++b) {
        // A singular matrix is drawn in a little; one of full rank has only its rounding.
        const double grain = (rank < 6 ? 1e-3 : 4e-4) * std::sqrt(sent[a][a] * sent[b][b]);
        EXPECT_NEAR(back[a][b], sent[a][b], grain) << "rank " << rank;
        EXPECT_EQ(back[a][b], back[b][a]);
      }
    }
    // What was read can be sent on as it is.
    EXPECT_LE(std::abs(to_matrix(to_code(back))[0][1] - back[0][1]),
              1e-3 * std::sqrt(back[0][0] * back[1][1]));
  }
}

TEST(SemidefiniteCode, WhatIsNoneIsBroughtNear) {
  Matrix6 bad{};
  for (std::size_t i = 0; i < 6; ++i) bad[i][i] = 1.0;
  bad[0][0] = kNoNumber;
  bad[1][1] = -3.0;
  bad[2][2] = kEndless;
  bad[3][4] = bad[4][3] = 50.0;  // no correlation
  bad[4][5] = kNoNumber;
  const SemidefiniteCode code = to_code(bad);
  ASSERT_TRUE(is_semidefinite(code));
  const Matrix6 back = to_matrix(code);
  EXPECT_EQ(back[0][0], 0.0);
  EXPECT_EQ(back[1][1], 0.0);
  EXPECT_NEAR(back[2][2], kMaxDerivative, 100.0);
  EXPECT_GT(back[3][4], 0.9);
  EXPECT_EQ(back[4][5], 0.0);
}

FluidWrench valid() {
  return random_message<FluidWrench>(5);
}

std::string refusal(const FluidWrench& message) {
  Bytes bytes;
  const Fault told = encode(message, bytes);
  FluidWrench back;
  const Fault found = decode(bytes, back);
  EXPECT_EQ(told.text(), found.text());
  return found ? found.text() : std::string();
}

TEST(FluidWrench, MatricesThatWouldGiveEnergyAreRefusedByName) {
  ASSERT_EQ(refusal(valid()), "");
  for (SemidefiniteCode FluidWrench::* which :
       {&FluidWrench::stiffness, &FluidWrench::damping, &FluidWrench::added_mass}) {
    const std::string name = which == &FluidWrench::stiffness ? "stiffness"
                             : which == &FluidWrench::damping ? "damping"
                                                              : "added_mass";
    const std::string problem = name + ": is not positive semidefinite";
    FluidWrench negative = valid();
    (negative.*which).angular.y = -0.001f;
    EXPECT_EQ(refusal(negative), problem);
    FluidWrench crossed = valid();
    (crossed.*which) = SemidefiniteCode{glm::vec3(1.0f), glm::vec3(1.0f), {}};
    EXPECT_EQ(refusal(crossed), "");
    (crossed.*which).correlations[1] = 0x80;  // −32768: below −1
    EXPECT_EQ(refusal(crossed), problem);
    // Each pair may be, all three together not: c01 = c02 = 0.9, c12 = −0.9.
    const auto set = [&](std::size_t k, std::int16_t c) {
      (crossed.*which).correlations[2 * k] = static_cast<std::uint8_t>(c & 0xff);
      (crossed.*which).correlations[2 * k + 1] = static_cast<std::uint8_t>((c >> 8) & 0xff);
    };
    set(0, 29490);
    set(1, 29490);
    set(5, -29490);
    EXPECT_EQ(refusal(crossed), problem);
    set(5, 29490);
    EXPECT_EQ(refusal(crossed), "");
    (crossed.*which).linear.z = 0.0f;  // correlated, and nothing
    EXPECT_EQ(refusal(crossed), problem);
  }
}

TEST(FluidWrench, AModelComesBackAsItWasSent) {
  std::mt19937_64 random(3);
  FluidWrenchModel sent;
  sent.body = 3;
  sent.tick = 123456;
  sent.time = 61.728;
  sent.reference.position = {0.25, -0.5, 0.125};
  sent.reference.orientation = glm::normalize(glm::dquat(0.8, 0.1, -0.5, 0.3));
  sent.twist = {{0.1, 0.2, -0.3}, {1.0, -2.0, 3.0}};
  sent.wrench = {{1.0, 2.0, 3.0}, {0.1, 0.2, 0.3}};
  sent.rate = {{10.0, -20.0, 30.0}, {1.0, 2.0, -3.0}};
  sent.rate_span = 0.02;
  sent.added_mass = random_matrix(random, 6, 0.1);
  sent.d_pose = random_matrix(random, 6, 10.0);
  sent.d_velocity = random_matrix(random, 6, 3.0);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      sent.d_pose[i][j] *= -1.0;
      sent.d_velocity[i][j] *= -1.0;
    }
  }
  sent.trust_radius = 0.01;
  sent.trust_angle = 0.2;

  const Bytes bytes = datagram(to_message(sent, 7));
  EXPECT_LE(bytes.size(), 320u);
  FluidWrench message;
  ASSERT_FALSE(decode(ByteView(bytes).subspan(1), message));
  EXPECT_EQ(message.run, 7u);
  const FluidWrenchModel back = to_model(message);
  EXPECT_EQ(back.body, 3u);
  EXPECT_EQ(back.tick, 123456u);
  // Somewhere near, and moving otherwise.
  Pose pose = sent.reference;
  pose.position += glm::dvec3(0.004, -0.003, 0.002);
  pose.orientation = rotate_by(pose.orientation, {0.05, -0.02, 0.03});
  const Twist twist{{0.3, -0.1, 0.0}, {0.0, 1.0, 2.0}};
  const Wrench expected = fluid_wrench(sent, pose, twist, 0.01);
  const Wrench got = fluid_wrench(back, pose, twist, 0.01);
  EXPECT_LE(glm::length(got.force - expected.force), 1e-3 * glm::length(expected.force));
  EXPECT_LE(glm::length(got.torque - expected.torque), 1e-3 * glm::length(expected.torque));
}

}  // namespace
}  // namespace slosh
