// The reference of a dam's front, against what is known of it in closed form, its own volume and energy, and
// a finer one.
#include "tests/lab/report/reference/potential_dam.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/lab/report/refused.h"

namespace slosh::report {
namespace {

double area(const std::vector<glm::dvec2>& points) {
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i)
    sum += 0.5 * (points[i].y + points[i - 1].y) * (points[i].x - points[i - 1].x);
  return sum;
}

// x² − y² is harmonic, and even in both: over a quarter of an ellipse the speed across it is known.
TEST(PotentialDam, SpeedsAreThoseOfAHarmonicPotential) {
  const auto worst = [](int n) {
    std::vector<glm::dvec2> points;
    std::vector<double> potential, speed;
    for (int i = 0; i <= n; ++i) {
      const double angle = 0.5 * std::numbers::pi * (1.0 - static_cast<double>(i) / n);
      const glm::dvec2 p(3.0 * std::cos(angle), std::sin(angle));
      const glm::dvec2 out = glm::normalize(glm::dvec2(p.x / 9.0, p.y));
      points.push_back(p);
      potential.push_back(p.x * p.x - p.y * p.y);
      speed.push_back(2.0 * (p.x * out.x - p.y * out.y));
    }
    const std::vector<double> found = outward_speeds(points, potential);
    double most = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) most = std::max(most, std::abs(found[i] - speed[i]));
    return most;
  };
  const double coarse = worst(40), fine = worst(80);
  std::printf("largest error of a speed of up to 6: %.4f, %.4f\n", coarse, fine);
  EXPECT_LT(fine, 0.002);
  EXPECT_GT(coarse / fine, 3.0);
}

// Let go, the column's pressure is harmonic, 0 on top and side, and bears the weight on its floor: a cosine
// series across gives what the side is pushed out with.
TEST(PotentialDam, ItsSideSetsOutAsTheSeriesHasIt) {
  constexpr double kHeight = 2.0, kGravity = 0.5, kTime = 0.1;
  const auto dam = potential_dam(kHeight, 0.15, {0.04, 0.01, 0.03});
  for (const double y : {0.3, 0.5, 1.0}) {
    double push = 0.0;
    for (int n = 0; n < 40; ++n) {
      const double k = (n + 0.5) * std::numbers::pi;
      push += kGravity * 2.0 / k * std::sinh(k * (kHeight - y)) / std::cosh(k * kHeight);
    }
    const double way = front_at(dam, kTime, y) - 1.0, expected = 0.5 * push * kTime * kTime;
    std::printf("%.1f up: %.3e, by the series %.3e\n", y, way, expected);
    EXPECT_NEAR(way, expected, 0.02 * expected) << y;
  }
}

TEST(PotentialDam, PointsWithoutAnAnswerAreRefused) {
  const std::vector<glm::dvec2> good{{0.0, 1.0}, {0.7, 0.7}, {1.0, 0.0}};
  const std::vector<double> potential{0.0, 0.1, 0.2};
  EXPECT_EQ(outward_speeds(good, potential).size(), 3u);
  EXPECT_THROW(outward_speeds({good[0], good[1], good[1], good[2]}, {0.0, 0.1, 0.1, 0.2}), Refused);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(outward_speeds({good[0], {nan, 0.5}, good[2]}, potential), Refused);
  EXPECT_THROW(outward_speeds(good, {0.0, nan, 0.2}), Refused);
}

TEST(PotentialDam, AFinerOneHasTheSameFront) {
  const auto usual = potential_dam(2.0, 3.3);
  const auto fine = potential_dam(2.0, 3.3, {0.05, 0.006, 0.02});
  for (const double time : {0.5, 1.0, 2.0, 3.0, 3.3}) {
    const double a = front_at(usual, time, 0.05), b = front_at(fine, time, 0.05);
    std::printf("front at %.1f: %.4f, finer %.4f\n", time, a, b);
    EXPECT_NEAR(a, b, 0.0025 * b) << time;
  }
}

TEST(PotentialDam, KeepsItsVolume) {
  const auto dam = potential_dam(2.0, 3.3);
  EXPECT_NEAR(area(dam.front().points), 2.0, 0.002);
  EXPECT_NEAR(area(dam.back().points), 2.0, 0.01);
}

}  // namespace
}  // namespace slosh::report
